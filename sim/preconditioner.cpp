#include "sim/preconditioner.h"

namespace sim {

template <class T>
M3<T> inverse(const M3<T>& a) {
  const T* m = a.m;
  const T c0 = m[4] * m[8] - m[5] * m[7], c1 = m[5] * m[6] - m[3] * m[8], c2 = m[3] * m[7] - m[4] * m[6];
  const T det = m[0] * c0 + m[1] * c1 + m[2] * c2;
  const T scale = m[0] + m[4] + m[8];
  if (!(det > T(1e-9) * scale * scale * scale)) {
    return {T(1) / m[0], 0, 0, 0, T(1) / m[4], 0, 0, 0, T(1) / m[8]};
  }
  const T s = T(1) / det;
  return {s * c0, s * (m[2] * m[7] - m[1] * m[8]), s * (m[1] * m[5] - m[2] * m[4]),
          s * c1, s * (m[0] * m[8] - m[2] * m[6]), s * (m[2] * m[3] - m[0] * m[5]),
          s * c2, s * (m[1] * m[6] - m[0] * m[7]), s * (m[0] * m[4] - m[1] * m[3])};
}

template <class T>
void Preconditioner<T>::update(const BlockMatrix<T>& a, Solver solver) {
  kind = solver;
  inverse_diagonal.resize(a.diagonal.size());
  for (std::size_t i = 0; i < a.diagonal.size(); ++i) {
    const M3<T>& d = a.diagonal[i];
    inverse_diagonal[i] =
        solver == Solver::kDiagonal ? M3<T>{T(1) / d.m[0], 0, 0, 0, T(1) / d.m[4], 0, 0, 0, T(1) / d.m[8]} : inverse(d);
  }
}

template <class T>
void Preconditioner<T>::apply(std::span<const V3<T>> r, std::span<V3<T>> z) {
  for (std::size_t i = 0; i < inverse_diagonal.size(); ++i) z[i] = inverse_diagonal[i] * r[i];
}

template M3<float> inverse(const M3<float>&);
template M3<double> inverse(const M3<double>&);
template struct Preconditioner<float>;
template struct Preconditioner<double>;

}  // namespace sim
