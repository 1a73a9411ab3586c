// Dense kernels of triangular solves with sixteen right-hand sides at once: x[row * kBatchSides + side].
//
// Matrices are column-major. Like those of dense_kernels.h, for float and double, the instruction set picked at run
// time; results of different ones agree within rounding.
#pragma once

namespace sim {

inline constexpr int kBatchSides = 16;

// X = L X for a dense lower triangle L (w x w, leading dimension w), in place; X = L^T X.
void batchLower(const float* l, int w, float* x);
void batchLower(const double* l, int w, double* x);
void batchUpper(const float* l, int w, float* x);
void batchUpper(const double* l, int w, double* x);

// Y = P X for a panel P (h x w, leading dimension h); Y -= P^T X.
void batchPanel(const float* p, int h, int w, const float* x, float* y);
void batchPanel(const double* p, int h, int w, const double* x, double* y);
void batchSubtractPanelTransposed(const float* p, int h, int w, const float* x, float* y);
void batchSubtractPanelTransposed(const double* p, int h, int w, const double* x, double* y);

}  // namespace sim
