#include "app/scene/painted_fields.h"

#include <algorithm>

namespace app {

using sim::Vec3;

namespace {

double atRoot(const FieldMap& map, const Scalp& scalp, const sim::HairMeshShape& shape, int column) {
  return map.at(shape.positions[static_cast<std::size_t>(shape.column_first[static_cast<std::size_t>(column)])] -
                scalp.center);
}

// The column's points at the same shares of its first `share` of the way.
void shorten(std::span<Vec3> x, double share) {
  const std::vector<Vec3> old(x.begin(), x.end());
  std::vector<double> passed{0};
  for (std::size_t k = 1; k < old.size(); ++k) passed.push_back(passed.back() + (old[k] - old[k - 1]).norm());
  std::size_t segment = 1;
  for (std::size_t k = 1; k < old.size(); ++k) {
    const double place = share * passed[k];
    while (segment + 1 < old.size() && passed[segment] < place) ++segment;
    const double within = (place - passed[segment - 1]) / (passed[segment] - passed[segment - 1]);
    x[k] = old[segment - 1] + within * (old[segment] - old[segment - 1]);
  }
}

}  // namespace

void paintLength(const FieldMap& map, const Scalp& scalp, sim::HairMeshShape& shape) {
  for (int c = 0; c < shape.columnCount(); ++c) {
    const double share = kLeastLength + (1 - kLeastLength) * atRoot(map, scalp, shape, c);
    if (share >= 1) continue;
    shorten(std::span(shape.positions).subspan(static_cast<std::size_t>(shape.column_first[static_cast<std::size_t>(c)]),
                                               static_cast<std::size_t>(shape.columnLength(c))),
            share);
  }
}

std::vector<float> paintedStiffness(const FieldMap& map, const Scalp& scalp, const sim::HairMeshShape& shape) {
  std::vector<float> shares;
  for (int c = 0; c < shape.columnCount(); ++c)
    shares.push_back(static_cast<float>(kLeastStiffness + (1 - kLeastStiffness) * atRoot(map, scalp, shape, c)));
  return shares;
}

void applyStiffness(std::span<const float> shares, sim::HairMesh& mesh) {
  if (shares.empty()) return;
  const auto scale = [&](const auto& vertices, double& volume) {
    double sum = 0;
    for (const int v : vertices) sum += shares[static_cast<std::size_t>(mesh.column_of[static_cast<std::size_t>(v)])];
    volume *= sum / static_cast<double>(std::size(vertices));
  };
  for (auto* edges : {&mesh.horizontal_edges, &mesh.vertical_edges}) {
    for (sim::Edge& edge : *edges) scale(std::array{edge.a, edge.b}, edge.volume);
  }
  for (sim::Wall& wall : mesh.walls) scale(wall.v, wall.volume);
  for (sim::Hinge& hinge : mesh.hinges) scale(hinge.v, hinge.volume);
  for (sim::CornerTet& tet : mesh.tets) scale(tet.v, tet.volume);
}

void paintDensity(const FieldMap& map, const Scalp& scalp, const sim::HairMesh& mesh,
                  std::vector<render::HairFace>& faces) {
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const sim::RootFace& face = mesh.shape.root_faces[f];
    double sum = 0;
    for (int k = 0; k < face.corner_count; ++k)
      sum += atRoot(map, scalp, mesh.shape, face.columns[static_cast<std::size_t>(k)]);
    faces[f].area *= static_cast<float>(sum / face.corner_count);
  }
}

}  // namespace app
