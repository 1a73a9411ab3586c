// The studio: a backdrop behind everything and a ground disc that fades into it. Clears the radiance.
#pragma once

#include <string>

#include "render/pass.h"

namespace render {

class BackdropPass {
 public:
  static constexpr const char* kName = "backdrop";
  struct Input {
    bool ground = true;
    bool operator==(const Input&) const = default;
  };
  static Input inputOf(const FrameInput& frame) { return {frame.view.ground}; }

  explicit BackdropPass(const std::string& shader_dir);
  void draw(const Input& input, Stage& stage, FrameReport& report);
  ReloadReport reload(Reload which) { return reloadPrograms({&backdrop_, &ground_}, which); }

 private:
  ShaderProgram backdrop_, ground_;
  VertexArray no_attributes_;
};

}  // namespace render
