#include "render/hair/strand_draw.h"

namespace render {

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

}  // namespace render
