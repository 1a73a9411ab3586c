#include "sim/linear/dense_kernels.h"

#include <algorithm>
#include <cstddef>

#include "sim/linear/lanes.h"

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

// Tiles of one register by six, or two by six, leave room for what they are multiplied by.
constexpr int kTileColumns = 6;
constexpr int kDepth = 256;  // of the sums at a time: a strip of so many columns stays in the first-level cache
template <class T>
constexpr int kTileRows = 64 / sizeof(T);

// c += s (strip) b for a strip of kTileRows rows, packed, of which c has `rows`.
template <class T, int kColumns>
HAIRMESH_INLINE void addTile(T s, const T* strip, RightFactor<T> b, int depth, int rows, T* c, int ldc) {
  constexpr int kRows = kTileRows<T>;
  using Row = Lanes<T, kRows>;
  Row sum[kColumns] = {};
  for (int p = 0; p < depth; ++p) {
    const Row a = load<T, kRows>(strip + p * kRows);
    const T* from = b.values + p * b.row;
    for (int j = 0; j < kColumns; ++j) sum[j] += a * from[j * b.column];
  }
  for (int j = 0; j < kColumns; ++j) {
    T* to = c + static_cast<std::size_t>(j) * ldc;
    if (rows == kRows) {
      addTo<T, kRows>(to, s * sum[j]);
    } else {
      for (int i = 0; i < rows; ++i) to[i] += s * sum[j][i];
    }
  }
}

template <class T>
HAIRMESH_INLINE void product(T s, const T* a, int lda, const RightFactor<T>& b, int m, int n, int k, T* c, int ldc) {
  constexpr int kRows = kTileRows<T>;
  T strip[kRows * kDepth];
  for (int from = 0; from < k; from += kDepth) {
    const int depth = std::min(kDepth, k - from);
    for (int i = 0; i < m; i += kRows) {
      const int rows = std::min(kRows, m - i);
      for (int p = 0; p < depth; ++p) {
        const T* column = a + static_cast<std::size_t>(from + p) * lda + i;
        for (int r = 0; r < kRows; ++r) strip[p * kRows + r] = r < rows ? column[r] : T(0);
      }
      int j = 0;
      const auto right = [&](int column) {
        return RightFactor<T>{b.values + from * b.row + column * b.column, b.row, b.column};
      };
      const auto at = [&](int column) { return c + static_cast<std::size_t>(column) * ldc + i; };
      for (; j + kTileColumns <= n; j += kTileColumns)
        addTile<T, kTileColumns>(s, strip, right(j), depth, rows, at(j), ldc);
      for (; j + 3 <= n; j += 3) addTile<T, 3>(s, strip, right(j), depth, rows, at(j), ldc);
      for (; j < n; ++j) addTile<T, 1>(s, strip, right(j), depth, rows, at(j), ldc);
    }
  }
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
HAIRMESH_CLONES void addProduct(float s, const float* a, int lda, const RightFactor<float>& b, int m, int n, int k,
                                float* c, int ldc) {
  product(s, a, lda, b, m, n, k, c, ldc);
}
HAIRMESH_CLONES void addProduct(double s, const double* a, int lda, const RightFactor<double>& b, int m, int n, int k,
                                double* c, int ldc) {
  product(s, a, lda, b, m, n, k, c, ldc);
}

}  // namespace sim
