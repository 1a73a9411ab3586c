// The two-level preconditioner: P = L^-1 + s H^-1 + B C^-1 B^T.
//
// L: the matrix without the couplings between layers, of the current step or of one before (layer_factor.h, FactorAge).
// H: the same without the couplings between columns (strand_factor.h); s: a weight, for the blocks on the diagonal are
// in both. Both leave out the directions that contacts remove: unknown to P, each of these adds an eigenvalue far from
// the others, that costs an iteration.
// C = B^T A B: the projection of the matrix, of this step or of some steps before, onto rigid motions of patches
// (patch_space.h), which carries what many vertices do together. The sum is an additive Schwarz method (Dryja and
// Widlund 1987). Its work grows with the mesh, where that of the whole matrix's factor grows faster.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "sim/linear/block_matrix.h"
#include "sim/linear/coarse_space.h"
#include "sim/linear/column_factor.h"
#include "sim/linear/layer_factor.h"
#include "sim/mesh/hair_mesh.h"

namespace sim {

template <class T>
struct TwoLevel {
  explicit TwoLevel(const HairMesh& mesh);

  // What of an earlier matrix may serve on: the factors, where the constraints hold the same vertices; the patches,
  // where not many more are held.
  struct Keep {
    bool factors = false, patches = false;
  };
  // Takes the current matrix, the positions that it is of (m, one a vertex) and the constraints of the solve.
  template <class Matrix>
  void update(const Matrix& a, std::span<const V3<T>> x, Keep keep = {},
              std::span<const VertexConstraint> constraints = {}) {
    if (!noteConstraints(constraints) || !keep.factors) {
      layers_.factor(a, constraints);
      strands_.factor(a, constraints);
    }
    if (!patched_ || !keep.patches || patches_.unknown(constraints) > kMaxUnknown)
      patched_ = patches_.make(a, x, constraints);
  }

  // Iterations with 0.3, 0.5 and 0.75 are the same within one in twenty.
  static constexpr T kStrandWeight = T(0.5);
  // Vertices held anew, with which the patches still serve; with thirty more they tripled a solve's iterations.
  static constexpr int kMaxUnknown = 2;

  // z = P r.
  void apply(std::span<const V3<T>> r, std::span<V3<T>> z);

 private:
  ColumnLayout layout_;
  ColumnPattern columns_;
  LayerFactor<T> layers_;
  ColumnFactor<T> strands_;
  std::vector<std::pair<int, int>> masked_;  // vertices that the factors know constrained, and in how many directions
  CoarseSpace<T> patches_;
  bool patched_ = false;  // else there are none, or a pivot was not positive: P goes without
  ColumnField<T> field_;  // r, then z
  bool noteConstraints(std::span<const VertexConstraint> constraints);
};

}  // namespace sim
