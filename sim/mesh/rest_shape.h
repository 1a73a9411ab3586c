// Another rest shape for a hair mesh that stands: the same topology, other positions.
#pragma once

#include <span>
#include <vector>

#include "sim/mesh/hair_mesh.h"

namespace sim {

// Which wall stands over each side of each prism; made once per topology.
class RestShape {
 public:
  explicit RestShape(const HairMesh& mesh);

  // Sets the mesh's rest positions (m, one per vertex) and all that buildHairMesh derives from them, to the same bits.
  // False where it would refuse them (a corner tetrahedron of no volume, an edge shorter than 1e-5 m, a coordinate that
  // is not finite); then nothing has changed.
  bool set(std::span<const Vec3> positions, HairMesh& mesh);

 private:
  std::vector<int> wall_of_;  // by prism and corner k, four a prism: the wall over the side from corner k to k + 1
  std::vector<double> tet_volume_, vertical_volume_;  // scratch
};

}  // namespace sim
