// The collision ellipsoids' places on a grown mannequin.
#pragma once

#include "app/figure/character_build.h"
#include "app/figure/mannequin.h"

namespace app {

// Parts by anatomy rather than by joint, so that shoulders, collar and back are covered closely whatever the skeleton.
std::vector<BodyPart> mannequinParts(const Mannequin& mannequin);

}  // namespace app
