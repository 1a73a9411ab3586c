// Collision ellipsoids: inside test, closest point, normal, surface velocity.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "sim/hair_mesh.h"

namespace sim {

// A solid ellipsoid at its pose at the end of a step, with the rigid motion that brought it there.
struct Ellipsoid {
  Vec3 center = Vec3::Zero();                                    // m, world
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();  // local axes to world
  Vec3 radii = Vec3::Ones();                                     // m, along the local axes, all > 0
  Vec3 velocity = Vec3::Zero();                                  // m/s of the centre
  Vec3 angular_velocity = Vec3::Zero();                          // rad/s, world axes
};

// Where a point stands against an ellipsoid.
struct SurfacePoint {
  Vec3 point;       // closest point of the surface, world
  Vec3 normal;      // outward unit normal there
  double distance;  // signed, m: negative inside
};

// (p/r)^2 - 1 in the local frame: negative inside. Cheap; not a distance.
double implicitValue(const Ellipsoid& e, const Vec3& p);

// Exact closest point (Eberly's one-dimensional root, bracketed Newton), not radial scaling. Any p, the centre
// included. Error: |distance| within 1e-12 m of the true one for radii between 1 mm and 10 m.
SurfacePoint closestPoint(const Ellipsoid& e, const Vec3& p);

// Velocity (m/s) of the ellipsoid's material at world point p.
Vec3 surfaceVelocity(const Ellipsoid& e, const Vec3& p);

}  // namespace sim
