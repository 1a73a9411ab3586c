// Where a body's skin is scalp among the roots of a hair mesh, and how deep under it these lie.
#pragma once

#include <vector>

#include "app/figure/character.h"
#include "sim/mesh/hair_mesh.h"

namespace app {

// Two numbers a vertex of the character's mesh, in the rest pose.
//
// Cover: 1 inside the root faces, less from 8 mm before the hairline on, as hair thins there, and 0 at it (on a head
// of 23 cm, and in proportion), on ears, and wherever the root faces are 18 mm off or face another way, as when the
// hair mesh was made for another head. Narrow gaps between root faces, a parting for one, count as covered.
//
// Depth, m: root faces are flat where the skin is round, so that between columns the roots lie under it, at the low
// resolution 8 mm beside the parting and 11 mm at the back of the head, and the hair would come out far from where it
// roots. The skin is drawn so much lower, and fades to where it is over the 8 mm outside of the hairline.
std::vector<float> rootCover(const Character& character, const sim::HairMesh& hair);

}  // namespace app
