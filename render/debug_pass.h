// Debug lines, triangles and points over the scene: full where they are seen, faint where something hides them.
#pragma once

#include <string>

#include "render/frame_input.h"
#include "render/shader.h"

namespace render {

class DebugPass {
 public:
  explicit DebugPass(const std::string& shader_dir);

  // Returns the draw calls; adds the uploaded bytes to `uploaded`.
  int draw(const FrameInput& input, long& uploaded);

  std::string reload() { return program_.reloadIfChanged(); }

 private:
  int drawShape(GLenum shape, std::span<const LineVertex> vertices, long& uploaded);

  ShaderProgram program_;
  GrowingBuffer vertices_;
  VertexArray attributes_;
};

}  // namespace render
