// The strands that the geometry stage emits, read back by transform feedback. Needs a current context.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "render/gl/render_target.h"
#include "render/gl/shader.h"
#include "render/hair/hair_store.h"
#include "render/hair/strand_draw.h"
#include "shaders/shared.h"

namespace strand_capture {

using Polyline = std::vector<Eigen::Vector3f>;

// Every strand's points (m), in the order of the strands; empty where a strand is not drawn.
inline std::vector<Polyline> capture(const render::HairInput& input, const std::string& shader_dir) {
  static const render::ShaderProgram program(shader_dir,
                                             {{"strand.vert", "strand_shadow.geom"}, {"CAPTURE_POINTS"}, {"captured"}});
  render::HairStore store;
  store.update({&input, 1}, render::LightInput{});
  render::HairResources& hair = store.hairs()[0];
  render::HairDraw draw;
  draw.segments = hair.segments;
  render::HairStore::bind(hair, draw);
  render::Buffer frame = render::makeBuffer(), result = render::makeBuffer();
  glNamedBufferStorage(frame.id(), sizeof(render::shared::FrameBlock), nullptr, 0);
  glBindBufferBase(GL_UNIFORM_BUFFER, 0, frame.id());
  const std::size_t most = static_cast<std::size_t>(hair.strandCount(draw)) * hair.pointsPerStrand(draw) * 2;
  glNamedBufferStorage(result.id(), static_cast<GLsizeiptr>(most * 16), nullptr, 0);
  glBindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, result.id());
  render::VertexArray none = render::makeVertexArray();
  render::Query query = render::makeQuery(GL_TRANSFORM_FEEDBACK_PRIMITIVES_WRITTEN);
  // A context without a surface draws nothing, not even into a feedback buffer, until a complete framebuffer is
  // bound.
  render::ImageTarget target;
  target.prepare(4, 4);
  glBindFramebuffer(GL_FRAMEBUFFER, target.framebuffer());
  glBindVertexArray(none.id());
  program.use();
  glEnable(GL_RASTERIZER_DISCARD);
  glBeginQuery(GL_TRANSFORM_FEEDBACK_PRIMITIVES_WRITTEN, query.id());
  glBeginTransformFeedback(GL_LINES);
  render::issueStrands(hair, draw, 1);
  glEndTransformFeedback();
  glEndQuery(GL_TRANSFORM_FEEDBACK_PRIMITIVES_WRITTEN);
  glDisable(GL_RASTERIZER_DISCARD);
  GLuint segments = 0;
  glGetQueryObjectuiv(query.id(), GL_QUERY_RESULT, &segments);
  std::vector<Eigen::Vector4f> points(segments * 2);
  glGetNamedBufferSubData(result.id(), 0, static_cast<GLsizeiptr>(points.size() * 16), points.data());
  std::vector<Polyline> strands(static_cast<std::size_t>(input.strands));
  for (std::size_t i = 0; i < points.size(); i += 2) {
    Polyline& strand = strands.at(static_cast<std::size_t>(points[i].w()));
    if (strand.empty()) strand.push_back(points[i].head<3>());
    strand.push_back(points[i + 1].head<3>());
  }
  return strands;
}

}  // namespace strand_capture
