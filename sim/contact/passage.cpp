#include "sim/contact/passage.h"

#include <algorithm>

namespace sim {
namespace {

constexpr double kChord = 0.05;   // rad, that a collider turns while its way past a vertex counts as straight
constexpr double kGrazing = 0.1;  // of its thickness; a path no deeper slides over a rounded body
constexpr int kLooks = 32;        // at signed distances, along a chord

// The share of the way from `from` (m, local axes) at which it is first inside an ellipsoid of these inverse radii, the
// lesser root of a quadratic; more than 1 where it never is.
double firstInside(const Vec3& from, const Vec3& way, const Vec3& inverse_radii) {
  const Vec3 p = from.cwiseProduct(inverse_radii), d = way.cwiseProduct(inverse_radii);
  const double c = p.squaredNorm() - 1;
  if (c <= 0) return 0;
  const double b = p.dot(d), discriminant = b * b - d.squaredNorm() * c;
  if (b >= 0 || discriminant < 0) return INFINITY;
  return c / (std::sqrt(discriminant) - b);
}

// Where the vertex's way first meets the collider's offset surface from outside and goes on to below what may be
// grazed (m, local axes). The offset surface of an ellipsoid is taken for the ellipsoid with radii longer by the
// offset, which lies inside it by less than the offset.
std::optional<Vec3> enterEllipsoid(const NearCollider& near, const Vec3& start, const Vec3& end) {
  std::optional<Vec3> entry;
  Vec3 from = near.onPath(start, end, 0);
  if (from.cwiseProduct(near.outer).squaredNorm() <= 1) return {};  // began inside
  for (int i = 1; i <= near.chords; ++i) {
    const Vec3 to = near.onPath(start, end, i), way = to - from;
    const double met = firstInside(from, way, near.outer);
    if (!entry && met <= 1) entry = from + met * way;
    if (entry && firstInside(from, way, near.inner) <= 1) return entry;
    if (to.cwiseProduct(near.outer).squaredNorm() > 1) entry.reset();
    from = to;
  }
  return {};
}

// The same for signed distances, by conservative advancement: a look goes on by the gap, at least the chord's share.
std::optional<Vec3> enterGrid(const DistanceGrid& grid, const NearCollider& near, double offset, const Vec3& start,
                              const Vec3& end) {
  std::optional<Vec3> entry;
  Vec3 from = near.onPath(start, end, 0);
  double before = distanceAt(grid, from) - offset;
  if (before <= 0) return {};  // began inside
  for (int i = 1; i <= near.chords; ++i) {
    const Vec3 to = near.onPath(start, end, i), way = to - from;
    const double length = way.norm(), least = length / kLooks;
    for (double at = 0; at < length;) {
      const double last = at;
      at = std::min(length, at + std::max(before, least));
      const double gap = distanceAt(grid, from + (at / length) * way) - offset;
      if (!entry && gap <= 0) entry = from + ((last + (at - last) * before / (before - gap)) / length) * way;
      if (gap <= -kGrazing * near.thin) return entry;
      if (gap > 0) entry.reset();
      before = gap;
    }
    from = to;
  }
  return {};
}

}  // namespace

NearCollider::NearCollider(int k, const Ellipsoid& body, double thickness, double offset, double dt)
    : index(k),
      before(body.center - dt * body.velocity),
      after(body.center),
      turn(Eigen::Matrix3d::Identity()),
      turned(body.angular_velocity.norm() * dt),
      reach(body.radii.maxCoeff() + offset),
      thin(thickness),
      outer((body.radii.array() + offset).inverse()),
      inner((body.radii.array() + (offset - kGrazing * thickness)).inverse()),
      // Its radii are longer by the offset times the aspect ratio, so its surface is nowhere nearer than the offset.
      around((body.radii.array() + offset * body.radii.maxCoeff() / body.radii.minCoeff()).inverse()) {
  const Eigen::Matrix3d local = body.rotation.conjugate().toRotationMatrix();
  const Vec3 axis = turned > 1e-12 ? Vec3(body.angular_velocity.normalized()) : Vec3(Vec3::UnitX());
  chords = std::clamp(static_cast<int>(std::ceil(turned / kChord)), 1, kMaxChords);
  for (int i = 0; i < chords; ++i) {
    const double left = turned * (chords - i) / chords;
    local_turn[i] = turned > 1e-12 ? Eigen::Matrix3d(local * Eigen::AngleAxisd(left, axis)) : local;
  }
  local_turn[chords] = local;
  if (turned > 1e-12) turn = Eigen::AngleAxisd(turned, axis).toRotationMatrix();
}

std::optional<Vec3> entryOf(const Colliders& colliders, const NearCollider& near, double offset, const Vec3& start,
                            const Vec3& end) {
  const BodySdf* sdf = colliders.sdf(near.index);
  return sdf ? enterGrid(sdf->grid, near, offset, start, end) : enterEllipsoid(near, start, end);
}

}  // namespace sim
