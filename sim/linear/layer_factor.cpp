#include "sim/linear/layer_factor.h"

#include <algorithm>
#include <map>
#include <set>

#include "sim/linear/lane_blocks.h"

namespace sim {
namespace {

constexpr int kPivot = 6, kBlock = 9;  // components
using Structure = LayerStructure;

template <class T, int W>
HAIRMESH_INLINE void loadBlock(const T* from, Lanes<T, W>* m) {
  for (int k = 0; k < kBlock; ++k) m[k] = load<T, W>(from + k * W);
}

template <class T, int W>
HAIRMESH_INLINE void eliminateGroup(const Structure& s, T* values, T* panel) {
  const int* update = s.updates.data();
  for (std::size_t k = 0; k < s.pivot_at.size(); ++k) {
    const int first = s.below_first[k], count = s.below_first[k + 1] - first;
    T* pivot = values + s.pivot_at[k];
    Lanes<T, W> d[kPivot];
    for (int c = 0; c < kPivot; ++c) d[c] = load<T, W>(pivot + c * W);
    invertPivot<T, W>(d, d);
    for (int c = 0; c < kPivot; ++c) store<T, W>(pivot + c * W, d[c]);
    // The blocks below are kept as they were in the panel (D L^T, turned), and become L = U D^-1.
    for (int i = 0; i < count; ++i) {
      T* block = values + s.block_at[first + i];
      Lanes<T, W> u[kBlock];
      loadBlock<T, W>(block, u);
      for (int c = 0; c < kBlock; ++c) store<T, W>(panel + (i * kBlock + c) * W, u[c]);
      for (int r = 0; r < 3; ++r) {
        const Lanes<T, W> a = u[3 * r], b = u[3 * r + 1], c = u[3 * r + 2];
        store<T, W>(block + (3 * r) * W, a * d[0] + b * d[1] + c * d[2]);
        store<T, W>(block + (3 * r + 1) * W, a * d[1] + b * d[3] + c * d[4]);
        store<T, W>(block + (3 * r + 2) * W, a * d[2] + b * d[4] + c * d[5]);
      }
    }
    for (int i = 0; i < count; ++i) {
      Lanes<T, W> l[kBlock];
      loadBlock<T, W>(values + s.block_at[first + i], l);
      for (int j = 0; j < i; ++j, ++update) {
        Lanes<T, W> u[kBlock];
        loadBlock<T, W>(panel + j * kBlock * W, u);
        T* to = values + s.block_at[*update];
#pragma GCC unroll 9
        for (int c = 0; c < kBlock; ++c) {
          const Lanes<T, W>*left = l + c / 3 * 3, *right = u + c % 3 * 3;
          store<T, W>(to + c * W,
                      load<T, W>(to + c * W) - (left[0] * right[0] + left[1] * right[1] + left[2] * right[2]));
        }
      }
      Lanes<T, W> u[kBlock];
      loadBlock<T, W>(panel + i * kBlock * W, u);
      T* to = values + s.pivot_at[*update++];
      for (int r = 0; r < 3; ++r) {
        for (int c = r; c < 3; ++c, to += W) {
          store<T, W>(
              to, load<T, W>(to) - (l[3 * r] * u[3 * c] + l[3 * r + 1] * u[3 * c + 1] + l[3 * r + 2] * u[3 * c + 2]));
        }
      }
    }
  }
}

template <class T, int W>
HAIRMESH_INLINE void setAt(ColumnField<T>& f, int at, const V3<Lanes<T, W>>& v) {
  store<T, W>(f.x.data() + at, v.x);
  store<T, W>(f.y.data() + at, v.y);
  store<T, W>(f.z.data() + at, v.z);
}

template <class T, int W>
HAIRMESH_INLINE void solveGroup(const Structure& s, const T* values, int lane, ColumnField<T>& x) {
  const int count = static_cast<int>(s.pivot_at.size());
  for (int k = 0; k < count; ++k) {
    const V3<Lanes<T, W>> y = loadAt<W>(x, s.rows[k] + lane);
    for (int i = s.below_first[k]; i < s.below_first[k + 1]; ++i) {
      Lanes<T, W> l[kBlock];
      loadBlock<T, W>(values + s.block_at[i], l);
      const V3<Lanes<T, W>> at = loadAt<W>(x, s.rows_below[i] + lane);
      setAt<T, W>(x, s.rows_below[i] + lane,
                  {at.x - (l[0] * y.x + l[1] * y.y + l[2] * y.z), at.y - (l[3] * y.x + l[4] * y.y + l[5] * y.z),
                   at.z - (l[6] * y.x + l[7] * y.y + l[8] * y.z)});
    }
  }
  for (int k = count - 1; k >= 0; --k) {
    Lanes<T, W> d[kPivot];
    for (int c = 0; c < kPivot; ++c) d[c] = load<T, W>(values + s.pivot_at[k] + c * W);
    const V3<Lanes<T, W>> y = loadAt<W>(x, s.rows[k] + lane);
    V3<Lanes<T, W>> z{d[0] * y.x + d[1] * y.y + d[2] * y.z, d[1] * y.x + d[3] * y.y + d[4] * y.z,
                      d[2] * y.x + d[4] * y.y + d[5] * y.z};
    for (int i = s.below_first[k]; i < s.below_first[k + 1]; ++i) {
      Lanes<T, W> l[kBlock];
      loadBlock<T, W>(values + s.block_at[i], l);
      const V3<Lanes<T, W>> at = loadAt<W>(x, s.rows_below[i] + lane);
      z.x -= l[0] * at.x + l[3] * at.y + l[6] * at.z;
      z.y -= l[1] * at.x + l[4] * at.y + l[7] * at.z;
      z.z -= l[2] * at.x + l[5] * at.y + l[8] * at.z;
    }
    setAt<T, W>(x, s.rows[k] + lane, z);
  }
}

HAIRMESH_CLONES void runElimination(const Structure& s, int lanes, float* values, float* panel) {
  lanes == kWideLanes ? eliminateGroup<float, kWideLanes>(s, values, panel)
                      : eliminateGroup<float, kLanes>(s, values, panel);
}
HAIRMESH_CLONES void runElimination(const Structure& s, int, double* values, double* panel) {
  eliminateGroup<double, kLanes>(s, values, panel);
}
HAIRMESH_CLONES void runSolve(const Structure& s, int lanes, const float* values, int lane, ColumnField<float>& x) {
  lanes == kWideLanes ? solveGroup<float, kWideLanes>(s, values, lane, x)
                      : solveGroup<float, kLanes>(s, values, lane, x);
}
HAIRMESH_CLONES void runSolve(const Structure& s, int, const double* values, int lane, ColumnField<double>& x) {
  solveGroup<double, kLanes>(s, values, lane, x);
}

}  // namespace

template <class T>
LayerFactor<T>::LayerFactor(const HairMesh& mesh, const ColumnLayout& layout, const ColumnPattern& pattern)
    : mesh_(&mesh),
      layout_(&layout),
      pattern_(&pattern),
      lanes_(std::is_same_v<T, float> && layout.stride % kWideLanes == 0 ? kWideLanes : kLanes),
      groups_(layout.stride / lanes_) {
  const int columns = layout.columns;
  std::vector<std::pair<int, int>> pairs;
  for (const BlockDiagonal& d : pattern.diagonals) {
    if (d.a != d.b && d.offset == 0) pairs.emplace_back(d.a, d.b);
  }
  const BlockPattern graph = makePattern(columns, pairs);
  order_ = minimumDegreeOrder(graph);
  std::vector<int> position(columns);
  for (int k = 0; k < columns; ++k) position[order_[k]] = k;
  // Symbolic elimination, in positions.
  std::vector<std::set<int>> coupled(columns);
  for (const auto& [a, b] : pairs)
    coupled[std::min(position[a], position[b])].insert(std::max(position[a], position[b]));
  std::map<std::pair<int, int>, int> block_of;  // (row, column) in positions
  for (int k = 0; k < columns; ++k) {
    if (!coupled[k].empty()) {
      const int parent = *coupled[k].begin();
      coupled[parent].insert(std::next(coupled[k].begin()), coupled[k].end());
    }
    pivot_at_.push_back(group_size_);
    group_size_ += kPivot * lanes_;
    for (const int row : coupled[k]) {
      block_of[{row, k}] = static_cast<int>(rows_below_.size());
      rows_below_.push_back(layout.first(order_[row]));
      block_at_.push_back(group_size_);
      group_size_ += kBlock * lanes_;
    }
    below_first_.push_back(static_cast<int>(rows_below_.size()));
  }
  std::size_t most = 0;
  for (int k = 0; k < columns; ++k) {
    most = std::max(most, coupled[k].size());
    for (const int i : coupled[k]) {
      for (const int j : coupled[k]) {
        if (j <= i) updates_.push_back(i == j ? i : block_of.at({i, j}));
      }
    }
    rows_.push_back(layout.first(order_[k]));
  }
  findSources(position, block_of);
  values_.resize(group_size_ * groups_);
  panel_.resize(std::max<std::size_t>(1, most) * kBlock * lanes_);
}

template <class T>
void LayerFactor<T>::findSources(std::span<const int> position, const std::map<std::pair<int, int>, int>& block_of) {
  for (std::size_t n = 0; n < pattern_->diagonals.size(); ++n) {
    const BlockDiagonal& d = pattern_->diagonals[n];
    if (d.offset != 0) continue;
    const int a = position[d.a], b = position[d.b];
    sources_.push_back({static_cast<int>(n), a == b ? ~a : block_of.at({std::max(a, b), std::min(a, b)}), a < b});
  }
  for (int c = 0; c < layout_->columns; ++c) {
    for (std::size_t n = 0; n < sources_.size(); ++n) {
      const BlockDiagonal& d = pattern_->diagonals[sources_[n].diagonal];
      if (d.a == c || d.b == c) sources_of_.push_back(static_cast<int>(n));
    }
    sources_of_first_.push_back(static_cast<int>(sources_of_.size()));
  }
}

template <class T>
void LayerFactor<T>::clearWithIdentity() {
  std::fill(values_.begin(), values_.end(), T(0));
  for (std::size_t k = 0; k < order_.size(); ++k) {
    for (int l = layout_->length[order_[k]]; l < layout_->stride; ++l) {
      T* pivot = values_.data() + l / lanes_ * group_size_ + pivot_at_[k] + l % lanes_;
      for (const int component : {0, 3, 5}) pivot[component * lanes_] = 1;
    }
  }
}

template <class T>
void LayerFactor<T>::factor(const ColumnMatrix<T>& a, std::span<const VertexConstraint> constraints) {
  clearWithIdentity();
  const int stride = layout_->stride;
  for (const Source& source : sources_) {
    const BlockDiagonal& d = pattern_->diagonals[source.diagonal];
    const bool pivot = source.block < 0;
    const std::size_t at = pivot ? pivot_at_[~source.block] : block_at_[source.block];
    // Only where both columns have the layer: what stands in the padding is not the matrix.
    const int length = std::min(layout_->length[d.a], layout_->length[d.b]);
    for (int c = 0; c < (pivot ? kPivot : kBlock); ++c) {
      const int to = source.transposed && !pivot ? 3 * (c % 3) + c / 3 : c;
      const T* from = a.values.data() + d.values + static_cast<std::size_t>(c) * stride;
      for (int l = 0, g = 0; l < length; l += lanes_, ++g) {
        std::copy_n(from + l, std::min(lanes_, length - l), values_.data() + g * group_size_ + at + to * lanes_);
      }
    }
  }
  mask(constraints);
  eliminate();
}

// What stands for the matrix in values_ loses the directions that are removed.
template <class T>
void LayerFactor<T>::mask(std::span<const VertexConstraint> constraints) {
  for (const VertexConstraint& constraint : constraints) {
    const int c = mesh_->column_of[constraint.vertex], layer = mesh_->layer_of[constraint.vertex];
    const M3<T> keep = keptBy<T>(constraint);
    T* const group = values_.data() + layer / lanes_ * group_size_ + layer % lanes_;
    for (int k = sources_of_first_[c]; k < sources_of_first_[c + 1]; ++k) {
      const Source& source = sources_[sources_of_[k]];
      if (source.block < 0) {
        maskPivot(group + pivot_at_[~source.block], lanes_, keep);
        continue;
      }
      const BlockDiagonal& d = pattern_->diagonals[source.diagonal];
      maskBlock(group + block_at_[source.block], lanes_, keep, (source.transposed ? d.b : d.a) == c);
    }
  }
}

template <class T>
LayerStructure LayerFactor<T>::structure() const {
  return {below_first_, updates_, pivot_at_, block_at_, rows_, rows_below_};
}

template <class T>
void LayerFactor<T>::eliminate() {
  const Structure s = structure();
  for (int g = 0; g < groups_; ++g) runElimination(s, lanes_, values_.data() + g * group_size_, panel_.data());
}

template <class T>
void LayerFactor<T>::solve(ColumnField<T>& x) const {
  const Structure s = structure();
  for (int g = 0; g < groups_; ++g) runSolve(s, lanes_, values_.data() + g * group_size_, g * lanes_, x);
}

template struct LayerFactor<float>;
template struct LayerFactor<double>;

}  // namespace sim
