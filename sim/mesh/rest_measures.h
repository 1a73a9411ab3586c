// Rest quantities of a hair mesh from its rest positions, for those who build one and those who reshape it.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "sim/mesh/hair_mesh.h"

namespace sim {

inline constexpr double kShortestRestEdge = 1e-5;       // m; shorter ones ruin the conditioning of the solve
inline constexpr double kSmallestCornerVolume = 1e-15;  // m^3

// m^3, signed, of a corner tetrahedron.
inline double cornerVolume(const std::array<int, 4>& v, std::span<const Vec3> x) {
  const Vec3& x0 = x[v[0]];
  return (x[v[1]] - x0).dot((x[v[2]] - x0).cross(x[v[3]] - x0)) / 6;
}

// A corner tetrahedron of a parallelepiped is a sixth of it, of a straight triangular prism a third.
inline double prismVolume(double sum_of_corners, int corner_count) {
  return corner_count == 4 ? sum_of_corners * 6 / 8 : sum_of_corners / 2;
}

inline double dihedral(const Vec3& m1, const Vec3& p, const Vec3& q, const Vec3& m2) {
  const Vec3 n1 = (q - p).cross(m1 - p), n2 = (m2 - p).cross(q - p);
  return std::atan2(n1.cross(n2).dot((q - p).normalized()), n1.dot(n2));
}

// Angle and length of a hinge whose volume and vertices stand.
inline void measureHinge(std::span<const Vec3> x, Hinge& hinge) {
  const auto& v = hinge.v;
  const Vec3 below = (x[v[0]] + x[v[1]]) / 2, middle = (x[v[2]] + x[v[3]]) / 2, above = (x[v[4]] + x[v[5]]) / 2;
  hinge.rest_angle = dihedral(below, x[v[2]], x[v[3]], above);
  hinge.length = ((middle - below).norm() + (above - middle).norm()) / 2;
}

// m, the longest column's.
inline double hairLength(const HairMeshShape& shape) {
  double longest = 0;
  for (int c = 0; c < shape.columnCount(); ++c) {
    double length = 0;
    for (int v = shape.column_first[c] + 1; v < shape.column_first[c + 1]; ++v)
      length += (shape.positions[v] - shape.positions[v - 1]).norm();
    longest = std::max(longest, length);
  }
  return longest;
}

// Lengths of edges, volumes of edges and hinges, angles, hair length, of a mesh whose walls, edges and hinges stand in
// buildHairMesh's order and whose walls have their volumes. `vertical_volume`: m^3, of the vertical edge from each
// vertex to the next.
inline void measureEdgesAndHinges(std::span<const double> vertical_volume, HairMesh& mesh) {
  const std::span<const Vec3> x = mesh.shape.positions;
  for (Edge& edge : mesh.vertical_edges) {
    edge.rest_length = (x[edge.a] - x[edge.b]).norm();
    edge.volume = vertical_volume[edge.a];
  }
  // Walls lie root edge after root edge, layer after layer; a wall whose lower edge is not the upper one of the wall
  // before begins the next root edge.
  std::size_t hinge = 0;
  for (std::size_t w = 0; w < mesh.walls.size(); ++w) {
    const Wall& wall = mesh.walls[w];
    const int first = w + 1 < mesh.walls.size() ? mesh.walls[w + 1].v[0] : -1;
    const bool has_next = first == wall.v[3] || first == wall.v[2];
    Edge& edge = mesh.horizontal_edges[w];
    edge.rest_length = (x[edge.a] - x[edge.b]).norm();
    edge.volume = wall.volume / 2 + (has_next ? mesh.walls[w + 1].volume / 2 : 0);
    if (!has_next) continue;
    mesh.hinges[hinge].volume = (wall.volume + mesh.walls[w + 1].volume) / 2;
    measureHinge(x, mesh.hinges[hinge++]);
  }
  mesh.hair_length = hairLength(mesh.shape);
}

}  // namespace sim
