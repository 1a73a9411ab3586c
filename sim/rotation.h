// Per-vertex rotations: how far the neighbourhood of each vertex has turned from the rest shape.
#pragma once

#include <span>
#include <vector>

#include "sim/block_matrix.h"
#include "sim/hair_mesh.h"

namespace sim {

// The rotation closest to the neighbourhood's deformation: R maximizes tr(R^T sum (x_j - x_i)(X_j - X_i)^T) over the
// edges at vertex i (the polar factor of Kabsch's problem), found by the quaternion iteration of Mueller, Bender,
// Chentanez and Macklin, "A Robust Method to Extract the Rotational Part of Deformations" (2016), from the last
// rotation found. Degenerate neighbourhoods (collapsed, inverted) keep a valid rotation.
template <class T>
struct VertexRotations {
  std::vector<int> row_first{0}, neighbours;
  std::vector<V3<T>> rest_edge;  // X_j - X_i over the squared length of vertex i's longest edge, per neighbour
  std::vector<std::array<T, 4>> quaternions;  // x, y, z, w
  std::vector<M3<T>> matrices;                // rest to current, orthonormal within rounding

  explicit VertexRotations(const HairMesh& mesh);
  void update(std::span<const V3<T>> x);
};

}  // namespace sim
