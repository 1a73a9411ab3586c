// The two-level preconditioner: P = L^-1 + s H^-1 + w R Q C^-1 Q^T R^T.
//
// L: the matrix without the couplings between layers, of the current step or of one before (layer_factor.h, LayerAge).
// H: the same without the couplings between columns (strand_factor.h); s: a weight, for the blocks on the diagonal are
// in both. Both leave out the directions that contacts remove: unknown to P, each of these adds an eigenvalue far from
// the others, that costs an iteration.
// C = Q^T A_rest Q: the projection of the rest shape's matrix onto a coarse space of smooth displacements, which
// carries what goes along the hair; R: the vertices' own rotations from the rest shape; w: a weight, for hair that is
// pulled out of its rest shape is stiffer than C knows. The sum is an additive Schwarz method (Dryja and Widlund 1987).
// Its work grows with the mesh, where that of the whole matrix's factor grows faster. Measured on a walk of 2,268
// vertices with contacts, solves starting from the last velocities, iterations to 3 % and 1 % of the error: 13 and 26;
// with the whole rest factor 35 and 56, with 3x3 blocks 162 and 294; with columns in the layers' place no better than
// without a coarse space. That was before columns stood beside the layers and contacts were left out of both: on a walk
// of 10,241 vertices with some 30 contacts the latter took a step's 40 iterations to 28, and both together to 22, with
// half as many coarse columns and layers.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "sim/block_matrix.h"
#include "sim/coarse_space.h"
#include "sim/hair_mesh.h"
#include "sim/layer_factor.h"
#include "sim/rest_factor.h"
#include "sim/strand_factor.h"

namespace sim {

template <class T>
struct TwoLevel {
  bool fine = false;  // else a pivot was not positive, or nothing was factored, and it must not be used

  TwoLevel(const HairMesh& mesh, const BlockPattern& system);

  // Takes the rest shape's matrix; `compact`: keep its factor in 16 bits (single precision only).
  void make(const BlockMatrix<T>& rest, bool compact);
  // The same in `slices` pieces of about equal work: `begin`, then `work` until it answers true. What was made before
  // serves until then.
  void begin();
  bool work(const BlockMatrix<T>& rest, bool compact, int slices);

  // Takes the current matrix, the constraints of the solve and the rotations of the vertices from the rest shape.
  // `keep`: the factors of an earlier matrix serve on, where the constraints hold the same vertices.
  template <class Matrix>
  void update(const Matrix& a, std::span<const M3<T>> turn, bool keep = false,
              std::span<const VertexConstraint> constraints = {}) {
    if (!noteConstraints(constraints) || !keep) {
      layers_.factor(a, constraints);
      strands_.factor(a, constraints);
    }
    setRotations(turn);
  }

  // The coarse half alone, of weight 1; and the weight that it has in P.
  void applyCoarse(std::span<const V3<T>> r, std::span<V3<T>> z);
  T coarse_weight = 1;
  // Iterations with 0.3, 0.5 and 0.75 are the same within one in twenty.
  static constexpr T kStrandWeight = T(0.5);

  // z = P r.
  void apply(std::span<const V3<T>> r, std::span<V3<T>> z);

 private:
  ColumnLayout layout_;
  ColumnPattern columns_;
  LayerFactor<T> layers_;
  StrandFactor<T> strands_;
  std::vector<std::pair<int, int>> masked_;  // vertices that the factors know constrained, and in how many directions
  CoarseSpace space_;
  BlockMatrix<T> coarse_matrix_;
  RestFactor<T> coarse_;
  ColumnField<T> field_;  // r, then z
  LineVector<T> turn_;    // nine components, each a padded array
  LineVector<T> across_;  // per coarse column, sums over the columns that hang on it: x, y, z by layer
  std::vector<V3<T>> restricted_, solved_;  // per coarse vertex
  int projected_ = 0;                       // rows of the system's matrix
  bool noteConstraints(std::span<const VertexConstraint> constraints);
  void setRotations(std::span<const M3<T>> turn);
  void solveCoarse();  // from field_ into across_
  void projectRow(const BlockMatrix<T>& rest, int row);
};

}  // namespace sim
