// Three-vectors and 3x3 matrices of any scalar, SIMD lanes included. Eigen stays out of the kernels: they are compiled
// for several instruction sets, and an inline Eigen function compiled for one must not be linked into another.
#pragma once

#include "sim/linear/lanes.h"

namespace sim {

template <class T>
struct V3 {
  T x, y, z;
};

template <class T>
HAIRMESH_INLINE V3<T> operator+(const V3<T>& a, const V3<T>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class T>
HAIRMESH_INLINE V3<T> operator-(const V3<T>& a, const V3<T>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class T>
HAIRMESH_INLINE V3<T> operator*(T s, const V3<T>& a) {
  return {s * a.x, s * a.y, s * a.z};
}
template <class T>
HAIRMESH_INLINE V3<T>& operator+=(V3<T>& a, const V3<T>& b) {
  a.x += b.x, a.y += b.y, a.z += b.z;
  return a;
}
template <class T>
HAIRMESH_INLINE V3<T>& operator-=(V3<T>& a, const V3<T>& b) {
  a.x -= b.x, a.y -= b.y, a.z -= b.z;
  return a;
}
template <class T>
HAIRMESH_INLINE T dot(const V3<T>& a, const V3<T>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class T>
HAIRMESH_INLINE V3<T> cross(const V3<T>& a, const V3<T>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

// Row-major 3x3.
template <class T>
struct M3 {
  T m[9];
};

template <class T>
HAIRMESH_INLINE V3<T> operator*(const M3<T>& a, const V3<T>& b) {
  return {a.m[0] * b.x + a.m[1] * b.y + a.m[2] * b.z, a.m[3] * b.x + a.m[4] * b.y + a.m[5] * b.z,
          a.m[6] * b.x + a.m[7] * b.y + a.m[8] * b.z};
}
template <class T>
HAIRMESH_INLINE V3<T> transposeTimes(const M3<T>& a, const V3<T>& b) {
  return {a.m[0] * b.x + a.m[3] * b.y + a.m[6] * b.z, a.m[1] * b.x + a.m[4] * b.y + a.m[7] * b.z,
          a.m[2] * b.x + a.m[5] * b.y + a.m[8] * b.z};
}

}  // namespace sim
