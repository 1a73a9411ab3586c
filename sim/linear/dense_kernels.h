// Dense kernels of the triangular solves and of the factorization before them, compiled for several instruction sets
// and picked at run time.
//
// Matrices are column-major. Each kernel exists for float and double; results of different instruction sets agree
// within rounding (the lanes of a dot product are summed in another order), results of one are the same on every call.
#pragma once

#include <cstddef>

namespace sim {

// x = L x for a dense lower triangle L (w x w, leading dimension w), in place.
void multiplyLowerInPlace(const float* l, int w, float* x);
void multiplyLowerInPlace(const double* l, int w, double* x);

// x = L^T x, in place.
void multiplyUpperInPlace(const float* l, int w, float* x);
void multiplyUpperInPlace(const double* l, int w, double* x);

// y = P x for a panel P (h x w, leading dimension h).
void multiplyPanel(const float* p, int h, int w, const float* x, float* y);
void multiplyPanel(const double* p, int h, int w, const double* x, double* y);

// y -= P^T x.
void subtractPanelTransposed(const float* p, int h, int w, const float* x, float* y);
void subtractPanelTransposed(const double* p, int h, int w, const double* x, double* y);

// A right factor B (k x n): row p, column j is values[p * row + j * column].
template <class T>
struct RightFactor {
  const T* values;
  std::ptrdiff_t row, column;
};
// B itself, of leading dimension ldb; and the transpose of a matrix (n x k) of leading dimension ldb.
template <class T>
RightFactor<T> plain(const T* b, int ldb) {
  return {b, 1, ldb};
}
template <class T>
RightFactor<T> transposed(const T* b, int ldb) {
  return {b, ldb, 1};
}

// C += s A B for A (m x k, leading dimension lda), B (k x n) and C (m x n, ldc), which overlaps neither.
void addProduct(float s, const float* a, int lda, const RightFactor<float>& b, int m, int n, int k, float* c, int ldc);
void addProduct(double s, const double* a, int lda, const RightFactor<double>& b, int m, int n, int k, double* c,
                int ldc);

}  // namespace sim
