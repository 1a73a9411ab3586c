// One ellipsoid against the skin that it is to cover and the skin that it is not to bury.
#pragma once

#include <span>

#include "app/figure/ellipsoid_fit.h"

namespace app {

// A point of skin in the frame of the ellipsoid's joint.
struct CoverPoint {
  Vec3 position;      // m
  double weight = 1;  // its share of all
  bool own = true;    // to be covered; any other only counts where it lies inside
};

// Least squares over centre, axes and radii: an own point that sticks out counts much, and the more the farther out;
// own points below the surface and others inside count as they are deep, up to where they are some other part's
// business. `hold` (m): how far a parameter may drift at the cost of a gap of 10 mm everywhere. Levenberg-Marquardt
// with the derivatives of the first-order gap; deterministic. Radii stay above 5 mm. Keeps name and joint.
BodyEllipsoid fitCover(std::span<const CoverPoint> points, const BodyEllipsoid& start, double hold);

}  // namespace app
