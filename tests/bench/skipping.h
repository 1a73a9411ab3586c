// What skips save and what they change, on five scenes: every skip alone, all of them, none.
#pragma once

#include <string>
#include <vector>

namespace bench {

struct SkippingOptions {
  std::string folder = "docs";      // skipping.md goes here; tables, pictures and plots into its data/
  std::vector<std::string> scenes;  // empty: all five
  bool quick = false;               // fewer strands, frames and pixels
};

std::vector<std::string> skippingScenes();  // names, for SkippingOptions::scenes

// Returns whether the bounds of the table of skips hold; prints each.
bool runSkipping(const SkippingOptions& options);

// The crowd's simulation beside the close-up's, in `rounds` turns, and how far the skips that look at distance
// take its shapes: no pictures, nothing written. Returns whether the table's bounds hold; prints.
bool runCrowd(int rounds);

}  // namespace bench
