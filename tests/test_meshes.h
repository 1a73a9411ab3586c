// Small hair meshes for tests: a patch of roots with straight columns.
#pragma once

#include "sim/hair_mesh.h"

namespace test {

// A patch of nx x nz root faces, `spacing` apart in x and z, whose columns of `layers` vertices run along `direction` (up or
// down) over `length` metres. With `mixed`, every third face is split into two triangles; with `uneven`, the columns of the
// first row end one layer early.
struct PatchOptions {
  int nx = 2, nz = 2, layers = 5;
  double spacing = 0.02, length = 0.2;
  sim::Vec3 direction{0, -1, 0};
  bool mixed = false, uneven = false;
};

inline sim::HairMeshShape patchShape(const PatchOptions& o) {
  sim::HairMeshShape shape;
  const auto column = [&](int i, int k) { return k * (o.nx + 1) + i; };
  for (int k = 0; k <= o.nz; ++k) {
    for (int i = 0; i <= o.nx; ++i) {
      const int count = o.uneven && k == 0 ? o.layers - 1 : o.layers;
      for (int l = 0; l < count; ++l) {
        shape.positions.push_back(sim::Vec3(i * o.spacing, 0, k * o.spacing) + o.direction * (o.length * l / (o.layers - 1)));
      }
      shape.column_first.push_back(static_cast<int>(shape.positions.size()));
    }
  }
  for (int k = 0; k < o.nz; ++k) {
    for (int i = 0; i < o.nx; ++i) {
      // Counter-clockwise seen from the side that the columns grow to.
      std::array<int, 4> c{column(i, k), column(i, k + 1), column(i + 1, k + 1), column(i + 1, k)};
      if (o.direction.y() < 0) std::swap(c[1], c[3]);
      if (o.mixed && (i + k) % 3 == 0) {
        shape.root_faces.push_back({3, {c[0], c[1], c[2], -1}});
        shape.root_faces.push_back({3, {c[0], c[2], c[3], -1}});
      } else {
        shape.root_faces.push_back({4, c});
      }
    }
  }
  return shape;
}

inline std::vector<sim::Vec3> rootsOf(const sim::HairMesh& mesh, const std::vector<sim::Vec3>& positions) {
  std::vector<sim::Vec3> roots;
  for (int c = 0; c < mesh.columnCount(); ++c) roots.push_back(positions[mesh.shape.column_first[c]]);
  return roots;
}

}  // namespace test
