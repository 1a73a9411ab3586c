// The inverse of many symmetric blocks at once, for the factors that eliminate side by side in lanes.
#pragma once

#include "sim/linear/lanes.h"

namespace sim {

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
