// Dense kernels of the triangular solves, compiled for several instruction sets and picked at run time.
//
// Matrices are column-major. Each kernel exists for float and double; results of different instruction sets agree
// within rounding (the lanes of a dot product are summed in another order), results of one are the same on every call.
#pragma once

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

}  // namespace sim
