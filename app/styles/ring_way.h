// Ways over the head that hair is combed to a ring: circles on the sphere of directions from the head's middle. All of
// them part at one direction, the source.
#pragma once

#include "app/styles/hair_styles.h"

namespace app {

// The direction that all ways to `end` come from. It is opposite to `end`, and ways are great circles. Where hair grows
// there, it is the nearest direction in the face. Of an `end` over the face it is the opposite in any case. `side`: -1
// or 1 where hair of that sign of x alone goes to the ring; 0: all. All unit.
Vec3 sourceOf(const Vec3& end, int side);

// The arc from one direction to another on the circle that they make with `source`, which it does not pass. All unit.
class RingWay {
 public:
  RingWay(const Vec3& from, const Vec3& to, const Vec3& source);

  Vec3 at(double share) const;  // unit; share 0 to 1
  double length() const;        // on the unit sphere
  bool great() const;           // a great circle

 private:
  Vec3 middle_ = Vec3::Zero(), first_, beside_ = Vec3::Zero();  // middle + cos(a) first + sin(a) beside
  double angle_ = 0;                                            // rad, from 0 to which `a` goes
};

}  // namespace app
