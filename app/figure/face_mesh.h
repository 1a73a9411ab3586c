// A finer face of the grown mannequin, for the eye alone: lids, lips and nose are smaller than the body's cells.
#pragma once

#include "app/figure/character.h"
#include "app/figure/mannequin_field.h"

namespace app {

// The mesh with the face's edges halved, those about mouth and nose twice, and the new vertices on the body's surface;
// all else stays. Vertices are added at the end.
SkinnedMesh withFineFace(const SkinnedMesh& mesh, const BodyField& body);

}  // namespace app
