#include "sim/linear/batch_kernels.h"

#include <cstddef>

#include "sim/linear/lanes.h"

namespace sim {
namespace {

constexpr int kBlock = 6;  // results kept in registers while the inner dimension is walked

template <class T>
struct SidesOf {
  typedef T Type __attribute__((vector_size(kBatchSides * sizeof(T))));
};
template <class T>
using Sides = typename SidesOf<T>::Type;

template <class T>
HAIRMESH_INLINE Sides<T> sidesAt(const T* x, int row) {
  Sides<T> out;
  __builtin_memcpy(&out, x + static_cast<std::ptrdiff_t>(row) * kBatchSides, sizeof out);
  return out;
}
template <class T>
HAIRMESH_INLINE void storeSides(T* x, int row, const Sides<T>& value) {
  __builtin_memcpy(x + static_cast<std::ptrdiff_t>(row) * kBatchSides, &value, sizeof value);
}

// The sums over inner = first .. last - 1 of entry(result, inner) x(inner) for `count` results at once. The entry of
// result r and inner index k lies at a[r * result_step + k * inner_step].
template <int count, class T>
HAIRMESH_INLINE void sums(const T* a, std::ptrdiff_t result_step, std::ptrdiff_t inner_step, int first, int last,
                          const T* x, Sides<T>* out) {
  Sides<T> s[count] = {};
  for (int k = first; k < last; ++k) {
    const Sides<T> xk = sidesAt<T>(x, k);
    const T* at = a + k * inner_step;
#pragma GCC unroll 8
    for (int r = 0; r < count; ++r) s[r] += at[r * result_step] * xk;
  }
#pragma GCC unroll 8
  for (int r = 0; r < count; ++r) out[r] = s[r];
}

// From the last rows up, so that x can be overwritten: row i needs x[0 .. i].
template <class T>
HAIRMESH_INLINE void lower(const T* l, int w, T* x) {
  Sides<T> s[kBlock];
  int end = w;
  for (; end >= kBlock; end -= kBlock) {
    const int begin = end - kBlock;
    sums<kBlock>(l + begin, 1, w, 0, begin, x, s);
    for (int r = 0; r < kBlock; ++r) {
      for (int k = begin; k <= begin + r; ++k) {
        s[r] += l[static_cast<std::ptrdiff_t>(k) * w + begin + r] * sidesAt<T>(x, k);
      }
    }
    for (int r = 0; r < kBlock; ++r) storeSides<T>(x, begin + r, s[r]);
  }
  for (int i = end - 1; i >= 0; --i) {
    sums<1>(l + i, 1, w, 0, i + 1, x, s);
    storeSides<T>(x, i, s[0]);
  }
}

// Row j of L^T X needs x[j .. w - 1].
template <class T>
HAIRMESH_INLINE void upper(const T* l, int w, T* x) {
  Sides<T> s[kBlock];
  int begin = 0;
  for (; begin + kBlock <= w; begin += kBlock) {
    const T* columns = l + static_cast<std::ptrdiff_t>(begin) * w;
    sums<kBlock>(columns, w, 1, begin + kBlock, w, x, s);
    for (int r = 0; r < kBlock; ++r) {
      for (int k = begin + r; k < begin + kBlock; ++k) {
        s[r] += columns[static_cast<std::ptrdiff_t>(r) * w + k] * sidesAt<T>(x, k);
      }
    }
    for (int r = 0; r < kBlock; ++r) storeSides<T>(x, begin + r, s[r]);
  }
  for (; begin < w; ++begin) {
    sums<1>(l + static_cast<std::ptrdiff_t>(begin) * w, w, 1, begin, w, x, s);
    storeSides<T>(x, begin, s[0]);
  }
}

template <class T>
HAIRMESH_INLINE void panel(const T* p, int h, int w, const T* x, T* y) {
  Sides<T> s[kBlock];
  int i = 0;
  for (; i + kBlock <= h; i += kBlock) {
    sums<kBlock>(p + i, 1, h, 0, w, x, s);
    for (int r = 0; r < kBlock; ++r) storeSides<T>(y, i + r, s[r]);
  }
  for (; i < h; ++i) {
    sums<1>(p + i, 1, h, 0, w, x, s);
    storeSides<T>(y, i, s[0]);
  }
}

template <class T>
HAIRMESH_INLINE void panelTransposed(const T* p, int h, int w, const T* x, T* y) {
  Sides<T> s[kBlock];
  int j = 0;
  for (; j + kBlock <= w; j += kBlock) {
    sums<kBlock>(p + static_cast<std::ptrdiff_t>(j) * h, h, 1, 0, h, x, s);
    for (int r = 0; r < kBlock; ++r) storeSides<T>(y, j + r, sidesAt<T>(y, j + r) - s[r]);
  }
  for (; j < w; ++j) {
    sums<1>(p + static_cast<std::ptrdiff_t>(j) * h, h, 1, 0, h, x, s);
    storeSides<T>(y, j, sidesAt<T>(y, j) - s[0]);
  }
}

}  // namespace

HAIRMESH_CLONES void batchLower(const float* l, int w, float* x) {
  lower(l, w, x);
}
HAIRMESH_CLONES void batchLower(const double* l, int w, double* x) {
  lower(l, w, x);
}
HAIRMESH_CLONES void batchUpper(const float* l, int w, float* x) {
  upper(l, w, x);
}
HAIRMESH_CLONES void batchUpper(const double* l, int w, double* x) {
  upper(l, w, x);
}
HAIRMESH_CLONES void batchPanel(const float* p, int h, int w, const float* x, float* y) {
  panel(p, h, w, x, y);
}
HAIRMESH_CLONES void batchPanel(const double* p, int h, int w, const double* x, double* y) {
  panel(p, h, w, x, y);
}
HAIRMESH_CLONES void batchSubtractPanelTransposed(const float* p, int h, int w, const float* x, float* y) {
  panelTransposed(p, h, w, x, y);
}
HAIRMESH_CLONES void batchSubtractPanelTransposed(const double* p, int h, int w, const double* x, double* y) {
  panelTransposed(p, h, w, x, y);
}

}  // namespace sim
