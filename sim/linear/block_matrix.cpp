#include "sim/linear/block_matrix.h"

#include <algorithm>

namespace sim {

int BlockPattern::find(int i, int j) const {
  const auto begin = columns.begin() + row_first[i], end = columns.begin() + row_first[i + 1];
  const auto it = std::lower_bound(begin, end, j);
  return it != end && *it == j ? static_cast<int>(it - columns.begin()) : -1;
}

BlockPattern makePattern(int size, std::vector<std::pair<int, int>> pairs) {
  for (auto& [i, j] : pairs) {
    if (i < j) std::swap(i, j);
  }
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  BlockPattern pattern;
  pattern.size = size;
  pattern.row_first.assign(size + 1, 0);
  for (const auto& [i, j] : pairs) {
    ++pattern.row_first[i + 1];
    pattern.columns.push_back(j);
  }
  for (int i = 0; i < size; ++i) pattern.row_first[i + 1] += pattern.row_first[i];
  return pattern;
}

}  // namespace sim
