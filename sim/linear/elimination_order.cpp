#include "sim/linear/elimination_order.h"

#include <Eigen/OrderingMethods>
#include <Eigen/Sparse>

namespace sim {
namespace {

// The pattern as an undirected graph of the kept rows.
struct Graph {
  std::vector<std::vector<int>> neighbours;
  Graph(const BlockPattern& pattern, std::span<const unsigned char> keep) : neighbours(pattern.size) {
    for (int i = 0; i < pattern.size; ++i) {
      for (int k = pattern.row_first[i]; keep[i] && k < pattern.row_first[i + 1]; ++k) {
        const int j = pattern.columns[k];
        if (!keep[j]) continue;
        neighbours[i].push_back(j);
        neighbours[j].push_back(i);
      }
    }
  }
};

}  // namespace

std::vector<int> minimumDegreeOrder(const BlockPattern& pattern, std::span<const unsigned char> keep) {
  std::vector<int> number(pattern.size, -1), kept;
  for (int i = 0; i < pattern.size; ++i) {
    if (!keep[i]) continue;
    number[i] = static_cast<int>(kept.size());
    kept.push_back(i);
  }
  const int n = static_cast<int>(kept.size());
  std::vector<Eigen::Triplet<double>> entries;
  const Graph graph(pattern, keep);
  for (int i : kept) {
    entries.emplace_back(number[i], number[i], 1.0);
    for (int j : graph.neighbours[i]) entries.emplace_back(number[i], number[j], 1.0);
  }
  Eigen::SparseMatrix<double> matrix(n, n);
  matrix.setFromTriplets(entries.begin(), entries.end());
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> permutation;
  Eigen::AMDOrdering<int>()(matrix, permutation);
  std::vector<int> order(n);
  for (int k = 0; k < n; ++k) order[k] = kept[permutation.indices()[k]];
  return order;
}

}  // namespace sim
