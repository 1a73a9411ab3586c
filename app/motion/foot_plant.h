// Feet that slide while they stand, a fault of captures and of clips that were moved to another skeleton.
#pragma once

#include <string>

#include "app/figure/character.h"

namespace app {

// Holds feet where they stand, by hips and knees alone. A foot stands while its toe (or ankle, where there is no toe)
// is within 3.5 cm of its lowest and slower than 0.35 m/s over the ground for at least 0.12 s; a stand that strays 5 to
// 120 mm from its middle is put there, and what that moves fades within 0.15 s beside it. Farther is meant: a foot that
// is dragged. Returns what was found, empty if nothing was. Skeletons without legs are left alone.
std::string plantFeet(const Skeleton& skeleton, Clip& clip);

}  // namespace app
