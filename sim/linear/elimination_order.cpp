#include "sim/linear/elimination_order.h"

#include <Eigen/OrderingMethods>
#include <Eigen/Sparse>
#include <algorithm>
#include <cmath>

namespace sim {
namespace {

constexpr int kLeaf = 24;  // rows below which a part is no longer split

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

struct Dissection {
  const Graph& graph;
  std::span<const std::array<double, 4>> coordinates;
  std::vector<int> side;  // of the split in progress: 1 below, 2 above, 3 separator, 0 elsewhere
  std::vector<int> order;

  // Splits `rows` across one axis at its median; returns the parts and leaves the separator's size in `cost`.
  bool split(const std::vector<int>& rows, int axis, std::array<std::vector<int>, 3>& parts) {
    std::vector<double> values;
    for (int r : rows) values.push_back(coordinates[r][axis]);
    std::nth_element(values.begin(), values.begin() + values.size() / 2, values.end());
    const double median = values[values.size() / 2];
    for (int r : rows) side[r] = coordinates[r][axis] < median ? 1 : 2;
    // The separator: the rows above that touch a row below, or the other way about, whichever are fewer.
    std::array<std::vector<int>, 2> touching;
    for (int r : rows) {
      const bool touches = std::any_of(graph.neighbours[r].begin(), graph.neighbours[r].end(),
                                       [&](int n) { return side[n] == 3 - side[r]; });
      if (touches) touching[side[r] - 1].push_back(r);
    }
    const auto& separator = touching[0].size() < touching[1].size() ? touching[0] : touching[1];
    for (int r : separator) side[r] = 3;
    for (auto& part : parts) part.clear();
    for (int r : rows) parts[side[r] - 1].push_back(r);
    for (int r : rows) side[r] = 0;
    return !parts[0].empty() && !parts[1].empty();
  }

  void dissect(const std::vector<int>& rows) {
    std::array<std::vector<int>, 3> best, parts;
    double best_cost = 1e300;
    if (static_cast<int>(rows.size()) > kLeaf) {
      for (int axis = 0; axis < 4; ++axis) {
        if (!split(rows, axis, parts)) continue;
        // Small separators, balanced halves.
        const double halves = static_cast<double>(std::max(parts[0].size(), parts[1].size())) / rows.size();
        const double cost = static_cast<double>(parts[2].size()) * (1 + 2 * std::max(0.0, halves - 0.5));
        if (cost < best_cost) best_cost = cost, best = parts;
      }
    }
    if (best_cost >= 0.6 * static_cast<double>(rows.size())) {
      // A leaf: tip first, so that a column folds up towards its root.
      std::vector<int> leaf = rows;
      std::stable_sort(leaf.begin(), leaf.end(), [&](int a, int b) { return coordinates[a][3] > coordinates[b][3]; });
      order.insert(order.end(), leaf.begin(), leaf.end());
      return;
    }
    dissect(best[0]);
    dissect(best[1]);
    std::stable_sort(best[2].begin(), best[2].end(),
                     [&](int a, int b) { return coordinates[a][3] > coordinates[b][3]; });
    order.insert(order.end(), best[2].begin(), best[2].end());
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

std::vector<int> nestedDissectionOrder(const BlockPattern& pattern, std::span<const unsigned char> keep,
                                       std::span<const std::array<double, 4>> coordinates) {
  const Graph graph(pattern, keep);
  Dissection dissection{graph, coordinates, std::vector<int>(pattern.size, 0), {}};
  std::vector<int> rows;
  for (int i = 0; i < pattern.size; ++i) {
    if (keep[i]) rows.push_back(i);
  }
  dissection.dissect(rows);
  return std::move(dissection.order);
}

std::vector<std::array<double, 4>> dissectionCoordinates(const HairMesh& mesh) {
  std::vector<std::array<double, 4>> coordinates(mesh.vertexCount());
  for (int v = 0; v < mesh.vertexCount(); ++v) {
    const Vec3& root = mesh.shape.positions[mesh.shape.column_first[mesh.column_of[v]]];
    coordinates[v] = {root.x(), root.y(), root.z(), static_cast<double>(mesh.layer_of[v])};
  }
  return coordinates;
}

}  // namespace sim
