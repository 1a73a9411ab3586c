#include "sim/coarse_space.h"

#include <algorithm>
#include <cmath>

namespace sim {
namespace {

std::vector<std::vector<int>> columnNeighbours(const HairMesh& mesh) {
  std::vector<std::vector<int>> neighbours(mesh.columnCount());
  for (const RootFace& face : mesh.shape.root_faces) {
    for (int k = 0; k < face.corner_count; ++k) {
      const int a = face.columns[k], b = face.columns[(k + 1) % face.corner_count];
      neighbours[a].push_back(b);
      neighbours[b].push_back(a);
    }
  }
  return neighbours;
}

// Columns within `reach` root edges of `from`, itself included, nearest first.
std::vector<int> columnsWithin(const std::vector<std::vector<int>>& neighbours, int from, int reach) {
  std::vector<int> found{from};
  std::size_t ring = 0;
  for (int step = 0; step < reach; ++step) {
    const std::size_t end = found.size();
    for (; ring < end; ++ring) {
      for (const int next : neighbours[found[ring]]) {
        if (std::find(found.begin(), found.end(), next) == found.end()) found.push_back(next);
      }
    }
  }
  return found;
}

// A maximal set of columns of which no two are within kColumnReach of one another.
std::vector<int> chooseColumns(const std::vector<std::vector<int>>& neighbours) {
  std::vector<unsigned char> covered(neighbours.size(), 0);
  std::vector<int> chosen;
  for (std::size_t c = 0; c < neighbours.size(); ++c) {
    if (covered[c]) continue;
    chosen.push_back(static_cast<int>(c));
    for (const int near : columnsWithin(neighbours, static_cast<int>(c), CoarseSpace::kColumnReach)) covered[near] = 1;
  }
  return chosen;
}

// Weights that fall with the distance of the roots and reach zero at the first coarse column that is left out.
std::vector<CoarseSpace::Share> sharesOf(const HairMesh& mesh, const std::vector<std::vector<int>>& neighbours,
                                         const std::vector<int>& coarse_number, int column) {
  if (coarse_number[column] >= 0) return {{coarse_number[column], 1}};
  const auto root = [&](int c) -> const Vec3& { return mesh.shape.positions[mesh.shape.column_first[c]]; };
  std::vector<std::pair<double, int>> around;
  for (const int near : columnsWithin(neighbours, column, 2 * CoarseSpace::kColumnReach)) {
    if (coarse_number[near] >= 0) around.emplace_back((root(near) - root(column)).norm(), coarse_number[near]);
  }
  std::sort(around.begin(), around.end());
  const std::size_t count = std::min<std::size_t>(around.size(), CoarseSpace::kNearest);
  const double beyond = around.size() > count ? 1 / around[count].first : 0;
  std::vector<double> weights;
  double sum = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const double weight = 1 / around[k].first - beyond;
    weights.push_back(std::isfinite(weight) ? std::max(0.0, weight) : 0);
    sum += weights.back();
  }
  if (!(sum > 0)) return {{around[0].second, 1}};
  std::vector<CoarseSpace::Share> shares;
  for (std::size_t k = 0; k < count; ++k) {
    if (weights[k] > 0) shares.push_back({around[k].second, static_cast<float>(weights[k] / sum)});
  }
  return shares;
}

}  // namespace

CoarseSpace::CoarseSpace(const HairMesh& mesh, const BlockPattern& system) {
  const std::vector<std::vector<int>> neighbours = columnNeighbours(mesh);
  const std::vector<int> chosen = chooseColumns(neighbours);
  std::vector<int> coarse_number(mesh.columnCount(), -1);
  for (std::size_t k = 0; k < chosen.size(); ++k) coarse_number[chosen[k]] = static_cast<int>(k);
  std::vector<int> longest(chosen.size(), 0);  // of the columns that hang on a coarse one
  for (int c = 0; c < mesh.columnCount(); ++c) {
    for (const Share& share : sharesOf(mesh, neighbours, coarse_number, c)) {
      shares.push_back(share);
      longest[share.coarse] = std::max(longest[share.coarse], mesh.shape.columnLength(c));
    }
    column_first.push_back(static_cast<int>(shares.size()));
  }
  for (const int length : longest) coarse_first.push_back(size() + (length - 1 + kLayerStep - 1) / kLayerStep);
  for (int i = 0; i < mesh.vertexCount(); ++i) {
    const int c = mesh.column_of[i], below = mesh.layer_of[i] / kLayerStep, part = mesh.layer_of[i] % kLayerStep;
    for (int s = column_first[c]; s < column_first[c + 1]; ++s) {
      const int at = coarse_first[shares[s].coarse] + below - 1;  // of the lower of the two; layer 0 is the root
      const float upper = static_cast<float>(part) / kLayerStep;
      if (below > 0) index.push_back(at), weight.push_back(shares[s].weight * (1 - upper));
      if (part > 0) index.push_back(at + 1), weight.push_back(shares[s].weight * upper);
    }
    first.push_back(static_cast<int>(index.size()));
  }
  std::vector<std::pair<int, int>> pairs;
  const auto couple = [&](int i, int j) {
    for (int p = first[i]; p < first[i + 1]; ++p) {
      for (int q = first[j]; q < first[j + 1]; ++q) {
        if (index[p] != index[q]) pairs.emplace_back(std::max(index[p], index[q]), std::min(index[p], index[q]));
      }
    }
  };
  for (int i = 0; i < system.size; ++i) {
    couple(i, i);
    for (int k = system.row_first[i]; k < system.row_first[i + 1]; ++k) couple(i, system.columns[k]);
    // Far fewer pairs are distinct than there are: the list is thinned before it fills the memory.
    if (pairs.size() > 1u << 20 || i + 1 == system.size) {
      std::sort(pairs.begin(), pairs.end());
      pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
    }
  }
  pattern = makePattern(size(), std::move(pairs));
}

}  // namespace sim
