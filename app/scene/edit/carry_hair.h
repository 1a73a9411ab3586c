// Hair goes along with an edit of its rest shape.
#pragma once

#include <span>
#include <vector>

#include "sim/mesh/hair_mesh.h"

namespace app {

using Vec3 = Eigen::Vector3d;
struct Actor;

// m, from the root to each vertex of a column.
std::vector<double> wayAlong(std::span<const Vec3> column);

std::span<const Vec3> columnOf(std::span<const Vec3> positions, const sim::HairMeshShape& shape, int column);

// Hair shows a change of its shape at once, and none of it is left behind to swing or turn inside out: each vertex is
// as far off its place at rest as hair was, at its way from the root, off the shape `before` (m, head frame).
void carryWithShape(std::span<const Vec3> before, Actor& actor);

}  // namespace app
