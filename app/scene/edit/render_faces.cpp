#include "app/scene/edit/render_faces.h"

#include <Eigen/Geometry>

namespace app {

std::vector<render::HairFace> renderFaces(const sim::HairMesh& mesh) {
  std::vector<render::HairFace> faces;
  faces.reserve(mesh.shape.root_faces.size());
  for (std::size_t f = 0; f < mesh.shape.root_faces.size(); ++f) {
    const sim::RootFace& root = mesh.shape.root_faces[f];
    render::HairFace face;
    face.layers = mesh.bundle_layers[f];
    for (int c = 0; c < root.corner_count; ++c) face.first_vertex[c] = mesh.shape.column_first[root.columns[c]];
    const auto corner = [&](int c) -> const sim::Vec3& { return mesh.shape.positions[face.first_vertex[c]]; };
    double area = 0.5 * (corner(1) - corner(0)).cross(corner(2) - corner(0)).norm();
    if (root.corner_count == 4) area += 0.5 * (corner(2) - corner(0)).cross(corner(3) - corner(0)).norm();
    face.area = static_cast<float>(area);
    faces.push_back(face);
  }
  return faces;
}

}  // namespace app
