// Fill-reducing elimination orders for the sparse Cholesky factor.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "sim/linear/block_matrix.h"
#include "sim/mesh/hair_mesh.h"

namespace sim {

// Approximate minimum degree (Amestoy, Davis, Duff 1996; Eigen's implementation) of the rows with keep[i] != 0.
std::vector<int> minimumDegreeOrder(const BlockPattern& pattern, std::span<const unsigned char> keep);

// Geometric nested dissection (George 1973): halves the rows across the coordinate (position of the root, layer) that
// leaves the smallest separator, recursively; separators are eliminated last. `coordinates`: per row, in any units.
std::vector<int> nestedDissectionOrder(const BlockPattern& pattern, std::span<const unsigned char> keep,
                                       std::span<const std::array<double, 4>> coordinates);

// The coordinates of a hair mesh's vertices: root position (m) and layer.
std::vector<std::array<double, 4>> dissectionCoordinates(const HairMesh& mesh);

}  // namespace sim
