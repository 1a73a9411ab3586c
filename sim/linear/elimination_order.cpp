// Apart from layer_factor.cpp, for kernels are compiled without Eigen.
#include <Eigen/OrderingMethods>
#include <Eigen/Sparse>

#include "sim/linear/layer_factor.h"

namespace sim {

std::vector<int> minimumDegreeOrder(const BlockPattern& pattern) {
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < pattern.size; ++i) {
    entries.emplace_back(i, i, 1.0);
    for (int k = pattern.row_first[i]; k < pattern.row_first[i + 1]; ++k) {
      entries.emplace_back(i, pattern.columns[k], 1.0);
      entries.emplace_back(pattern.columns[k], i, 1.0);
    }
  }
  Eigen::SparseMatrix<double> matrix(pattern.size, pattern.size);
  matrix.setFromTriplets(entries.begin(), entries.end());
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> permutation;
  Eigen::AMDOrdering<int>()(matrix, permutation);
  return {permutation.indices().begin(), permutation.indices().end()};
}

}  // namespace sim
