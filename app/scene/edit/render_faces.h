// A hair mesh's bundles as the strands know them.
#pragma once

#include <vector>

#include "render/frame_input.h"
#include "sim/mesh/hair_mesh.h"

namespace app {

// Bundles with the rest area of their root faces.
std::vector<render::HairFace> renderFaces(const sim::HairMesh& mesh);

}  // namespace app
