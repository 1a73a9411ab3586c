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

int DebugPass::drawShape(GLenum shape, std::span<const LineVertex> vertices, long& uploaded) {
  if (vertices.empty()) return 0;
  vertices_.upload(vertices.data(), static_cast<GLsizeiptr>(vertices.size_bytes()));
  uploaded += static_cast<long>(vertices.size_bytes());
  glVertexArrayVertexBuffer(attributes_.id(), 0, vertices_.id(), 0, sizeof(LineVertex));
  glBindVertexArray(attributes_.id());
  const auto count = static_cast<GLsizei>(vertices.size());
  glDepthFunc(GL_GREATER);
  glUniform1f(0, kHiddenVisibility);
  glDrawArrays(shape, 0, count);
  glDepthFunc(GL_LEQUAL);
  glUniform1f(0, 1.0f);
  glDrawArrays(shape, 0, count);
  return 2;
}

int DebugPass::draw(const FrameInput& input, long& uploaded) {
  if (input.debug_lines.empty() && input.debug_triangles.empty() && input.debug_points.empty()) return 0;
  program_.use();
  glUniform1f(1, input.view.exposure);
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  glEnable(GL_PROGRAM_POINT_SIZE);
  glDepthMask(GL_FALSE);
  const int calls = drawShape(GL_TRIANGLES, input.debug_triangles, uploaded) +
                    drawShape(GL_LINES, input.debug_lines, uploaded) +
                    drawShape(GL_POINTS, input.debug_points, uploaded);
  glDepthMask(GL_TRUE);
  glDepthFunc(GL_LESS);
  glDisable(GL_PROGRAM_POINT_SIZE);
  glDisable(GL_BLEND);
  return calls;
}

}  // namespace render
