#include "render/hair/strand_draw.h"

namespace render {

StrandCount& StrandCount::operator+=(const StrandCount& other) {
  strands += other.strands;
  vertices += other.vertices;
  draw_calls += other.draw_calls;
  return *this;
}

StrandCount issueStrands(const HairResources& hair, const HairDraw& draw, int vertices_a_point) {
  const int strands = hair.strandCount(draw);
  if (strands == 0) return {};
  glDrawArrays(GL_POINTS, 0, strands * hair.chunksPerStrand(draw));
  return {strands, static_cast<long>(strands) * hair.pointsPerStrand(draw) * vertices_a_point, 1};
}

}  // namespace render
