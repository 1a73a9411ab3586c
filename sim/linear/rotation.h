// Per-vertex rotations: how far the neighbourhood of each vertex has turned from the rest shape.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "sim/linear/block_matrix.h"
#include "sim/linear/column_layout.h"

namespace sim {

// The rotation closest to the neighbourhood's deformation: R maximizes tr(R^T sum (x_j - x_i)(X_j - X_i)^T) over the
// edges at vertex i (the polar factor of Kabsch's problem), found by the quaternion iteration of Mueller, Bender,
// Chentanez and Macklin, "A Robust Method to Extract the Rotational Part of Deformations" (2016), from the last
// rotation found. Degenerate neighbourhoods (collapsed, inverted) keep a valid rotation. In column layout: an edge adds
// the same product to both its ends, layer by layer along the vector lanes.
template <class T>
struct VertexRotations {
  std::vector<M3<T>> matrices;  // rest to current, orthonormal within rounding

  explicit VertexRotations(const HairMesh& mesh);
  void update(std::span<const V3<T>> x);

  // The edges between two columns layer by layer, or along one column (a its lower end): entries of the first layer's
  // ends, first entry in `rest`, and how many layers to walk, a multiple of kLanes.
  struct EdgeStrip {
    int a, b, rest, lanes;
  };
  ColumnLayout layout;
  std::vector<EdgeStrip> strips;
  std::array<std::vector<T>, 3> rest;         // m, X_b - X_a along the strips, zero where a layer has no edge
  ColumnField<T> x_packed;                    // m
  std::array<std::vector<T>, 9> sums;         // m^2, columns of the sum over edges, per entry
  std::vector<T> inverse_square;              // 1/m^2, of the longest rest edge at the entry
  std::array<std::vector<T>, 4> quaternions;  // x, y, z, w per entry
};

}  // namespace sim
