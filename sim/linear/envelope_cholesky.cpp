#include "sim/linear/envelope_cholesky.h"

#include <algorithm>
#include <cmath>

#include "sim/linear/lanes.h"

namespace sim {
namespace {

template <class T>
HAIRMESH_INLINE T dotProduct(const T* a, const T* b, int n) {
  Lanes<T> lanes{};
  int i = 0;
  for (; i + kLanes <= n; i += kLanes) lanes += load<T>(a + i) * load<T>(b + i);
  T sum = 0;
  for (; i < n; ++i) sum += a[i] * b[i];
  for (int k = 0; k < kLanes; ++k) sum += lanes[k];
  return sum;
}

// Row by row: L_ij = (A_ij - L_i . L_j) / L_jj.
template <class T>
HAIRMESH_INLINE bool factorRows(int rows, const int* first, const std::size_t* zero, T* values) {
  for (int i = 0; i < rows; ++i) {
    T* const row = values + zero[i];
    for (int j = first[i]; j < i; ++j) {
      const T* const other = values + zero[j];
      const int from = std::max(first[i], first[j]);
      row[j] = (row[j] - dotProduct<T>(row + from, other + from, j - from)) * other[j];
    }
    const T pivot = row[i] - dotProduct<T>(row + first[i], row + first[i], i - first[i]);
    if (!(pivot > 0)) return false;
    row[i] = T(1) / std::sqrt(pivot);
  }
  return true;
}

template <class T>
HAIRMESH_INLINE void solveRows(int rows, const int* first, const std::size_t* zero, const T* values, T* x) {
  for (int i = 0; i < rows; ++i) {
    const T* const row = values + zero[i];
    x[i] = (x[i] - dotProduct<T>(row + first[i], x + first[i], i - first[i])) * row[i];
  }
  for (int i = rows - 1; i >= 0; --i) {
    const T* const row = values + zero[i];
    const T value = x[i] *= row[i];
    for (int j = first[i]; j < i; ++j) x[j] -= row[j] * value;
  }
}

#define HAIRMESH_KERNELS(T)                                                                           \
  HAIRMESH_CLONES bool runFactor(int rows, const int* first, const std::size_t* zero, T* values) {    \
    return factorRows<T>(rows, first, zero, values);                                                  \
  }                                                                                                   \
  HAIRMESH_CLONES void runSolve(int n, const int* first, const std::size_t* zero, const T* l, T* x) { \
    solveRows<T>(n, first, zero, l, x);                                                               \
  }
HAIRMESH_KERNELS(float)
HAIRMESH_KERNELS(double)
#undef HAIRMESH_KERNELS

}  // namespace

template <class T>
void EnvelopeCholesky<T>::analyze(std::span<const int> first) {
  first_.assign(first.begin(), first.end());
  zero_.clear();
  std::size_t size = 0;
  for (std::size_t row = 0; row < first.size(); ++row) {
    zero_.push_back(size - first[row]);
    size += row + 1 - first[row];
  }
  values_.resize(size);
}

template <class T>
void EnvelopeCholesky<T>::setZero() {
  std::fill(values_.begin(), values_.end(), T(0));
}

template <class T>
bool EnvelopeCholesky<T>::factor() {
  return runFactor(static_cast<int>(first_.size()), first_.data(), zero_.data(), values_.data());
}

template <class T>
void EnvelopeCholesky<T>::solve(T* x) const {
  runSolve(static_cast<int>(first_.size()), first_.data(), zero_.data(), values_.data(), x);
}

template class EnvelopeCholesky<float>;
template class EnvelopeCholesky<double>;

}  // namespace sim
