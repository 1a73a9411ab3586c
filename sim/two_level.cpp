#include "sim/two_level.h"

#include <algorithm>

#include "sim/elimination_order.h"

namespace sim {
namespace {

template <class T>
void addScaled(const M3<T>& m, T scale, bool transposed, M3<T>& to) {
  for (int k = 0; k < 9; ++k) to.m[k] += scale * m.m[transposed ? 3 * (k % 3) + k / 3 : k];
}

}  // namespace

template <class T>
TwoLevel<T>::TwoLevel(const HairMesh& mesh, const BlockPattern& system)
    : layout_(mesh), columns_(mesh, layout_), layers_(mesh, layout_, columns_), space_(mesh, system) {
  coarse_matrix_ = BlockMatrix<T>(&space_.pattern);
  coarse_.factor.analyze(space_.pattern,
                         minimumDegreeOrder(space_.pattern, std::vector<unsigned char>(space_.size, 1)));
  restricted_.resize(space_.size);
  solved_.resize(space_.size);
}

template <class T>
void TwoLevel<T>::projectRow(const BlockMatrix<T>& rest, int row) {
  const auto addBlock = [&](int i, int j, const M3<T>& m) {
    for (int p = space_.first[i]; p < space_.first[i + 1]; ++p) {
      for (int q = space_.first[j]; q < space_.first[j + 1]; ++q) {
        const int a = space_.index[p], b = space_.index[q];
        const T scale = static_cast<T>(space_.weight[p]) * static_cast<T>(space_.weight[q]);
        if (a == b) {
          addScaled(m, scale, false, coarse_matrix_.diagonal[a]);
          if (i != j) addScaled(m, scale, true, coarse_matrix_.diagonal[a]);
        } else if (a > b) {
          addScaled(m, scale, false, coarse_matrix_.lower[space_.pattern.find(a, b)]);
        } else if (i != j) {
          addScaled(m, scale, true, coarse_matrix_.lower[space_.pattern.find(b, a)]);
        }
      }
    }
  };
  addBlock(row, row, rest.diagonal[row]);
  for (int k = rest.pattern->row_first[row]; k < rest.pattern->row_first[row + 1]; ++k) {
    addBlock(row, rest.pattern->columns[k], rest.lower[k]);
  }
}

template <class T>
void TwoLevel<T>::begin() {
  coarse_matrix_.setZero();
  projected_ = 0;
}

template <class T>
bool TwoLevel<T>::work(const BlockMatrix<T>& rest, bool compact, int slices) {
  const int size = rest.pattern->size, end = std::min(size, projected_ + size / slices + 1);
  for (; projected_ < end; ++projected_) projectRow(rest, projected_);
  if (projected_ < size) return false;
  coarse_.make(coarse_matrix_, compact);
  fine = coarse_.fine;
  return true;
}

template <class T>
void TwoLevel<T>::make(const BlockMatrix<T>& rest, bool compact) {
  begin();
  work(rest, compact, 1);
}

template <class T>
void TwoLevel<T>::solveCoarse(std::span<const M3<T>> turn, std::span<const V3<T>> r) {
  std::fill(restricted_.begin(), restricted_.end(), V3<T>{});
  for (std::size_t i = 0; i < r.size(); ++i) {
    const V3<T> turned = transposeTimes(turn[i], r[i]);
    for (int k = space_.first[i]; k < space_.first[i + 1]; ++k) {
      restricted_[space_.index[k]] += static_cast<T>(space_.weight[k]) * turned;
    }
  }
  coarse_.solve(restricted_, solved_);
}

template <class T>
V3<T> TwoLevel<T>::coarseAt(std::size_t vertex) const {
  V3<T> moved{};
  for (int k = space_.first[vertex]; k < space_.first[vertex + 1]; ++k) {
    moved += static_cast<T>(space_.weight[k]) * solved_[space_.index[k]];
  }
  return moved;
}

template <class T>
void TwoLevel<T>::applyCoarse(std::span<const M3<T>> turn, std::span<const V3<T>> r, std::span<V3<T>> z) {
  solveCoarse(turn, r);
  for (std::size_t i = 0; i < z.size(); ++i) z[i] = turn[i] * coarseAt(i);
}

template <class T>
void TwoLevel<T>::apply(std::span<const M3<T>> turn, std::span<const V3<T>> r, std::span<V3<T>> z) {
  solveCoarse(turn, r);
  layers_.solve(r, z);
  for (std::size_t i = 0; i < z.size(); ++i) z[i] += coarse_weight * (turn[i] * coarseAt(i));
}

template struct TwoLevel<float>;
template struct TwoLevel<double>;

}  // namespace sim
