// Work on a picture, split into bands of rows, each on a thread of its own.
#pragma once

#include <algorithm>
#include <thread>
#include <vector>

namespace render {

// As many as the machine has threads, at most eight: each band looks at every strand.
inline int bandCount() {
  return std::clamp(static_cast<int>(std::thread::hardware_concurrency()), 1, 8);
}

// Calls work(band) for bands 0 .. bands - 1, side by side, and returns when all have ended. The work throws nothing.
template <class Work>
void inBands(int bands, const Work& work) {
  std::vector<std::jthread> others;
  for (int band = 1; band < bands; ++band) others.emplace_back([&work, band] { work(band); });
  work(0);
}

}  // namespace render
