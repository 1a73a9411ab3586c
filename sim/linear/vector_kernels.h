// What the iterations do with whole fields of vectors, compiled for several instruction sets. Results of different sets
// agree within rounding, those of one are the same on every call.
#pragma once

#include <span>

#include "sim/linear/vector3.h"

namespace sim {

// The sum over all entries of a . b, accumulated in double whatever T: single-precision sums of thousands of terms
// would decide a solve's stop by rounding.
template <class T>
double innerProduct(std::span<const V3<T>> a, std::span<const V3<T>> b);

// y += s x.
template <class T>
void addScaled(T s, std::span<const V3<T>> x, std::span<V3<T>> y);

// y = x + s y.
template <class T>
void scaleAndAdd(T s, std::span<const V3<T>> x, std::span<V3<T>> y);

}  // namespace sim
