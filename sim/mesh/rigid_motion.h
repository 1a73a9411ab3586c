// Rotations and rigid motions nearest to what was found (Kabsch 1976).
#pragma once

#include <Eigen/Geometry>
#include <span>

#include "sim/mesh/hair_mesh.h"

namespace sim {

// The rotation nearest to a matrix that may scale, shear or mirror.
Eigen::Matrix3d nearestRotation(const Eigen::Matrix3d& matrix);

// The motion that brings the points of `from` nearest to those of `to` (m, least squares); the identity where a point
// is not finite. As many of one as of the other.
Eigen::Isometry3d rigidMotion(std::span<const Vec3> from, std::span<const Vec3> to);

// The same of the roots alone, between two places of a whole hair (m); to the bit the identity where they are the same.
Eigen::Isometry3d rootMotion(const HairMesh& mesh, std::span<const Vec3> from, std::span<const Vec3> to);

}  // namespace sim
