// Ellipsoids fitted to pieces of a surface.
#pragma once

#include <span>

#include "app/figure/character.h"

namespace app {

struct FitPoint {
  Vec3 position;      // m
  double weight = 1;  // area it stands for
};

// How a surface lies against an ellipsoid: signed gaps (m), positive where the surface sticks out.
struct FitReport {
  double mean_gap = 0, max_gap = 0, rms_gap = 0;
};

// A start: axes of the points' scatter, radii from its extent. Needs four points or more.
BodyEllipsoid principalEllipsoid(std::span<const FitPoint> points);

// Least squares of the first-order gap over centre, axes and radii, robust against outliers beyond about 1 cm, held to
// the start by `hold` (m: how far a parameter may drift at the cost of one such gap everywhere), so that a piece seen
// from one side keeps a sensible far side. Points outside the ellipsoid count `outside` times those inside: above 1 the
// surface is rather covered than cut. Levenberg-Marquardt, deterministic. Radii stay above 5 mm. Keeps name and joint.
BodyEllipsoid fitEllipsoid(std::span<const FitPoint> points, const BodyEllipsoid& start, double hold,
                           double outside = 1);

// First-order signed distance (m) of a point to the ellipsoid's surface, in the ellipsoid's own joint frame.
double ellipsoidGap(const BodyEllipsoid& e, const Vec3& p);

FitReport reportFit(std::span<const FitPoint> points, const BodyEllipsoid& e);

}  // namespace app
