// The product of a matrix of blocks with a vector, plainly.
#pragma once

#include <span>

#include "sim/linear/block_matrix.h"

namespace sim {

// y = A x.
template <class T>
void multiply(const BlockMatrix<T>& a, std::span<const V3<T>> x, std::span<V3<T>> y) {
  const BlockPattern& pattern = *a.pattern;
  for (int i = 0; i < pattern.size; ++i) y[i] = a.diagonal[i] * x[i];
  for (int i = 0; i < pattern.size; ++i) {
    V3<T> sum{0, 0, 0};
    const V3<T> xi = x[i];
    for (int k = pattern.row_first[i]; k < pattern.row_first[i + 1]; ++k) {
      const int j = pattern.columns[k];
      sum += a.lower[k] * x[j];
      y[j] += transposeTimes(a.lower[k], xi);
    }
    y[i] += sum;
  }
}

}  // namespace sim
