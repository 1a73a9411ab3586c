#include "app/groom/fit/usual_ways.h"

#include <algorithm>
#include <limits>

namespace app {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3f;

constexpr double kHeldWeight = 1;
constexpr double kLongEnough = 0.7;      // of a column's length: strands that tell of its way
constexpr double kAstray = 0.25;         // of the usual way's length, off which a column is astray
constexpr float kShortestWay = 0.0035f;  // m, of a column: an edge (column_fit.cpp)

// Of every column the region of one of its faces.
std::vector<int> regionsOfColumns(const RootMesh& roots) {
  std::vector<int> region(roots.at.size(), -1);
  for (std::size_t t = 0; t < roots.triangles.size(); ++t)
    for (const int column : roots.triangles[t]) region[static_cast<std::size_t>(column)] = roots.region[t];
  return region;
}

// The nearest cell of a region whose strands are about that long (m): short fine hair of a hairline tells nothing of
// the way that long hair goes.
const RootCell* usualCell(const RootRaster& raster, int region, const Vector2f& at, double length) {
  const RootCell* best = nullptr;
  float least = std::numeric_limits<float>::infinity();
  for (std::size_t c = 0; c < raster.cells.size(); ++c) {
    const RootCell& cell = raster.cells[c];
    if (cell.region != region || cell.path.empty() || cell.path_strands < kLongEnough * length) continue;
    const auto columns = static_cast<std::size_t>(raster.columns);
    const Vector2f middle = raster.origin + raster.size * Vector2f(static_cast<float>(c % columns) + 0.5f,
                                                                   static_cast<float>(c / columns) + 0.5f);
    if ((middle - at).squaredNorm() >= least) continue;
    least = (middle - at).squaredNorm();
    best = &cell;
  }
  return best;
}

}  // namespace

std::vector<sim::Vec3> usualWays(const RootRaster& raster, const RootMesh& roots, std::span<const double> knots,
                                 const sim::HairMeshShape& shape) {
  const std::vector<int> region = regionsOfColumns(roots);
  std::vector<sim::Vec3> all;
  for (std::size_t c = 0; c < region.size(); ++c) {
    const sim::Vec3 root = shape.positions[static_cast<std::size_t>(shape.column_first[c])];
    const double length = std::max(raster.lengthAt(roots.at[c]), kShortestWay);
    const RootCell* cell = usualCell(raster, region[c], roots.at[c], length);
    std::vector<double> passed{0};
    for (std::size_t k = 1; cell && k < cell->path.size(); ++k)
      passed.push_back(passed.back() + (cell->path[k] - cell->path[k - 1]).norm());
    // Of a strand's length curls take a part that the path does not have.
    const double straight = cell ? passed.back() / cell->path_strands : 0;
    for (const double knot : knots) {
      if (!cell || passed.back() <= 0) {
        all.push_back(root);
        continue;
      }
      const double wanted = knot * length * straight;
      std::size_t k = 1;
      while (k + 1 < passed.size() && passed[k] < wanted) ++k;
      const double share = (wanted - passed[k - 1]) / std::max(passed[k] - passed[k - 1], 1e-9);
      const Vector3f at = cell->path[k - 1] + static_cast<float>(share) * (cell->path[k] - cell->path[k - 1]);
      all.push_back(root + (at - cell->path[0]).cast<double>());
    }
  }
  return all;
}

void holdAstray(const sim::HairMeshShape& shape, const std::vector<sim::Vec3>& toward, std::vector<double>& weights) {
  for (std::size_t c = 0; c < weights.size(); ++c) {
    double most = 0, length = 0;
    for (int v = shape.column_first[c] + 1; v < shape.column_first[c + 1]; ++v) {
      const auto at = static_cast<std::size_t>(v);
      most = std::max(most, (shape.positions[at] - toward[at]).norm());
      length += (toward[at] - toward[at - 1]).norm();
    }
    if (most > kAstray * length) weights[c] = kHeldWeight;
  }
}

}  // namespace app
