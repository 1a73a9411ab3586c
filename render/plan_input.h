// What planning a frame depends on: the picture's size, the camera and the lights; and what chooses which strands and
// which maps are drawn, and how finely.
#pragma once

#include "render/frame_input.h"

namespace render {

struct PlanInput {
  int width = 0, height = 0, samples = 1;
  CameraInput camera;
  LightInput light;
  DrawSkips skips;
  Float3 backdrop_top{}, backdrop_bottom{}, ground_color{};
  float ground_height = 0;
  bool show_strands = true;
  StrandPath strand_path = StrandPath::kGeometry;
  float strands_per_pixel = 0, strand_share = 1, segment_error = 0;

  bool operator==(const PlanInput&) const = default;
};

}  // namespace render
