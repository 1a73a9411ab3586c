// Resolves the multisampled radiance and brings it to the screen: exposure, film curve, sRGB.
#pragma once

#include <string>

#include "render/pass.h"

namespace render {

class ToneMapPass {
 public:
  static constexpr const char* kName = "tone map";
  struct Input {
    float exposure = 1;
    bool operator==(const Input&) const = default;
  };
  static Input inputOf(const FrameInput& frame) { return {frame.view.exposure}; }

  explicit ToneMapPass(const std::string& shader_dir);
  void draw(const Input& input, Stage& stage, FrameReport& report);
  ReloadReport reload(Reload which) { return program_.reload(which); }

 private:
  ShaderProgram program_;
  VertexArray no_attributes_;
};

}  // namespace render
