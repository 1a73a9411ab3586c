// The course of three strands along a plait.
#pragma once

#include "app/scene/braid/braid_plan.h"

namespace app {

// Fills steps, width and band of a braid from its length. `radius` of its tie, m. Returns false, and leaves no steps,
// where the tail is too short to be a plait.
bool layBraid(double radius, Braid& braid);

// m: the shortest tail that a tie braids.
double shortestBraid(double radius);

}  // namespace app
