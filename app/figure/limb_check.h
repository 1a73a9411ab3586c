// Limbs that a clip leads into the trunk.
#pragma once

#include <string>

#include "app/figure/character.h"

namespace app {

// Where a clip leads a forearm or a hand deepest into the trunk, as their ellipsoids have it: captures know no skin,
// and the figure may be stouter than who was captured.
struct LimbInTrunk {
  double depth = 0;        // m, of the limb's far side under the trunk's surface; 0: none touches
  double time = 0;         // s into the clip
  std::string limb, part;  // names of the ellipsoids
};
LimbInTrunk limbInTrunk(const Character& character, const Clip& clip);

// A note where over half of a limb's thickness is under the trunk's skin; else empty.
std::string limbNote(const Character& character, const Clip& clip);

}  // namespace app
