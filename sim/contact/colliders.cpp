#include "sim/contact/colliders.h"

#include <algorithm>
#include <cmath>

namespace sim {
namespace {

constexpr int kMaxNewton = 30;
constexpr double kSettled = 1e-10;  // relative change: what the next iteration would add is its square

// Closest point of the axis-aligned ellipsoid with radii r to p >= 0, after Eberly, "Distance from a Point to an
// Ellipse, an Ellipsoid, or a Hyperellipsoid" (2013): the point is r_i^2 p_i / (t + r_i^2) with t the largest root of
// F(t) = sum (r_i p_i / (t + r_i^2))^2 - 1, which falls monotonically for t > -min r^2. The unknown here is the
// distance from the pole of F, s = t / min r^2 + 1 >= 0, which keeps its digits near the symmetry plane of the shortest
// axis.
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
  // Bracket: every term alone is one where s = q z - over; with |q z| in place of every term the sum is at most one.
  const Vec3 qz = q.cwiseProduct(z);
  double low = std::max(z[axis], (qz - over).maxCoeff()), high = std::max(qz.norm(), low);
  double s = low;
  // Newton's method on 1 / sqrt(F + 1) = 1, whose left side is nearly linear in s: four iterations, seldom ten.
  for (int iteration = 0; iteration < kMaxNewton; ++iteration) {
    double sum = 0, slope = 0;
    for (int i = 0; i < 3; ++i) {
      if (z[i] <= 0) continue;
      const double inverse = 1 / (s + over[i]), u = qz[i] * inverse;
      sum += u * u;
      slope += u * u * inverse;
    }
    if (sum > 1)
      low = s;
    else
      high = s;
    double next = slope > 0 ? s + sum * (std::sqrt(sum) - 1) / slope : (low + high) / 2;
    if (!(next >= low && next <= high)) next = (low + high) / 2;
    const bool settled = std::abs(next - s) <= kSettled * s;
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

Vec3 carriedAlong(const Ellipsoid& e, const Vec3& start, double dt) {
  const double angle = e.angular_velocity.norm() * dt;
  const Vec3 arm = start - (e.center - dt * e.velocity);
  if (angle < 1e-12) return e.center + arm;
  return e.center + Eigen::AngleAxisd(angle, e.angular_velocity.normalized()) * arm;
}

double distanceAt(const DistanceGrid& grid, const Vec3& local) {
  std::array<int, 3> cell;
  Vec3 share, beyond;
  for (int a = 0; a < 3; ++a) {
    const double most = grid.nodes[a] - 1, at = (local[a] - grid.low[a]) / grid.spacing;
    const double within = std::clamp(at, 0.0, most);
    cell[a] = std::min(static_cast<int>(within), grid.nodes[a] - 2);
    share[a] = within - cell[a];
    beyond[a] = at - within;
  }
  const std::size_t row = grid.nodes[0], slice = row * grid.nodes[1];
  const float* v = grid.values.data() + cell[2] * slice + cell[1] * row + cell[0];
  const auto along = [&](const float* at) { return at[0] + share.x() * (at[1] - at[0]); };
  const double near = along(v) + share.y() * (along(v + row) - along(v));
  const double far = along(v + slice) + share.y() * (along(v + slice + row) - along(v + slice));
  return near + share.z() * (far - near) + grid.spacing * beyond.norm();
}

SurfacePoint closestPoint(const BodySdf& part, const Vec3& p) {
  const Ellipsoid& body = part.bounds;
  const Vec3 local = body.rotation.conjugate() * (p - body.center);
  const double reach = 0.5 * part.grid.spacing;
  Vec3 slope;
  for (int a = 0; a < 3; ++a) {
    const Vec3 step = reach * Vec3::Unit(a);
    slope[a] = distanceAt(part.grid, local + step) - distanceAt(part.grid, local - step);
  }
  SurfacePoint out;
  out.distance = distanceAt(part.grid, local);
  // Where the slope vanishes all ways out are equally near: away from the middle.
  if (!(slope.squaredNorm() > 1e-12 * reach * reach)) slope = local.squaredNorm() > 0 ? local : Vec3(Vec3::UnitY());
  out.normal = body.rotation * slope.normalized();
  out.point = p - out.distance * out.normal;
  return out;
}

}  // namespace sim
