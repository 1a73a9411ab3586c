// Runs one shared scene with one set of skips and measures what a frame costs and shows.
#pragma once

#include <string>
#include <vector>

#include "app/files/image_io.h"
#include "app/files/scene_file.h"
#include "app/scene/detail/skips.h"

namespace bench {

// A frame: means of the thread, for drawing medians of the process, for all threads of a software rasterizer count.
struct SkipRow {
  std::string scene, skips;  // skips: none, all, or the one that is on
  std::string setup;         // picture and strands
  double simulation_ms = 0, character_ms = 0, drawing_ms = 0;
  double drawing_like_close_up_ms = 0;  // of a crowd with all skips, at the close-up's strands and shadow maps
  double simulation_error_mm = 0, simulation_error_pixels = 0;  // mean over vertices, worst frame, against none
  double image_error = 0;     // levels of 255, mean over the picture, worst frame, against none
  app::SkipCounts skipped{};  // of all frames
  long gpu_bytes_hair = 0, gpu_bytes_shadows = 0;
  double frame() const { return simulation_ms + character_ms + drawing_ms; }
};

struct SceneRun {
  std::string file;
  int frames = 40;
  int warm_up = 10;
  std::vector<int> drawn;                                       // frames that are drawn; times are of all but the first
  int width = 320, height = 180, strands = 0, shadow_size = 0;  // 0: the scene's
  int close_up_strands = 0;                                     // of a crowd; 0: it is none
};

// All rows of a scene, none first: of skips that left something out. Pictures of none and all at the last drawn frame
// are written to `folder`.
std::vector<SkipRow> measureScene(const SceneRun& run, const std::string& folder);

}  // namespace bench
