#include "app/styles/style_refine.h"

#include <algorithm>
#include <map>

namespace app {
namespace {

struct FineColumn {
  int a, b;        // coarse columns that it lies half-way between; the same twice for a coarse one
  int layers = 0;  // coarse ones
};

// A column's curve half-way between its layers l and l + 1: the cubic through the four nearest where there are four,
// the parabola through three at its ends.
Vec3 halfWay(const sim::HairMeshShape& shape, int column, int l) {
  const Vec3* x = &shape.positions[shape.column_first[column]];
  const bool first = l < 1, last = l + 2 >= shape.columnLength(column);
  if (first && last) return 0.5 * (x[l] + x[l + 1]);
  if (first) return (3 * x[l] + 6 * x[l + 1] - x[l + 2]) / 8;
  if (last) return (3 * x[l + 1] + 6 * x[l] - x[l - 1]) / 8;
  return (9 * (x[l] + x[l + 1]) - x[l - 1] - x[l + 2]) / 16;
}

Vec3 onScalp(const Scalp& scalp, const Vec3& p) {
  const Vec3 direction = (p - scalp.center).normalized();
  return scalp.center + scalp.radiusAt(direction) * direction;
}

bool acrossSheets(int a, int b) {
  return std::abs(a - b) != 1;
}

}  // namespace

sim::HairMeshShape refined(const Woven& coarse, const Scalp& scalp) {
  const sim::HairMeshShape& shape = coarse.shape;
  std::vector<FineColumn> columns;
  for (int c = 0; c < shape.columnCount(); ++c) columns.push_back({c, c, 0});
  std::map<std::pair<int, int>, int> between;
  const auto middle = [&](int a, int b) {
    const auto [place, fresh] = between.try_emplace(std::minmax(a, b), static_cast<int>(columns.size()));
    if (fresh) columns.push_back({std::min(a, b), std::max(a, b), 0});
    return place->second;
  };
  sim::HairMeshShape fine;
  const auto addFace = [&](std::vector<int> corners, int layers) {
    sim::RootFace face;
    face.corner_count = static_cast<int>(corners.size());
    std::copy(corners.begin(), corners.end(), face.columns.begin());
    for (const int c : corners) columns[c].layers = std::max(columns[c].layers, layers);
    fine.root_faces.push_back(face);
  };
  for (const sim::RootFace& face : shape.root_faces) {
    const int n = face.corner_count;
    const int layers = shape.bundleLayers(face);
    // Turned so that the first edge runs across the sheets and the last one within a sheet.
    int turn = 0;
    const auto corner = [&](int k) { return face.columns[(k + turn) % n]; };
    while (!(acrossSheets(corner(0), corner(1)) && !acrossSheets(corner(n - 1), corner(0)))) ++turn;
    const int near = middle(corner(0), corner(1)), far = middle(corner(n - 2), corner(n - 1));
    addFace({corner(0), near, far, corner(n - 1)}, layers);
    addFace(n == 4 ? std::vector{near, corner(1), corner(2), far} : std::vector{near, corner(1), far}, layers);
  }
  for (const FineColumn& column : columns) {
    double raised = 0;  // m: a chord between two columns runs below the scalp's curve, and so it does above the scalp
    for (int l = 0; l < 2 * column.layers - 1; ++l) {
      const auto at = [&](int c) {
        return l % 2 ? halfWay(shape, c, l / 2) : shape.positions[shape.column_first[c] + l / 2];
      };
      const auto upAt = [&](int c) -> Vec3 {
        const Vec3* up = &coarse.up[shape.column_first[c] + l / 2];
        return l % 2 ? Vec3(up[0] + up[1]) : Vec3(2 * up[0]);
      };
      const Vec3 p = 0.5 * (at(column.a) + at(column.b)), up = (upAt(column.a) + upAt(column.b)).normalized();
      if (l == 0 && column.a != column.b) raised = (onScalp(scalp, p) - p).norm();
      const double share = 1 - l / (2.0 * column.layers);
      fine.positions.push_back(l == 0 && column.a != column.b ? onScalp(scalp, p) : Vec3(p + share * raised * up));
    }
    fine.column_first.push_back(static_cast<int>(fine.positions.size()));
  }
  return fine;
}

}  // namespace app
