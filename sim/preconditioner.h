// Preconditioners of the Modified PCG, chosen by name at run time.
#pragma once

#include <span>
#include <vector>

#include "sim/block_matrix.h"
#include "sim/sim_params.h"

namespace sim {

// An approximate inverse of A, symmetric and positive definite.
template <class T>
struct Preconditioner {
  Solver kind = Solver::kBlockJacobi;
  std::vector<M3<T>> inverse_diagonal;  // per block row: scalar diagonals or 3x3 inverses

  // Refreshes from the current matrix.
  void update(const BlockMatrix<T>& a, Solver solver);
  // z = P r.
  void apply(std::span<const V3<T>> r, std::span<V3<T>> z);
};

// Inverse of a symmetric positive definite 3x3 block; a singular block gives the inverse of its diagonal.
template <class T>
M3<T> inverse(const M3<T>& a);

}  // namespace sim
