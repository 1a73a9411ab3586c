// Debug lines, triangles and points over the scene: full where they are seen, faint where something hides them.
#include <cstddef>
#include <span>
#include <string>

#include "render/pass.h"

namespace render {
namespace {

constexpr float kHiddenVisibility = 0.16f;

}  // namespace

class DebugPass {
 public:
  static constexpr const char* kName = "debug";
  static constexpr Target kTarget = Target::kRadiance;
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

DebugPass::DebugPass(const std::string& shader_dir)
    : program_(shader_dir, {{"debug.vert", "debug.frag"}, {}, {}}), attributes_(makeVertexArray()) {
  const GLuint array = attributes_.id();
  for (GLuint index : {0u, 1u}) {
    glEnableVertexArrayAttrib(array, index);
    glVertexArrayAttribBinding(array, index, 0);
  }
  glVertexArrayAttribFormat(array, 0, 3, GL_FLOAT, GL_FALSE, offsetof(LineVertex, position));
  glVertexArrayAttribFormat(array, 1, 4, GL_FLOAT, GL_FALSE, offsetof(LineVertex, color));
}

void DebugPass::drawShape(GLenum shape, std::span<const LineVertex> vertices, FrameReport& report) {
  if (vertices.empty()) return;
  vertices_.upload(vertices.data(), static_cast<GLsizeiptr>(vertices.size_bytes()));
  report.bytes_uploaded += static_cast<long>(vertices.size_bytes());
  glVertexArrayVertexBuffer(attributes_.id(), 0, vertices_.id(), 0, sizeof(LineVertex));
  glBindVertexArray(attributes_.id());
  const auto count = static_cast<GLsizei>(vertices.size());
  glDepthFunc(GL_GREATER);
  glUniform1f(0, kHiddenVisibility);
  glDrawArrays(shape, 0, count);
  glDepthFunc(GL_LEQUAL);
  glUniform1f(0, 1.0f);
  glDrawArrays(shape, 0, count);
  report.draw_calls += 2;
}

void DebugPass::draw(const Input& input, Stage&, FrameReport& report) {
  if (!input.hasShapes()) return;
  program_.use();
  glUniform1f(1, input.exposure);
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  glEnable(GL_PROGRAM_POINT_SIZE);
  glDepthMask(GL_FALSE);
  drawShape(GL_TRIANGLES, input.triangles, report);
  drawShape(GL_LINES, input.lines, report);
  drawShape(GL_POINTS, input.points, report);
  glDepthMask(GL_TRUE);
  glDisable(GL_PROGRAM_POINT_SIZE);
}

template PassEntry makePass<DebugPass>(const std::string& shader_dir);

}  // namespace render
