// Polygons as a modelling program's file has them: what strips, cards, tubes and scalps are read from.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace app {

// Face f has corners face_first[f] to face_first[f + 1] - 1, indices of positions; at least three, all different places
// of the arrays, though positions may repeat where a file has them twice.
struct PolygonMesh {
  std::vector<Eigen::Vector3d> positions;  // in the file's unit and axes, nodes' transforms applied
  std::vector<std::size_t> face_first{0};
  std::vector<int> corners;
  std::vector<int> face_object;                             // per face: index of `objects`
  std::vector<std::string> objects;                         // names of node, mesh and material, with blanks between
  std::vector<std::optional<std::array<float, 3>>> colors;  // per object: its material's, linear; none: it has none
  std::vector<std::array<float, 3>> vertex_colors;          // per position, as the file has them; empty: it has none
  std::optional<double> meters_per_unit;                    // as the file says
  std::string note;                                         // what it names and is not there; empty: nothing

  std::size_t faceCount() const { return face_first.size() - 1; }
  std::span<const int> face(std::size_t f) const {
    return std::span(corners).subspan(face_first[f], face_first[f + 1] - face_first[f]);
  }
};

}  // namespace app
