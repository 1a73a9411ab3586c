// When a lock that lies on a slope slides off it: shoulders and chests are slopes, and hair that never slides stands on
// them.
#pragma once

#include "sim/sim_params.h"

namespace bench {

// rad, 0 to 80 degrees: the steepest slope on which a lock of 0.3 m, lying level across it and held at its root, stays:
// within 1 s its tip goes down by less than 20 mm. Without bending it would be atan(friction).
double measureSlideAngle(const sim::SimParams& params);

}  // namespace bench
