#include "sim/mesh/rest_shape.h"

#include <algorithm>
#include <map>
#include <utility>

#include "sim/mesh/rest_measures.h"

namespace sim {

RestShape::RestShape(const HairMesh& mesh) {
  // A wall is known by its lower edge.
  std::map<std::pair<int, int>, int> walls;
  for (std::size_t w = 0; w < mesh.walls.size(); ++w) {
    const int a = mesh.walls[w].v[0], b = mesh.walls[w].v[1];
    walls[{std::min(a, b), std::max(a, b)}] = static_cast<int>(w);
  }
  wall_of_.assign(4 * mesh.prisms.size(), -1);
  for (std::size_t p = 0; p < mesh.prisms.size(); ++p) {
    const Prism& prism = mesh.prisms[p];
    for (int k = 0; k < prism.corner_count; ++k) {
      const int a = prism.v[k], b = prism.v[(k + 1) % prism.corner_count];
      wall_of_[4 * p + k] = walls.at({std::min(a, b), std::max(a, b)});
    }
  }
  tet_volume_.resize(mesh.tets.size());
  vertical_volume_.resize(mesh.vertexCount());
}

namespace {

bool longEnough(std::span<const Vec3> x, std::span<const Edge> edges) {
  return std::ranges::all_of(
      edges, [&](const Edge& edge) { return (x[edge.a] - x[edge.b]).norm() >= kShortestRestEdge; });
}

}  // namespace

bool RestShape::set(std::span<const Vec3> x, HairMesh& mesh) {
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    tet_volume_[t] = cornerVolume(mesh.tets[t].v, x);
    if (!(tet_volume_[t] > kSmallestCornerVolume)) return false;
  }
  if (!std::ranges::all_of(x, [](const Vec3& p) { return p.allFinite(); })) return false;
  if (!longEnough(x, mesh.vertical_edges) || !longEnough(x, mesh.horizontal_edges)) return false;

  mesh.shape.positions.assign(x.begin(), x.end());
  std::fill(mesh.vertex_volume.begin(), mesh.vertex_volume.end(), 0.0);
  std::fill(vertical_volume_.begin(), vertical_volume_.end(), 0.0);
  for (Wall& wall : mesh.walls) wall.volume = 0;
  mesh.total_volume = 0;
  std::size_t t = 0;
  for (std::size_t p = 0; p < mesh.prisms.size(); ++p) {
    Prism& prism = mesh.prisms[p];
    const int n = prism.corner_count;
    double sum = 0;
    for (int k = 0; k < 2 * n; ++k) sum += tet_volume_[t + k];
    prism.volume = prismVolume(sum, n);
    for (int k = 0; k < 2 * n; ++k, ++t) {
      mesh.tets[t].rest_volume = tet_volume_[t];
      mesh.tets[t].volume = prism.volume / (2 * n);
      mesh.vertex_volume[prism.v[k]] += prism.volume / (2 * n);
    }
    mesh.total_volume += prism.volume;
    for (int k = 0; k < n; ++k) {
      mesh.walls[wall_of_[4 * p + k]].volume += prism.volume / n;
      vertical_volume_[prism.v[k]] += prism.volume / n;
    }
  }
  measureEdgesAndHinges(vertical_volume_, mesh);
  return true;
}

}  // namespace sim
