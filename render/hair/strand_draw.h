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

// Issues a hair's strands with the program in use, which grows them in its geometry stage from points: a point a chunk
// of a strand. `vertices_a_point`: that it emits a point of the curve. The hair must be bound.
StrandCount issueStrands(const HairResources& hair, const HairDraw& draw, int vertices_a_point);

}  // namespace render
