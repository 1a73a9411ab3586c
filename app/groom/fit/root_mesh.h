// Columns and root faces over the regions of a groom's roots.
#pragma once

#include <array>
#include <vector>

#include "app/groom/fit/root_raster.h"

namespace app {

struct RootMesh {
  std::vector<Eigen::Vector2f> at;            // per column, m on the map
  std::vector<std::array<int, 3>> triangles;  // columns, counter-clockwise seen from outside
  std::vector<int> region;                    // per triangle
};

// About `columns` columns, never more unless the regions need them: evenly along the rims of the regions and over
// them, neighbouring regions joined at the rim but where the raster is split. Deterministic.
RootMesh meshRoots(const RootRaster& raster, int columns);

// Delaunay triangulation of points in the plane (Bowyer 1981, Watson 1981): corners counter-clockwise.
std::vector<std::array<int, 3>> delaunay(const std::vector<Eigen::Vector2f>& points);

// The face of a region, or of all where that is negative or has none, that a point of the map lies in or is nearest to.
int faceAt(const RootMesh& mesh, int region, const Eigen::Vector2f& p);

}  // namespace app
