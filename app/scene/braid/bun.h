// Hair that is wound to a bun: a rope along a spiral over a dome on the head, from its top down to the scalp.
#pragma once

#include "app/scene/braid/braid_plan.h"

namespace app {

// Fills steps and width of a rope of three twisted strands from its length. `radius` of its tie, m. Returns whether it
// is long enough.
bool layRope(double radius, Braid& braid);

// The coil of a braid whose steps are there. The dome is as large as the rope covers at 1.7 of its radii a turn.
void layBun(const BraidTie& tie, Braid& braid);

}  // namespace app
