// Plans the frame: strands and their detail, shadow maps, and the constants that every shader reads (FrameBlock).
#pragma once

#include <string>

#include "render/pass.h"
#include "render/plan_input.h"

namespace render {

class PlanPass {
 public:
  static constexpr const char* kName = "plan";
  using Input = PlanInput;
  static Input inputOf(const FrameInput& frame);

  explicit PlanPass(const std::string&) {}
  void draw(const Input& input, Stage& stage, FrameReport& report);
  ReloadReport reload(Reload) { return {}; }
};

}  // namespace render
