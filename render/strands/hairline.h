// Where hair ends on the scalp: the hairline, and how far from it columns stand.
#pragma once

#include "render/strands/hair_layout.h"

namespace render {

// Fills `edge` and `outward` of the columns and `face_edge`; tangent planes are there. An edge of the root mesh that
// one face has belongs to the hairline, unless another such edge faces it closely: hair is parted there, and goes on at
// the other side.
void measureHairline(HairLayout& layout);

}  // namespace render
