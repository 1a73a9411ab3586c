// The studio: a backdrop behind everything and a ground disc that fades into it.
#pragma once

#include <string>

#include "render/frame_input.h"
#include "render/shader.h"

namespace render {

class BackdropPass {
 public:
  explicit BackdropPass(const std::string& shader_dir);

  // Fills the target's colour; the ground, when shown, writes depth. Returns the draw calls.
  int draw(bool ground);

  std::string reload();

 private:
  ShaderProgram backdrop_, ground_;
  VertexArray no_attributes_;
};

}  // namespace render
