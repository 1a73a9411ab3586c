// Skin weights of the grown mannequin.
#pragma once

#include "app/figure/mannequin_field.h"
#include "app/figure/mannequin_mesh.h"

namespace app {

// A skinned mesh of at most four joints a vertex: smooth along each chain of bones, blended only between neighbours in
// the hierarchy; the skull is rigid to the head joint.
SkinnedMesh skinMannequin(const Surface& surface, const BodyField& body, const Skeleton& skeleton,
                          const BodyRoles& roles);

}  // namespace app
