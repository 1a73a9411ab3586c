// Where the vertices of braided hair are drawn.
#pragma once

#include <span>
#include <vector>

#include "app/scene/braid/braid_plan.h"

namespace app {

// positions: of the simulated vertices, 3 floats each. Smooth in them: no choice is made here that depends on where
// hair is. Above the ring every simulated vertex is drawn where it is, to the bit.
void drawBraids(const BraidPlan& plan, std::span<const float> positions, std::vector<float>& drawn);

// Of each plait that hangs the matrix that takes a ring of radius 1 about z to its second tie.
std::vector<render::Mat4> braidBands(const BraidPlan& plan, std::span<const float> positions);

}  // namespace app
