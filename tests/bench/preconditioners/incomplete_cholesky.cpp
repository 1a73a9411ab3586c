#include "tests/bench/preconditioners/incomplete_cholesky.h"

#include <cmath>

namespace bench {
namespace {

constexpr double kFirstShift = 1e-3;  // of the diagonal
constexpr int kShifts = 10;

// a -= b c^T.
template <class T>
void subtractProduct(M3<T>& a, const M3<T>& b, const M3<T>& c) {
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      a.m[3 * i + j] -= b.m[3 * i] * c.m[3 * j] + b.m[3 * i + 1] * c.m[3 * j + 1] + b.m[3 * i + 2] * c.m[3 * j + 2];
    }
  }
}

// The inverse of the Cholesky factor of a 3x3 block, lower triangular; false when the block is not positive definite.
template <class T>
bool invertFactor(const M3<T>& a, M3<T>& inverse) {
  const T* m = a.m;
  if (!(m[0] > 0)) return false;
  const T l00 = std::sqrt(m[0]), l10 = m[3] / l00, l20 = m[6] / l00;
  const T second = m[4] - l10 * l10;
  if (!(second > 0)) return false;
  const T l11 = std::sqrt(second), l21 = (m[7] - l20 * l10) / l11;
  const T third = m[8] - l20 * l20 - l21 * l21;
  if (!(third > 0)) return false;
  const T l22 = std::sqrt(third);
  inverse = {1 / l00, 0, 0, -l10 / (l00 * l11), 1 / l11, 0, 0, -l21 / (l11 * l22), 1 / l22};
  inverse.m[6] = (l10 * l21 - l20 * l11) / (l00 * l11 * l22);
  return std::isfinite(inverse.m[6]);
}

}  // namespace

template <class T>
IncompleteCholesky<T>::IncompleteCholesky(const BlockPattern& pattern, std::span<const unsigned char> keep)
    : pattern_(&pattern), keep_(keep.begin(), keep.end()), lower_(pattern.columns.size()), inverse_(pattern.size) {}

template <class T>
bool IncompleteCholesky<T>::factor(const BlockMatrix<T>& a) {
  T shift = 0;
  for (int k = 0; k <= kShifts; ++k) {
    if (factorShifted(a, shift)) return true;
    shift = shift > 0 ? 3 * shift : static_cast<T>(kFirstShift);
  }
  return false;
}

template <class T>
bool IncompleteCholesky<T>::factorShifted(const BlockMatrix<T>& a, T shift) {
  const BlockPattern& p = *pattern_;
  for (int i = 0; i < p.size; ++i) {
    if (!keep_[i]) continue;
    M3<T> diagonal = a.diagonal[i];
    for (int k = 0; k < 9; k += 4) diagonal.m[k] *= T(1) + shift;
    for (int e = p.row_first[i]; e < p.row_first[i + 1]; ++e) {
      const int j = p.columns[e];
      if (!keep_[j]) continue;
      // A_ij less what the columns before j, shared by both rows, have taken.
      M3<T> block = a.lower[e];
      int f = p.row_first[i], g = p.row_first[j];
      while (f < e && g < p.row_first[j + 1]) {
        if (p.columns[f] < p.columns[g]) {
          ++f;
        } else if (p.columns[g] < p.columns[f]) {
          ++g;
        } else {
          if (keep_[p.columns[f]]) subtractProduct(block, lower_[f], lower_[g]);
          ++f, ++g;
        }
      }
      lower_[e] = M3<T>{};
      M3<T> negative = inverse_[j];
      for (T& value : negative.m) value = -value;
      subtractProduct(lower_[e], block, negative);
      subtractProduct(diagonal, lower_[e], lower_[e]);
    }
    if (!invertFactor(diagonal, inverse_[i])) return false;
  }
  return true;
}

template <class T>
void IncompleteCholesky<T>::solve(std::span<const V3<T>> r, std::span<V3<T>> z) const {
  const BlockPattern& p = *pattern_;
  for (int i = 0; i < p.size; ++i) {
    V3<T> sum = r[i];
    if (!keep_[i]) {
      z[i] = {0, 0, 0};
      continue;
    }
    for (int e = p.row_first[i]; e < p.row_first[i + 1]; ++e) {
      if (keep_[p.columns[e]]) sum -= lower_[e] * z[p.columns[e]];
    }
    z[i] = inverse_[i] * sum;
  }
  for (int i = p.size - 1; i >= 0; --i) {
    if (!keep_[i]) continue;
    z[i] = transposeTimes(inverse_[i], z[i]);
    for (int e = p.row_first[i]; e < p.row_first[i + 1]; ++e) {
      if (keep_[p.columns[e]]) z[p.columns[e]] -= transposeTimes(lower_[e], z[i]);
    }
  }
}

template class IncompleteCholesky<float>;
template class IncompleteCholesky<double>;

}  // namespace bench
