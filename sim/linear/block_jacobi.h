// The paper's preconditioner: the inverse of every vertex's 3x3 block.
#pragma once

#include <span>
#include <vector>

#include "sim/linear/column_matrix.h"

namespace sim {

// Inverse of a symmetric positive definite 3x3 block; of a singular one, the inverse of its diagonal.
template <class T>
M3<T> inverse(const M3<T>& a) {
  const T* m = a.m;
  const T c0 = m[4] * m[8] - m[5] * m[7], c1 = m[5] * m[6] - m[3] * m[8], c2 = m[3] * m[7] - m[4] * m[6];
  const T det = m[0] * c0 + m[1] * c1 + m[2] * c2;
  const T scale = m[0] + m[4] + m[8];
  if (!(det > T(1e-9) * scale * scale * scale)) return {T(1) / m[0], 0, 0, 0, T(1) / m[4], 0, 0, 0, T(1) / m[8]};
  const T s = T(1) / det;
  return {s * c0, s * (m[2] * m[7] - m[1] * m[8]), s * (m[1] * m[5] - m[2] * m[4]),
          s * c1, s * (m[0] * m[8] - m[2] * m[6]), s * (m[2] * m[3] - m[0] * m[5]),
          s * c2, s * (m[1] * m[6] - m[0] * m[7]), s * (m[0] * m[4] - m[1] * m[3])};
}

template <class T>
struct BlockJacobi {
  std::vector<M3<T>> inverses;  // one per vertex

  explicit BlockJacobi(int vertices) : inverses(vertices) {}
  void update(const ColumnMatrix<T>& a) {
    for (std::size_t i = 0; i < inverses.size(); ++i) inverses[i] = inverse(a.diagonalBlock(static_cast<int>(i)));
  }
  void apply(std::span<const V3<T>> r, std::span<V3<T>> z) const {
    for (std::size_t i = 0; i < inverses.size(); ++i) z[i] = inverses[i] * r[i];
  }
};

}  // namespace sim
