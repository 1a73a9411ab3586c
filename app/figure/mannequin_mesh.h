// Polygons from an implicit function: surface nets on a grid whose cells grow away from the head.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "app/figure/character.h"

namespace app {

// Rows of cells from bottom to top; a cell's edge is `fine` (m) above `fine_from` (y, m) and grows smoothly to `coarse`
// at `coarse_from` and below.
struct MeshGrid {
  double fine = 0.0038, coarse = 0.0115, fine_from = 1.4, coarse_from = 1.0;
  struct Ball {
    Vec3 center;
    double radius;
  };
  std::vector<Ball> holds;  // m: the surface lies within their union's convex hull, row by row; at least one
  double center_z = 0;      // m: the grid is symmetric about x = 0 and this
};

struct Surface {
  std::vector<Vec3> positions, normals;
  std::vector<std::uint32_t> triangles;  // counter-clockwise from outside
};

// A closed two-manifold: every edge is shared by exactly two triangles, whatever the function. Vertices lie on the zero
// set (within a few hundredths of a millimetre where the function is smooth); normals are its gradient.
Surface meshSurface(const std::function<double(const Vec3&)>& field, const MeshGrid& grid);

// Moves p to the zero set nearby, in two steps of at most `limit` (m); `normal`: the gradient there, of length 1.
void projectToSurface(const std::function<double(const Vec3&)>& field, double limit, Vec3& p, Vec3& normal);

}  // namespace app
