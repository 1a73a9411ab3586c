// Fingers of the grown mannequin, for the eye alone: collision ellipsoids are fitted to the mittens that the body's
// field has, for hair does not go between fingers.
#pragma once

#include "app/figure/character.h"
#include "app/figure/mannequin_field.h"

namespace app {

// The mesh with finer hands, closed fingers and thumb, drawn onto their surface; all else stays. Vertices are added at
// the end.
SkinnedMesh withFingers(const SkinnedMesh& mesh, const BodyField& body);

}  // namespace app
