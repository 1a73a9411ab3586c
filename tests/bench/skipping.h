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

// The simulation of the hundred beside the close-up's, in `rounds` turns, and how far the skips that look at distance
// take its shapes: no pictures, nothing written. Returns whether the ledger's bounds hold; prints.
bool runCrowd(int rounds);

}  // namespace bench
