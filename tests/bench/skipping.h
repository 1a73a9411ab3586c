// What skips save and what they change, on five scenes: every skip alone, all of them, none.
#pragma once

#include <string>
#include <vector>

namespace bench {

struct SkippingOptions {
  std::string folder = "docs";      // skipping.json, skipping.md and plots go here
  std::vector<std::string> scenes;  // empty: all five
  bool quick = false;               // fewer strands, frames and pixels
};

// Returns whether the bounds of the ledger hold; prints each.
bool runSkipping(const SkippingOptions& options);

}  // namespace bench
