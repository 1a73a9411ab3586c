// Colliders: ellipsoids, and body SDFs. Inside test, closest point, normal, surface velocity.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <span>

#include "sim/mesh/fields.h"
#include "sim/mesh/hair_mesh.h"

namespace sim {

// A solid ellipsoid at its pose at the end of a step, with the rigid motion that brought it there.
struct Ellipsoid {
  Vec3 center = Vec3::Zero();                                    // m, world
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();  // local axes to world
  Vec3 radii = Vec3::Ones();                                     // m, along the local axes, all > 0
  Vec3 velocity = Vec3::Zero();                                  // m/s of the centre
  Vec3 angular_velocity = Vec3::Zero();                          // rad/s, world axes
  HAIRMESH_FIELDS(center, rotation, radii, velocity, angular_velocity)
};

struct SurfacePoint {
  Vec3 point;       // closest point of the surface, world
  Vec3 normal;      // outward unit normal there
  double distance;  // signed, m: negative inside
};

// Exact closest point (Eberly's one-dimensional root, bracketed Newton), not radial scaling. Any p, the centre
// included. Error: |distance| within 1e-12 m of the true one for radii between 1 mm and 10 m.
SurfacePoint closestPoint(const Ellipsoid& e, const Vec3& p);

// Velocity (m/s) of the ellipsoid's material at world point p.
Vec3 surfaceVelocity(const Ellipsoid& e, const Vec3& p);

// The place at the end of a step of dt seconds of a point fixed to the ellipsoid at its start.
Vec3 carriedAlong(const Ellipsoid& e, const Vec3& start, double dt);

// Signed distances (m, negative inside) at the nodes of a box, in its own frame; trilinear in between. Outside the box
// the distance to it is added.
struct DistanceGrid {
  Vec3 low = Vec3::Zero();          // m, the first node
  double spacing = 0;               // m
  std::array<int, 3> nodes{};       // at least 2 each; x runs fastest
  std::span<const float> values{};  // nodes[0] * nodes[1] * nodes[2]
  double deepest = 0;               // m, the least value, negated: about the body part's inner radius
};
double distanceAt(const DistanceGrid& grid, const Vec3& local);

// A rigid body part. `bounds`: an ellipsoid around it, whose frame is the grid's and whose motion is the part's.
struct BodySdf {
  Ellipsoid bounds;
  DistanceGrid grid;
};

// Distance from the grid, normal from its slope. Error: the grid's.
SurfacePoint closestPoint(const BodySdf& part, const Vec3& p);

// The colliders of a step by index: the body's, of one kind, then what is attached to it.
struct Colliders {
  std::span<const Ellipsoid> ellipsoids{};
  std::span<const BodySdf> parts{};  // in place of the ellipsoids where there are any
  long* counted = nullptr;           // where there is one: the closest points asked for (StepWork::surface_points)
  std::span<const BodySdf> attached{};

  int bodies() const { return static_cast<int>(parts.empty() ? ellipsoids.size() : parts.size()); }
  int count() const { return bodies() + static_cast<int>(attached.size()); }
  // Null: collider k is an ellipsoid.
  const BodySdf* sdf(int k) const {
    return k >= bodies() ? &attached[k - bodies()] : parts.empty() ? nullptr : &parts[k];
  }
  // Pose, motion and bounds of collider k.
  const Ellipsoid& body(int k) const { return sdf(k) ? sdf(k)->bounds : ellipsoids[k]; }
  SurfacePoint closest(int k, const Vec3& p) const {
    if (counted) ++*counted;
    return sdf(k) ? closestPoint(*sdf(k), p) : closestPoint(ellipsoids[k], p);
  }
  // m, from the middle of collider k to its surface.
  double thickness(int k) const { return sdf(k) ? sdf(k)->grid.deepest : ellipsoids[k].radii.minCoeff(); }
};

}  // namespace sim
