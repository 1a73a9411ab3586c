// Issues the strands of a hair, for the passes that draw them.
#pragma once

#include "render/frame_input.h"
#include "render/hair/hair_store.h"

namespace render {

// What a pass over a hair issued.
struct StrandCount {
  long strands = 0, vertices = 0, draw_calls = 0;
  StrandCount& operator+=(const StrandCount& other);
};

struct StrandTopology {
  GLenum strip;
  int vertices_a_point;
};

// Issues a hair's strands with the program in use. The geometry path draws points, the pulling path `strip` instances
// of `vertices_a_point` vertices a curve point. The hair must be bound.
StrandCount issueStrands(const HairResources& hair, const HairDraw& draw, StrandPath path,
                         const StrandTopology& topology);

}  // namespace render
