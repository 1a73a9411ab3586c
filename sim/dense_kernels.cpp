#include "sim/dense_kernels.h"

#include <cstddef>

#include "sim/lanes.h"

namespace sim {
namespace {

constexpr int kSums = 16;  // partial sums of a dot product

template <class T>
HAIRMESH_INLINE T dotProduct(const T* a, const T* b, int n) {
  T lanes[kSums] = {};
  int i = 0;
  for (; i + kSums <= n; i += kSums) {
    for (int k = 0; k < kSums; ++k) lanes[k] += a[i + k] * b[i + k];
  }
  T sum = 0;
  for (; i < n; ++i) sum += a[i] * b[i];
  for (int width = kSums / 2; width > 0; width /= 2) {
    for (int k = 0; k < width; ++k) lanes[k] += lanes[k + width];
  }
  return sum + lanes[0];
}

// From the last row up, so that x can be overwritten: row i needs x[0 .. i]. Columns are walked so that memory is
// contiguous.
template <class T>
HAIRMESH_INLINE void lowerInPlace(const T* l, int w, T* x) {
  for (int j = w - 1; j >= 0; --j) {
    const T* column = l + static_cast<std::size_t>(j) * w;
    const T xj = x[j];
    x[j] = column[j] * xj;
    for (int i = j + 1; i < w; ++i) x[i] += column[i] * xj;
  }
}

template <class T>
HAIRMESH_INLINE void upperInPlace(const T* l, int w, T* x) {
  for (int j = 0; j < w; ++j) x[j] = dotProduct(l + static_cast<std::size_t>(j) * w + j, x + j, w - j);
}

template <class T>
HAIRMESH_INLINE void panel(const T* p, int h, int w, const T* x, T* y) {
  for (int i = 0; i < h; ++i) y[i] = 0;
  int j = 0;
  for (; j + 3 <= w; j += 3) {
    const T* a = p + static_cast<std::size_t>(j) * h;
    const T *b = a + h, *c = b + h;
    const T xa = x[j], xb = x[j + 1], xc = x[j + 2];
    for (int i = 0; i < h; ++i) y[i] += (a[i] * xa + b[i] * xb) + c[i] * xc;
  }
}

template <class T>
HAIRMESH_INLINE void panelTransposed(const T* p, int h, int w, const T* x, T* y) {
  for (int j = 0; j < w; ++j) y[j] -= dotProduct(p + static_cast<std::size_t>(j) * h, x, h);
}

}  // namespace

HAIRMESH_CLONES void multiplyLowerInPlace(const float* l, int w, float* x) {
  lowerInPlace(l, w, x);
}
HAIRMESH_CLONES void multiplyLowerInPlace(const double* l, int w, double* x) {
  lowerInPlace(l, w, x);
}
HAIRMESH_CLONES void multiplyUpperInPlace(const float* l, int w, float* x) {
  upperInPlace(l, w, x);
}
HAIRMESH_CLONES void multiplyUpperInPlace(const double* l, int w, double* x) {
  upperInPlace(l, w, x);
}
HAIRMESH_CLONES void multiplyPanel(const float* p, int h, int w, const float* x, float* y) {
  panel(p, h, w, x, y);
}
HAIRMESH_CLONES void multiplyPanel(const double* p, int h, int w, const double* x, double* y) {
  panel(p, h, w, x, y);
}
HAIRMESH_CLONES void subtractPanelTransposed(const float* p, int h, int w, const float* x, float* y) {
  panelTransposed(p, h, w, x, y);
}
HAIRMESH_CLONES void subtractPanelTransposed(const double* p, int h, int w, const double* x, double* y) {
  panelTransposed(p, h, w, x, y);
}

}  // namespace sim
