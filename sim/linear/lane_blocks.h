// Blocks of factors that keep many systems side by side in lanes, inverted without the directions of constraints.
#pragma once

#include <cstddef>
#include <span>

#include "sim/linear/vector3.h"
#include "sim/mesh/vertex_constraint.h"

namespace sim {

// The projector of a constraint onto its free directions.
template <class T>
M3<T> keptBy(const VertexConstraint& constraint) {
  M3<T> keep;
  for (int k = 0; k < 9; ++k) keep.m[k] = static_cast<T>(constraint.keep(k / 3, k % 3));
  return keep;
}

// The symmetric block D (xx, xy, xz, yy, yz, zz, `apart` entries from one another) becomes S D S + (I - S) trace D: the
// removed directions stand alone and keep their size. S: symmetric projector.
template <class T>
void maskPivot(T* at, std::ptrdiff_t apart, const M3<T>& s) {
  constexpr int kEntry[9] = {0, 1, 2, 1, 3, 4, 2, 4, 5};
  T d[9], half[9];
  for (int k = 0; k < 9; ++k) d[k] = at[kEntry[k] * apart];
  const T trace = d[0] + d[4] + d[8];
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c)
      half[3 * r + c] = d[3 * r] * s.m[c] + d[3 * r + 1] * s.m[3 + c] + d[3 * r + 2] * s.m[6 + c];
  }
  for (int r = 0; r < 3; ++r) {
    for (int c = r; c < 3; ++c) {
      const T kept = s.m[3 * r] * half[c] + s.m[3 * r + 1] * half[3 + c] + s.m[3 * r + 2] * half[6 + c];
      at[kEntry[3 * r + c] * apart] = kept + trace * (T(r == c) - s.m[3 * r + c]);
    }
  }
}

// The block B (nine entries, row-major, `apart`) becomes S B where its row is the constrained vertex's, else B S.
template <class T>
void maskBlock(T* at, std::ptrdiff_t apart, const M3<T>& s, bool row) {
  const std::ptrdiff_t along = row ? 3 * apart : apart, across = row ? apart : 3 * apart;
  for (int k = 0; k < 3; ++k) {
    T* const line = at + k * across;
    const T x = line[0], y = line[along], z = line[2 * along];
    for (int c = 0; c < 3; ++c) line[c * along] = s.m[3 * c] * x + s.m[3 * c + 1] * y + s.m[3 * c + 2] * z;
  }
}

// d = the inverse of the symmetric block p (xx, xy, xz, yy, yz, zz); that of its diagonal in lanes where it is
// singular. May be given the same place twice.
template <class T, int W>
HAIRMESH_INLINE void invertPivot(const Lanes<T, W>* p, Lanes<T, W>* d) {
  const Lanes<T, W> xx = p[0], xy = p[1], xz = p[2], yy = p[3], yz = p[4], zz = p[5];
  const Lanes<T, W> c0 = yy * zz - yz * yz, c1 = yz * xz - xy * zz, c2 = xy * yz - yy * xz;
  const Lanes<T, W> det = xx * c0 + xy * c1 + xz * c2, scale = xx + yy + zz;
  const Lanes<T, W> one = constant<Lanes<T, W>>(1), zero = constant<Lanes<T, W>>(0);
  const auto regular = det > constant<Lanes<T, W>>(1e-9) * scale * scale * scale;
  const Lanes<T, W> s = one / (regular ? det : one);
  d[0] = regular ? s * c0 : one / xx;
  d[1] = regular ? s * c1 : zero;
  d[2] = regular ? s * c2 : zero;
  d[3] = regular ? s * (xx * zz - xz * xz) : one / yy;
  d[4] = regular ? s * (xy * xz - xx * yz) : zero;
  d[5] = regular ? s * (xx * yy - xy * xy) : one / zz;
}

}  // namespace sim
