// Factor of the system matrix without the couplings between layers: one planar system a layer, all of one structure,
// that of the root faces. They are eliminated side by side, one layer a vector lane.
#pragma once

#include <map>
#include <span>
#include <utility>
#include <vector>

#include "sim/linear/block_matrix.h"
#include "sim/linear/column_matrix.h"
#include "sim/mesh/vertex_constraint.h"

namespace sim {

// Approximate minimum degree (Amestoy, Davis, Duff 1996; Eigen's implementation).
std::vector<int> minimumDegreeOrder(const BlockPattern& pattern);

// What one group of lanes is walked by; see the members of LayerFactor.
struct LayerStructure {
  std::span<const int> below_first, updates;
  std::span<const std::size_t> pivot_at, block_at;
  std::span<const int> rows, rows_below;
};

// Block L D L^T of every layer, columns in an order of minimum degree. A vertex without a row (padding beside a shorter
// column) is a row of the identity.
template <class T>
struct LayerFactor {
  LayerFactor(const HairMesh& mesh, const ColumnLayout& layout, const ColumnPattern& pattern);

  // The blocks within layers of a positive definite matrix, without the directions that the constraints remove; a pivot
  // block that rounding has made singular counts as its diagonal.
  void factor(const ColumnMatrix<T>& a, std::span<const VertexConstraint> constraints = {});

  // x = (L D L^T)^-1 x; allocates nothing.
  void solve(ColumnField<T>& x) const;

 private:
  const HairMesh* mesh_;
  const ColumnLayout* layout_;
  const ColumnPattern* pattern_;
  int lanes_;  // of a group, one a layer
  int groups_;
  std::vector<int> order_;  // columns as they are eliminated
  // Per eliminated column: where the columns that its elimination couples begin in rows_below_ and block_at_.
  std::vector<int> below_first_{0};
  // Where L_ik D_k L_jk^T goes, for all pairs j <= i of those below k: the block's number, for j = i the pivot's.
  std::vector<int> updates_;
  // Where the matrix's blocks go: block, or ~pivot; and whether as the transpose.
  struct Source {
    int diagonal;  // number in the pattern
    int block;
    bool transposed;
  };
  std::vector<Source> sources_;
  std::vector<int> sources_of_first_{0}, sources_of_;  // per column: the sources that it has a share in
  std::vector<int> rows_, rows_below_;  // first entries of a field's columns, as they are eliminated; those coupled
  // Lane groups one after the other; of each, for every pivot in turn, its inverse (6 components) and the blocks of L
  // below it (9 each).
  LineVector<T> values_;
  std::size_t group_size_ = 0;
  std::vector<std::size_t> pivot_at_, block_at_;  // within a group
  LineVector<T> panel_;                           // D L^T of one column

  // `position`: of each column in the elimination; `block_of`: the block at (row, column), both in positions.
  void findSources(std::span<const int> position, const std::map<std::pair<int, int>, int>& block_of);
  LayerStructure structure() const;
  void clearWithIdentity();
  void mask(std::span<const VertexConstraint> constraints);
  void eliminate();
};

}  // namespace sim
