#include "render/debug_pass.h"

#include <cstddef>

namespace render {
namespace {

constexpr float kHiddenVisibility = 0.16f;

}  // namespace

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

}  // namespace render
