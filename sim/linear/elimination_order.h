// Fill-reducing elimination order for sparse Cholesky factors.
#pragma once

#include <span>
#include <vector>

#include "sim/linear/block_matrix.h"

namespace sim {

// Approximate minimum degree (Amestoy, Davis, Duff 1996; Eigen's implementation) of the rows with keep[i] != 0.
std::vector<int> minimumDegreeOrder(const BlockPattern& pattern, std::span<const unsigned char> keep);

}  // namespace sim
