// Fill-reducing elimination order for sparse Cholesky factors. Apart, for kernels are compiled without Eigen.
#pragma once

#include <vector>

#include "sim/linear/block_matrix.h"

namespace sim {

// Approximate minimum degree (Amestoy, Davis, Duff 1996; Eigen's implementation).
std::vector<int> minimumDegreeOrder(const BlockPattern& pattern);

}  // namespace sim
