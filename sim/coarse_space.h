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
  static constexpr int kColumnReach = 4, kLayerStep = 4, kNearest = 3;

  // How column c of the mesh hangs on the coarse ones: shares [column_first[c], column_first[c + 1]), which sum to 1.
  struct Share {
    int coarse;  // column
    float weight;
  };
  std::vector<int> column_first{0};
  std::vector<Share> shares;
  // Coarse column k has vertices coarse_first[k] ... coarse_first[k + 1] - 1, the m-th (from 1) at layer m *
  // kLayerStep; its last one may lie beyond the tip.
  std::vector<int> coarse_first{0};
  int coarseColumns() const { return static_cast<int>(coarse_first.size()) - 1; }
  int size() const { return coarse_first.back(); }

  // The same per vertex: vertex i of the mesh moves by the sum of weight[k] times coarse vertex index[k], k in
  // [first[i], first[i + 1]).
  std::vector<int> first{0}, index;
  std::vector<float> weight;
  BlockPattern pattern;  // of Q^T A Q

  CoarseSpace(const HairMesh& mesh, const BlockPattern& system);
};

}  // namespace sim
