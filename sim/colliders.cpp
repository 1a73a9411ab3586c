#include "sim/colliders.h"

#include <cmath>

namespace sim {
namespace {

// Closest point of the axis-aligned ellipsoid with radii r to p with p >= 0, after Eberly, "Distance from a Point to an
// Ellipse, an Ellipsoid, or a Hyperellipsoid" (2013): the point is r_i^2 p_i / (t + r_i^2) with t the largest root of
// F(t) = sum (r_i p_i / (t + r_i^2))^2 - 1, which falls monotonically for t > -min r^2. The unknown here is s = t / min
// r^2 + 1 >= 0, the distance from the pole of F: near the symmetry plane of the shortest axis the root comes as near to
// the pole as p does to the plane, and t itself would round it away.
Vec3 closestInOctant(const Vec3& r, const Vec3& p) {
  const double smallest = r.minCoeff();
  const Vec3 q = (r / smallest).cwiseAbs2();                                  // squared radii over the smallest, >= 1
  const Vec3 over = (r.array() / smallest - 1) * (r.array() / smallest + 1);  // q - 1 without cancellation
  const Vec3 z = p.cwiseQuotient(r);                                          // p in units of the radii
  int axis = -1;  // the shortest axis; among equals the one on which p lies farthest out
  for (int i = 0; i < 3; ++i) {
    if (over[i] <= 1e-12 && (axis < 0 || z[i] > z[axis])) axis = i;
  }
  if (z[axis] <= 0) {
    // On the plane of symmetry of the shortest axis. Deep inside, the closest point leaves the plane: s = 0 exactly.
    double sum = 0;
    Vec3 point = Vec3::Zero();
    for (int i = 0; i < 3; ++i) {
      if (over[i] <= 1e-12) continue;
      const double u = q[i] * z[i] / over[i];
      point[i] = r[i] * u;
      sum += u * u;
    }
    if (sum < 1) {
      point[axis] = r[axis] * std::sqrt(1 - sum);
      return point;
    }
  }
  // Bracket: at the shortest axis alone the sum is at least one for s = z; with |q z| in place of every term at most
  // one. F is convex and falling, so Newton from the left never oversteps.
  double low = z[axis], high = std::max(q.cwiseProduct(z).norm(), low);
  double s = low;
  for (int iteration = 0; iteration < 80; ++iteration) {
    double value = -1, slope = 0;
    for (int i = 0; i < 3; ++i) {
      if (z[i] <= 0) continue;
      const double u = q[i] * z[i] / (s + over[i]);
      value += u * u;
      slope -= 2 * u * u / (s + over[i]);
    }
    if (value > 0)
      low = s;
    else
      high = s;
    double next = slope < 0 ? s - value / slope : (low + high) / 2;
    if (!(next >= low && next <= high)) next = (low + high) / 2;
    const bool settled = std::abs(next - s) <= 1e-15 * s;
    s = next;
    if (settled) break;
  }
  Vec3 point = Vec3::Zero();
  for (int i = 0; i < 3; ++i) {
    if (z[i] > 0) point[i] = r[i] * q[i] * z[i] / (s + over[i]);
  }
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
