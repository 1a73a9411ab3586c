// A coarse space of the hair mesh: displacements that are alike over many vertices, told by a few hundred.
#pragma once

#include <vector>

#include "sim/block_matrix.h"
#include "sim/hair_mesh.h"

namespace sim {

// Displacements that are linear along the hair between every kLayerStep-th layer, and smooth across it between coarse
// columns (no two within kColumnReach root edges of one another). Roots do not move. Coarse columns are coupled only to
// columns of the same connected part.
struct CoarseSpace {
  static constexpr int kColumnReach = 3, kLayerStep = 2, kNearest = 3;

  int size = 0;  // coarse vertices
  // Prolongation: vertex i of the mesh moves by the sum of weight[k] times coarse vertex index[k], k in [first[i],
  // first[i + 1]); the weights of a vertex sum to at most 1, and to less only beside the root.
  std::vector<int> first{0}, index;
  std::vector<float> weight;
  BlockPattern pattern;  // of P^T A P

  CoarseSpace(const HairMesh& mesh, const BlockPattern& system);
};

}  // namespace sim
