// Cholesky factor of a small symmetric matrix within its envelope: of each row, all entries from the first that is not
// zero to the diagonal (George and Liu, "Computer Solution of Large Sparse Positive Definite Systems", 1981, chapter
// 4). No order is searched: neighbours are to have numbers near one another.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace sim {

template <class T>
class EnvelopeCholesky {
 public:
  // `first`: of each row, the column of its first entry.
  void analyze(std::span<const int> first);

  // The matrix is filled in place: an entry of its lower triangle within the envelope.
  void setZero();
  T& at(int row, int column) { return values_[zero_[row] + column]; }

  // The matrix, positive definite, becomes its factor; false when a pivot is not positive, and it must not be used.
  // Allocates nothing.
  bool factor();
  // x = A^-1 x, one entry a row; allocates nothing.
  void solve(T* x) const;

 private:
  std::vector<int> first_;
  std::vector<std::size_t> zero_;  // per row: where its column 0 would stand in values_
  std::vector<T> values_;          // rows one after the other; of the factor, the diagonal is inverted
};

}  // namespace sim
