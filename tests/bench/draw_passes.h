// Times of a frame's passes where strands are drawn by shader stages, and of the strands beside triangles of the same
// strands that are there already. What a GPU is measured by.
#pragma once

#include <string>

namespace bench {

struct DrawPassesOptions {
  std::string folder;  // of docs
  int runs = 3;        // ten frames each
  bool quick = false;  // few and small pictures
};

// Writes <folder>/data/gpu_passes.csv (ms, medians) and gpu_triangles.csv, and the measured parts of gpu.md where the
// folder has it. Returns whether the bounds hold: strands that compute shaders grow at most twice the time of
// triangles, shadow maps at most 35 % on top of a frame without. Throws app::InputError and app::ContextError.
bool runDrawPasses(const DrawPassesOptions& options);

}  // namespace bench
