#include "sim/colliders.h"

#include <cmath>

namespace sim {
namespace {

// Closest point of the axis-aligned ellipsoid with radii r to p with p >= 0, after Eberly, "Distance from a Point to an
// Ellipse, an Ellipsoid, or a Hyperellipsoid" (2013): the point is r_i^2 p_i / (t + r_i^2) with t the largest root of
// F(t) = sum (r_i p_i / (t + r_i^2))^2 - 1, which falls monotonically for t > -min r^2. Scaled by the smallest radius.
Vec3 closestInOctant(const Vec3& r, const Vec3& p) {
  const double smallest = r.minCoeff();
  const Vec3 q = (r / smallest).cwiseAbs2();  // squared radii over the smallest, >= 1
  const Vec3 z = p.cwiseQuotient(r);          // p in units of the radii
  // Bracket: at the shortest axis alone the sum is at least one for t = z - 1; with |q z| in place of every term at
  // most one.
  int axis = -1;  // the shortest axis; among equals the one on which p lies farthest out
  for (int i = 0; i < 3; ++i) {
    if (q[i] <= 1 + 1e-12 && (axis < 0 || z[i] > z[axis])) axis = i;
  }
  double low = z[axis] - 1, high = std::max(q.cwiseProduct(z).norm() - 1, low);
  if (z[axis] <= 0) {
    // On the plane of symmetry of the shortest axis. Deep inside, the closest point leaves the plane: t = -1 exactly.
    double sum = 0;
    Vec3 point = Vec3::Zero();
    for (int i = 0; i < 3; ++i) {
      if (q[i] <= 1 + 1e-12) continue;
      const double u = q[i] * z[i] / (q[i] - 1);
      point[i] = r[i] * u;
      sum += u * u;
    }
    if (sum < 1) {
      point[axis] = r[axis] * std::sqrt(1 - sum);
      return point;
    }
  }
  double t = std::max(low, -1 + 1e-15);
  // Bracketed Newton: F is convex and falling right of its pole, so Newton from the left never oversteps.
  for (int iteration = 0; iteration < 80; ++iteration) {
    double value = -1, slope = 0;
    for (int i = 0; i < 3; ++i) {
      const double u = q[i] * z[i] / (t + q[i]);
      value += u * u;
      slope -= 2 * u * u / (t + q[i]);
    }
    if (value > 0)
      low = t;
    else
      high = t;
    double next = slope < 0 ? t - value / slope : (low + high) / 2;
    if (!(next >= low && next <= high)) next = (low + high) / 2;
    if (std::abs(next - t) <= 1e-15 * (1 + std::abs(t))) {
      t = next;
      break;
    }
    t = next;
  }
  Vec3 point;
  for (int i = 0; i < 3; ++i) point[i] = r[i] * q[i] * z[i] / (t + q[i]);
  return point;
}

}  // namespace

double implicitValue(const Ellipsoid& e, const Vec3& p) {
  const Vec3 local = (e.rotation.conjugate() * (p - e.center)).cwiseQuotient(e.radii);
  return local.squaredNorm() - 1;
}

SurfacePoint closestPoint(const Ellipsoid& e, const Vec3& p) {
  const Vec3 local = e.rotation.conjugate() * (p - e.center);
  const Vec3 closest = closestInOctant(e.radii, local.cwiseAbs());
  Vec3 surface;
  for (int i = 0; i < 3; ++i) surface[i] = local[i] < 0 ? -closest[i] : closest[i];
  // The gradient of the implicit function there; radii divide twice.
  const Vec3 normal = surface.cwiseQuotient(e.radii).cwiseQuotient(e.radii).normalized();
  SurfacePoint out;
  out.point = e.center + e.rotation * surface;
  out.normal = e.rotation * normal;
  const bool inside = local.cwiseQuotient(e.radii).squaredNorm() < 1;
  out.distance = (local - surface).norm() * (inside ? -1 : 1);
  return out;
}

Vec3 surfaceVelocity(const Ellipsoid& e, const Vec3& p) {
  return e.velocity + e.angular_velocity.cross(p - e.center);
}

}  // namespace sim
