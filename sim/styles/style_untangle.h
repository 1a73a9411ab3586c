// Fattens the prisms of a style that the curvature of a head has flattened or turned inside out.
#pragma once

#include "sim/styles/hair_styles.h"

namespace sim {

// How fat a corner tetrahedron is: its volume over that of a box corner with the same three edges; 1 is square, 0 flat,
// negative inside out.
double cornerFatness(const Vec3& corner, const Vec3& next, const Vec3& previous, const Vec3& along);

// Moves all but the roots, as little as it can, until every corner tetrahedron is at least `fatness` fat, and keeps
// `gap` (m) off the body. Deterministic; gives up after a fixed number of sweeps and returns what it reached: the
// smallest fatness of all.
double untangle(const BodyDistance& body, double fatness, double gap, HairMeshShape& shape);

}  // namespace sim
