// Painted shares of the look on a strand, as shaders/common/strand_share.glsl has them.
#pragma once

#include "render/strands/hair_layout.h"

namespace render {

// At a root in a face of `columns` with the weights `blend`; all 1 where nothing is painted.
LookShare shareOfRoot(const HairLayout& layout, const std::array<int, 4>& columns, const std::array<float, 4>& blend);

// At `along`, 0 root .. 1 tip; `rate`: by `along`.
LookShare shareAlong(const HairLayout& layout, float along, LookShare* rate = nullptr);

}  // namespace render
