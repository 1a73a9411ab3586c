// Arms that a clip leads into the trunk or the head: captures know no skin, and the figure may be stouter than who was
// captured.
#pragma once

#include <string>

#include "app/figure/character.h"

namespace app {

// Turns upper arms about their shoulders by the least that holds elbows, forearms and hands outside the ellipsoids of
// trunk, head and neck, at most 0.7 rad, and evens the turn out over 0.1 s. Skeletons whose arms hang from no shoulder
// (loose rigid parts) are left alone, and so are clips that touch nothing, to the bit. Returns what was done, empty if
// nothing was.
std::string clearArms(const Character& character, Clip& clip);

}  // namespace app
