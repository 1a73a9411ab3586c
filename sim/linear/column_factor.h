// Factor of the system matrix without the couplings between columns: one system a column, that of its own hair. They
// are eliminated from the root to the tip side by side, one column a vector lane.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "sim/linear/block_matrix.h"
#include "sim/linear/column_matrix.h"
#include "sim/mesh/vertex_constraint.h"

namespace sim {

// Block L D L^T of every column. A vertex is coupled to the next two (bending). Roots do not move and have no row.
template <class T>
struct ColumnFactor {
  ColumnFactor(const HairMesh& mesh, const ColumnLayout& layout, const ColumnPattern& pattern);

  // The blocks within columns of a positive definite matrix, without the directions that the constraints remove; a
  // pivot block that rounding has made singular counts as its diagonal. Allocates nothing.
  void factor(const ColumnMatrix<T>& a, std::span<const VertexConstraint> constraints = {});

  // z += scale * (L D L^T)^-1 r, one entry a vertex; allocates nothing.
  void addSolution(std::span<const V3<T>> r, T scale, std::span<V3<T>> z);

 private:
  // A group of columns of about the same length, one a lane. Its rows are layers 1 ... depth - 1.
  struct Group {
    int depth;
    std::size_t values;  // start of its rows' entries
    int lanes;           // start of its columns in columns_
  };
  // Where a column is: its group and lane.
  struct Place {
    int group, lane;
  };
  const HairMesh* mesh_;
  const ColumnLayout* layout_;
  int lanes_;
  std::vector<Group> groups_;
  std::vector<int> columns_;  // of each group's lanes, or -1
  std::vector<Place> place_;  // per column
  // Start of each column's diagonals 0, 1, 2 in the values of a ColumnMatrix, or -1.
  std::vector<std::array<std::ptrdiff_t, 3>> source_;
  // Of each row: the inverse of the pivot (6 entries), the blocks of the next vertex and of the one after it (9 each).
  LineVector<T> values_;
  LineVector<T> rows_;  // right-hand sides of one group

  T* at(int column, int layer, int step);
  void clearWithIdentity();
  void mask(std::span<const VertexConstraint> constraints);
  void eliminate();
};

}  // namespace sim
