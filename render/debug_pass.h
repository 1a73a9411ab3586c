// Debug lines, triangles and points over the scene: full where they are seen, faint where something hides them.
#pragma once

#include <span>
#include <string>

#include "render/pass.h"

namespace render {

class DebugPass {
 public:
  static constexpr const char* kName = "debug";
  struct Input {
    float exposure = 1;  // undone for the shapes
    std::span<const LineVertex> lines, triangles, points;

    bool hasShapes() const { return !lines.empty() || !triangles.empty() || !points.empty(); }
    // Shapes have no revision, so they count as changed in every frame.
    bool operator==(const Input& other) const { return !hasShapes() && !other.hasShapes(); }
  };
  static Input inputOf(const FrameInput& frame) {
    return {frame.view.exposure, frame.debug_lines, frame.debug_triangles, frame.debug_points};
  }

  explicit DebugPass(const std::string& shader_dir);
  void draw(const Input& input, Stage& stage, FrameReport& report);
  ReloadReport reload(Reload which) { return program_.reload(which); }

 private:
  void drawShape(GLenum shape, std::span<const LineVertex> vertices, FrameReport& report);

  ShaderProgram program_;
  GrowingBuffer vertices_;
  VertexArray attributes_;
};

}  // namespace render
