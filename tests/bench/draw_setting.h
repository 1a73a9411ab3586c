// Settings that a picture can be drawn with: each is a few changes of the default's.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "render/frame_input.h"

namespace bench {

struct DrawSetting {
  std::vector<std::pair<std::string, double>> changes;  // name of a row of the table in draw_setting.cpp, and value

  bool isDefault() const { return changes.empty(); }
  std::string name() const;  // "samples 1, shadow_size 256"; "the default"
  // Into a frame and its hairs. A name that is none is a programmer's error.
  void apply(render::FrameInput& frame, std::vector<render::HairInput>& hairs) const;
};

// The default first; then one factor at a time, a few combinations, and the rungs of the drawing governor
// (app/scene/detail/draw_governor.h). `quick`: those alone that came near the front of a scene.
std::vector<DrawSetting> settingsToDraw(bool quick);

}  // namespace bench
