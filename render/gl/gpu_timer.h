// Times of a frame's stages.
#pragma once

#include <chrono>
#include <vector>

#include "render/frame_report.h"
#include "render/gl/gl_object.h"

namespace render {

// Timer queries where the driver's can be believed. Software rasterizers defer the work past the query (llvmpipe: 0.6
// ms said, 5.6 spent), so there each stage is finished and clocked. Costs nothing when not measuring.
class GpuTimer {
 public:
  // Starts a frame. Decides once, by the renderer's name, which clock to use.
  void start(bool measure);
  // Ends the stage that ran since the last call (or since start) and names it.
  void mark(const char* stage);
  // Milliseconds per stage; waits for the queries when measuring.
  std::vector<StageTime> finish();

 private:
  bool measure_ = false, decided_ = false, software_ = false;
  std::vector<const char*> names_;
  std::vector<Query> queries_;  // one more than names: the start
  std::vector<std::chrono::steady_clock::time_point> clocks_;
};

}  // namespace render
