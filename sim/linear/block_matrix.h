// Symmetric sparse matrix of 3x3 blocks with a fixed pattern: the diagonal and the blocks below it.
#pragma once

#include <utility>
#include <vector>

#include "sim/linear/vector3.h"

namespace sim {

// Which blocks exist. Row i's blocks below the diagonal are columns[row_first[i] .. row_first[i + 1]), ascending.
struct BlockPattern {
  int size = 0;  // block rows
  std::vector<int> row_first{0};
  std::vector<int> columns;
  // Number of block (i, j), i > j; -1 when the pattern lacks it.
  int find(int i, int j) const;
};

// The pattern with a block for every given pair of distinct vertices (either order, repeats allowed).
BlockPattern makePattern(int size, std::vector<std::pair<int, int>> pairs);

template <class T>
struct BlockMatrix {
  const BlockPattern* pattern = nullptr;
  std::vector<M3<T>> diagonal;  // one per row, symmetric
  std::vector<M3<T>> lower;     // one per pattern block

  explicit BlockMatrix(const BlockPattern* p = nullptr) : pattern(p) {
    if (p) diagonal.resize(p->size), lower.resize(p->columns.size());
  }
  void setZero() {
    for (M3<T>& b : diagonal) b = M3<T>{};
    for (M3<T>& b : lower) b = M3<T>{};
  }
};

}  // namespace sim
