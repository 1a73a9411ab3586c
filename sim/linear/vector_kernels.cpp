#include "sim/linear/vector_kernels.h"

#include "sim/linear/lanes.h"

namespace sim {
namespace {

template <class T>
HAIRMESH_INLINE double inner(const T* a, const T* b, std::size_t n) {
  Lanes<double> one{}, two{};  // two chains: an addition takes longer than a product comes
  std::size_t i = 0;
  for (; i + 2 * kLanes <= n; i += 2 * kLanes) {
    one += __builtin_convertvector(load<T>(a + i) * load<T>(b + i), Lanes<double>);
    two += __builtin_convertvector(load<T>(a + i + kLanes) * load<T>(b + i + kLanes), Lanes<double>);
  }
  one += two;
  double sum = 0;
  for (int k = 0; k < kLanes; ++k) sum += one[k];
  for (; i < n; ++i) sum += static_cast<double>(a[i] * b[i]);
  return sum;
}

template <class T>
HAIRMESH_INLINE void add(T s, const T* __restrict x, T* __restrict y, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) y[i] += s * x[i];
}
template <class T>
HAIRMESH_INLINE void scale(T s, const T* __restrict x, T* __restrict y, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) y[i] = x[i] + s * y[i];
}

#define HAIRMESH_KERNELS(T)                                                \
  HAIRMESH_CLONES double runInner(const T* a, const T* b, std::size_t n) { \
    return inner(a, b, n);                                                 \
  }                                                                        \
  HAIRMESH_CLONES void runAdd(T s, const T* x, T* y, std::size_t n) {      \
    add(s, x, y, n);                                                       \
  }                                                                        \
  HAIRMESH_CLONES void runScale(T s, const T* x, T* y, std::size_t n) {    \
    scale(s, x, y, n);                                                     \
  }
HAIRMESH_KERNELS(float)
HAIRMESH_KERNELS(double)
#undef HAIRMESH_KERNELS

// The components one after the other.
template <class V>
auto flat(std::span<V> v) {
  return v.empty() ? nullptr : &v[0].x;
}

}  // namespace

template <class T>
double innerProduct(std::span<const V3<T>> a, std::span<const V3<T>> b) {
  return runInner(flat(a), flat(b), 3 * a.size());
}

template <class T>
void addScaled(T s, std::span<const V3<T>> x, std::span<V3<T>> y) {
  runAdd(s, flat(x), flat(y), 3 * x.size());
}

template <class T>
void scaleAndAdd(T s, std::span<const V3<T>> x, std::span<V3<T>> y) {
  runScale(s, flat(x), flat(y), 3 * x.size());
}

template double innerProduct(std::span<const V3<float>>, std::span<const V3<float>>);
template double innerProduct(std::span<const V3<double>>, std::span<const V3<double>>);
template void addScaled(float, std::span<const V3<float>>, std::span<V3<float>>);
template void addScaled(double, std::span<const V3<double>>, std::span<V3<double>>);
template void scaleAndAdd(float, std::span<const V3<float>>, std::span<V3<float>>);
template void scaleAndAdd(double, std::span<const V3<double>>, std::span<V3<double>>);

}  // namespace sim
