// Incomplete Cholesky factor without fill, in 3x3 blocks: L has the pattern of the matrix.
#pragma once

#include <span>
#include <vector>

#include "sim/linear/block_matrix.h"

namespace bench {

using sim::BlockMatrix;
using sim::BlockPattern;
using sim::M3;
using sim::V3;

// L L^T = A on the pattern of A, rows in their own order (column by column of the hair mesh, so that each column's own
// blocks are eliminated exactly). A stiff matrix need not have such a factor: where a pivot fails, the diagonal is
// raised, in steps, until all hold (Manteuffel 1980).
template <class T>
class IncompleteCholesky {
 public:
  // `keep`: rows that take part; the others are left out and answer zero.
  IncompleteCholesky(const BlockPattern& pattern, std::span<const unsigned char> keep);

  // False when no shift tried made the pivots positive (a value was not finite).
  bool factor(const BlockMatrix<T>& a);

  // z = (L L^T)^-1 r.
  void solve(std::span<const V3<T>> r, std::span<V3<T>> z) const;

 private:
  const BlockPattern* pattern_;
  std::vector<unsigned char> keep_;
  std::vector<M3<T>> lower_;    // blocks of L below the diagonal
  std::vector<M3<T>> inverse_;  // inverses of its lower triangular diagonal blocks
  bool factorShifted(const BlockMatrix<T>& a, T shift);
};

}  // namespace bench
