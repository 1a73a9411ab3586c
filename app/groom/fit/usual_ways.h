// The way that columns of a hair mesh go where their strands tell too little of it.
#pragma once

#include <span>
#include <vector>

#include "app/groom/fit/root_mesh.h"
#include "app/groom/fit/root_raster.h"
#include "sim/mesh/hair_mesh.h"

namespace app {

// Of a column's usual way, beside its strands; see ColumnHold.
inline constexpr double kUsualWeight = 0.03;

// m, one a vertex: where it would be if its column went as the strands of the nearest cell of its region do. knots: per
// layer its share of the length, 0 to 1.
std::vector<sim::Vec3> usualWays(const RootRaster& raster, const RootMesh& roots, std::span<const double> knots,
                                 const sim::HairMeshShape& shape);

// Columns that strands of several ways have drawn far from the usual one get the weight of their strands for it.
void holdAstray(const sim::HairMeshShape& shape, const std::vector<sim::Vec3>& toward, std::vector<double>& weights);

}  // namespace app
