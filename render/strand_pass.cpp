#include "render/strand_pass.h"

#include "shaders/shared.h"

namespace render {

// GL 4.5 promises this much output of one geometry shader invocation; Mesa allows more, other drivers do not.
static_assert(2 * shared::kChunkPoints * shared::kRibbonComponents <= shared::kMaxOutputComponents);
static_assert(shared::kChunkPoints * shared::kLineComponents <= shared::kMaxOutputComponents);

StrandCount& StrandCount::operator+=(const StrandCount& other) {
  strands += other.strands;
  vertices += other.vertices;
  draw_calls += other.draw_calls;
  return *this;
}

StrandCount issueStrands(const HairResources& hair, const HairDraw& draw, StrandPath path,
                         const StrandTopology& topology) {
  const int strands = hair.strandCount(draw), vertices = hair.pointsPerStrand(draw) * topology.vertices_a_point;
  if (strands == 0) return {};
  if (path == StrandPath::kGeometry) {
    glDrawArrays(GL_POINTS, 0, strands * hair.chunksPerStrand(draw));
  } else {
    glDrawArraysInstanced(topology.strip, 0, vertices, strands);
  }
  return {strands, static_cast<long>(strands) * vertices, 1};
}

StrandPass::StrandPass(const std::string& shader_dir)
    : geometry_(shader_dir, {{"strand.vert", "strand.geom", "strand.frag"}, {}, {}}),
      pulling_(shader_dir, {{"strand_pull.vert", "strand.frag"}, {}, {}}),
      no_attributes_(makeVertexArray()) {}

StrandCount StrandPass::draw(HairResources& hair, int shadow_map, StrandPath path, const Texture& table) {
  if (!hair.drawable || !hair.in_view) return {};
  hair.view_draw.shadow_map = shadow_map;
  const HairDraw& draw = hair.view_draw;
  HairStore::bind(hair, draw, &table);
  (path == StrandPath::kGeometry ? geometry_ : pulling_).use();
  glBindVertexArray(no_attributes_.id());
  return issueStrands(hair, draw, path, {GL_TRIANGLE_STRIP, 2});
}

std::string StrandPass::reload() {
  const std::string first = geometry_.reloadIfChanged(), second = pulling_.reloadIfChanged();
  return first.empty() ? second : first;
}

}  // namespace render
