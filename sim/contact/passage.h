// Continuous collision: where the way of a vertex over a step goes into a collider that moves and turns.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <optional>

#include "sim/contact/colliders.h"

namespace sim {

// A collider within reach of the hair, with its rigid motion over the step.
struct NearCollider {
  static constexpr int kMaxChords = 8;

  int index;
  Vec3 before, after;    // m, its centre
  Eigen::Matrix3d turn;  // its rotation over the step
  double turned;         // rad, angle of that
  double reach, thin;    // m, bound of the distance from centre to contact; thickness
  // A vertex's way over the step, in the collider's frame, is tested as so many chords. local_turn[i]: from world
  // directions at the share i / chords of the step to the collider's axes.
  int chords = 1;
  std::array<Eigen::Matrix3d, kMaxChords + 1> local_turn;
  Vec3 outer, inner;  // 1/m, inverse radii: of the ellipsoid grown to the contact offset, and less what may be grazed
  Vec3 around;        // 1/m, inverse radii of an ellipsoid that holds all points nearer than the contact offset
  // m. A vertex that moves by s within the step meets it only from within margin + s of its centre at the end.
  double margin = INFINITY;

  NearCollider(int index, const Ellipsoid& body, double thickness, double offset, double dt);

  // From world directions to its axes at the step's end.
  Vec3 local(const Vec3& direction) const { return local_turn[chords] * direction; }
  // False only if p (m, world) lies farther than the contact offset and `more` (m) off the surface at the step's end.
  bool mayTouch(const Vec3& p, double more = 0) const {
    const Vec3 d = p - after;
    if (d.squaredNorm() >= (reach + more) * (reach + more)) return false;
    const double longer = 1 + more * around.maxCoeff();
    return local(d).cwiseProduct(around).squaredNorm() < longer * longer;
  }
  // The place at the step's end of a point fixed to it at the start.
  Vec3 carried(const Vec3& start) const { return after + turn * (start - before); }
  // In the collider's axes (m): the end of chord i of the way from start to end (m, world).
  Vec3 onPath(const Vec3& start, const Vec3& end, int i) const {
    const double t = static_cast<double>(i) / chords;
    return local_turn[i] * (start - before + t * (end - after - start + before));
  }
};

// Where the vertex's way from start to end (m, world) first meets the collider's offset surface from outside and goes
// on to below what may be grazed: m, in the collider's axes. None where it began inside. By one quadratic equation a
// chord, or at most 32 looks at signed distances.
std::optional<Vec3> entryOf(const Colliders& colliders, const NearCollider& near, double offset, const Vec3& start,
                            const Vec3& end);

}  // namespace sim
