#include "sim/layer_factor.h"

#include <algorithm>
#include <map>
#include <set>

#include "sim/elimination_order.h"

namespace sim {
namespace {

constexpr int kPivot = 6, kBlock = 9;  // components

// What one group of lanes is walked by.
struct Structure {
  std::span<const int> below_first, updates;
  std::span<const std::size_t> pivot_at, block_at;
  std::span<const int> rows, rows_below;
};

template <class T>
HAIRMESH_INLINE void loadBlock(const T* from, Lanes<T>* m) {
  for (int k = 0; k < kBlock; ++k) m[k] = load<T>(from + k * kLanes);
}

// The inverse of a symmetric block (xx, xy, xz, yy, yz, zz), in place; that of its diagonal in lanes where it is
// singular.
template <class T>
HAIRMESH_INLINE void invert(T* at) {
  Lanes<T> m[kPivot];
  for (int k = 0; k < kPivot; ++k) m[k] = load<T>(at + k * kLanes);
  const Lanes<T> c0 = m[3] * m[5] - m[4] * m[4], c1 = m[4] * m[2] - m[1] * m[5], c2 = m[1] * m[4] - m[3] * m[2];
  const Lanes<T> det = m[0] * c0 + m[1] * c1 + m[2] * c2, scale = m[0] + m[3] + m[5];
  const Lanes<T> one = constant<Lanes<T>>(1), zero = constant<Lanes<T>>(0);
  const auto regular = det > constant<Lanes<T>>(1e-9) * scale * scale * scale;
  const Lanes<T> s = one / (regular ? det : one);
  store<T>(at, regular ? s * c0 : one / m[0]);
  store<T>(at + kLanes, regular ? s * c1 : zero);
  store<T>(at + 2 * kLanes, regular ? s * c2 : zero);
  store<T>(at + 3 * kLanes, regular ? s * (m[0] * m[5] - m[2] * m[2]) : one / m[3]);
  store<T>(at + 4 * kLanes, regular ? s * (m[1] * m[2] - m[0] * m[4]) : zero);
  store<T>(at + 5 * kLanes, regular ? s * (m[0] * m[3] - m[1] * m[1]) : one / m[5]);
}

template <class T>
HAIRMESH_INLINE void eliminateGroup(const Structure& s, T* values, T* panel) {
  const int* update = s.updates.data();
  for (std::size_t k = 0; k < s.pivot_at.size(); ++k) {
    const int first = s.below_first[k], count = s.below_first[k + 1] - first;
    T* pivot = values + s.pivot_at[k];
    invert<T>(pivot);
    Lanes<T> d[kPivot];
    for (int c = 0; c < kPivot; ++c) d[c] = load<T>(pivot + c * kLanes);
    // The blocks below are kept as they were in the panel (D L^T, turned), and become L = U D^-1.
    for (int i = 0; i < count; ++i) {
      T* block = values + s.block_at[first + i];
      Lanes<T> u[kBlock];
      loadBlock<T>(block, u);
      for (int c = 0; c < kBlock; ++c) store<T>(panel + (i * kBlock + c) * kLanes, u[c]);
      for (int r = 0; r < 3; ++r) {
        const Lanes<T> a = u[3 * r], b = u[3 * r + 1], c = u[3 * r + 2];
        store<T>(block + (3 * r) * kLanes, a * d[0] + b * d[1] + c * d[2]);
        store<T>(block + (3 * r + 1) * kLanes, a * d[1] + b * d[3] + c * d[4]);
        store<T>(block + (3 * r + 2) * kLanes, a * d[2] + b * d[4] + c * d[5]);
      }
    }
    for (int i = 0; i < count; ++i) {
      Lanes<T> l[kBlock];
      loadBlock<T>(values + s.block_at[first + i], l);
      for (int j = 0; j <= i; ++j, ++update) {
        Lanes<T> u[kBlock];
        loadBlock<T>(panel + j * kBlock * kLanes, u);
        const bool own = *update < 0;
        T* to = values + (own ? s.pivot_at[~*update] : s.block_at[*update]);
        for (int r = 0; r < 3; ++r) {
          for (int c = own ? r : 0; c < 3; ++c, to += kLanes) {
            store<T>(to,
                     load<T>(to) - (l[3 * r] * u[3 * c] + l[3 * r + 1] * u[3 * c + 1] + l[3 * r + 2] * u[3 * c + 2]));
          }
        }
      }
    }
  }
}

template <class T>
HAIRMESH_INLINE void setAt(ColumnField<T>& f, int at, const V3<Lanes<T>>& v) {
  store<T>(f.x.data() + at, v.x);
  store<T>(f.y.data() + at, v.y);
  store<T>(f.z.data() + at, v.z);
}

template <class T>
HAIRMESH_INLINE void solveGroup(const Structure& s, const T* values, int lane, ColumnField<T>& x) {
  const int count = static_cast<int>(s.pivot_at.size());
  for (int k = 0; k < count; ++k) {
    const V3<Lanes<T>> y = loadAt(x, s.rows[k] + lane);
    for (int i = s.below_first[k]; i < s.below_first[k + 1]; ++i) {
      Lanes<T> l[kBlock];
      loadBlock<T>(values + s.block_at[i], l);
      const V3<Lanes<T>> at = loadAt(x, s.rows_below[i] + lane);
      setAt<T>(x, s.rows_below[i] + lane,
               {at.x - (l[0] * y.x + l[1] * y.y + l[2] * y.z), at.y - (l[3] * y.x + l[4] * y.y + l[5] * y.z),
                at.z - (l[6] * y.x + l[7] * y.y + l[8] * y.z)});
    }
  }
  for (int k = count - 1; k >= 0; --k) {
    Lanes<T> d[kPivot];
    for (int c = 0; c < kPivot; ++c) d[c] = load<T>(values + s.pivot_at[k] + c * kLanes);
    const V3<Lanes<T>> y = loadAt(x, s.rows[k] + lane);
    V3<Lanes<T>> z{d[0] * y.x + d[1] * y.y + d[2] * y.z, d[1] * y.x + d[3] * y.y + d[4] * y.z,
                   d[2] * y.x + d[4] * y.y + d[5] * y.z};
    for (int i = s.below_first[k]; i < s.below_first[k + 1]; ++i) {
      Lanes<T> l[kBlock];
      loadBlock<T>(values + s.block_at[i], l);
      const V3<Lanes<T>> at = loadAt(x, s.rows_below[i] + lane);
      z.x -= l[0] * at.x + l[3] * at.y + l[6] * at.z;
      z.y -= l[1] * at.x + l[4] * at.y + l[7] * at.z;
      z.z -= l[2] * at.x + l[5] * at.y + l[8] * at.z;
    }
    setAt<T>(x, s.rows[k] + lane, z);
  }
}

HAIRMESH_CLONES void runElimination(const Structure& s, float* values, float* panel) {
  eliminateGroup(s, values, panel);
}
HAIRMESH_CLONES void runElimination(const Structure& s, double* values, double* panel) {
  eliminateGroup(s, values, panel);
}
HAIRMESH_CLONES void runSolve(const Structure& s, const float* values, int lane, ColumnField<float>& x) {
  solveGroup(s, values, lane, x);
}
HAIRMESH_CLONES void runSolve(const Structure& s, const double* values, int lane, ColumnField<double>& x) {
  solveGroup(s, values, lane, x);
}

}  // namespace

template <class T>
LayerFactor<T>::LayerFactor(const HairMesh& mesh, const ColumnLayout& layout, const ColumnPattern& pattern)
    : mesh_(&mesh), layout_(&layout), pattern_(&pattern), groups_(layout.stride / kLanes) {
  const int columns = layout.columns;
  std::vector<std::pair<int, int>> pairs;
  for (const BlockDiagonal& d : pattern.diagonals) {
    if (d.a != d.b && d.offset == 0) pairs.emplace_back(d.a, d.b);
  }
  const BlockPattern graph = makePattern(columns, pairs);
  order_ = minimumDegreeOrder(graph, std::vector<unsigned char>(columns, 1));
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
    group_size_ += kPivot * kLanes;
    for (const int row : coupled[k]) {
      block_of[{row, k}] = static_cast<int>(below_.size());
      below_.push_back(order_[row]);
      block_at_.push_back(group_size_);
      group_size_ += kBlock * kLanes;
    }
    below_first_.push_back(static_cast<int>(below_.size()));
  }
  std::size_t most = 0;
  for (int k = 0; k < columns; ++k) {
    most = std::max(most, coupled[k].size());
    for (const int i : coupled[k]) {
      for (const int j : coupled[k]) {
        if (j <= i) updates_.push_back(i == j ? ~i : block_of.at({i, j}));
      }
    }
    rows_.push_back(layout.first(order_[k]));
  }
  for (const int column : below_) rows_below_.push_back(layout.first(column));
  for (std::size_t n = 0; n < pattern.diagonals.size(); ++n) {
    const BlockDiagonal& d = pattern.diagonals[n];
    if (d.offset != 0) continue;
    const int a = position[d.a], b = position[d.b];
    sources_.push_back({static_cast<int>(n), a == b ? ~a : block_of.at({std::max(a, b), std::min(a, b)}), a < b});
  }
  values_.resize(group_size_ * groups_);
  panel_.resize(std::max<std::size_t>(1, most) * kBlock * kLanes);
}

template <class T>
void LayerFactor<T>::clearWithIdentity() {
  std::fill(values_.begin(), values_.end(), T(0));
  for (std::size_t k = 0; k < order_.size(); ++k) {
    for (int l = layout_->length[order_[k]]; l < layout_->stride; ++l) {
      T* pivot = values_.data() + l / kLanes * group_size_ + pivot_at_[k] + l % kLanes;
      for (const int component : {0, 3, 5}) pivot[component * kLanes] = 1;
    }
  }
}

template <class T>
void LayerFactor<T>::factor(const ColumnMatrix<T>& a) {
  clearWithIdentity();
  const int stride = layout_->stride;
  for (const Source& source : sources_) {
    const BlockDiagonal& d = pattern_->diagonals[source.diagonal];
    const bool pivot = source.block < 0;
    const std::size_t at = pivot ? pivot_at_[~source.block] : block_at_[source.block];
    for (int c = 0; c < (pivot ? kPivot : kBlock); ++c) {
      const int to = source.transposed && !pivot ? 3 * (c % 3) + c / 3 : c;
      const T* from = a.values.data() + d.values + static_cast<std::size_t>(c) * stride;
      // Only where both columns have the layer: what stands in the padding is not the matrix.
      const int length = std::min(layout_->length[d.a], layout_->length[d.b]);
      for (int l = 0; l < length; ++l) values_[l / kLanes * group_size_ + at + to * kLanes + l % kLanes] = from[l];
    }
  }
  eliminate();
}

template <class T>
void LayerFactor<T>::factor(const BlockMatrix<T>& a) {
  clearWithIdentity();
  for (const Source& source : sources_) {
    const BlockDiagonal& d = pattern_->diagonals[source.diagonal];
    const bool pivot = source.block < 0;
    const std::size_t at = pivot ? pivot_at_[~source.block] : block_at_[source.block];
    const int length = std::min(layout_->length[d.a], layout_->length[d.b]);
    for (int l = 0; l < length; ++l) {
      T* to = values_.data() + l / kLanes * group_size_ + at + l % kLanes;
      const int i = mesh_->shape.column_first[d.a] + l, j = mesh_->shape.column_first[d.b] + l;
      if (pivot) {
        const T* m = a.diagonal[i].m;
        const T upper[kPivot] = {m[0], m[1], m[2], m[4], m[5], m[8]};
        for (int c = 0; c < kPivot; ++c) to[c * kLanes] = upper[c];
        continue;
      }
      const int block = a.pattern->find(std::max(i, j), std::min(i, j));
      if (block < 0) continue;
      // Stored is row max, column min; wanted the row of the column that is eliminated later (d.b where transposed).
      const bool row_is_b = source.transposed, stored_row_is_b = j > i;
      for (int c = 0; c < kBlock; ++c) {
        to[c * kLanes] = a.lower[block].m[row_is_b == stored_row_is_b ? c : 3 * (c % 3) + c / 3];
      }
    }
  }
  eliminate();
}

template <class T>
void LayerFactor<T>::eliminate() {
  const Structure s{below_first_, updates_, pivot_at_, block_at_, rows_, rows_below_};
  for (int g = 0; g < groups_; ++g) runElimination(s, values_.data() + g * group_size_, panel_.data());
}

template <class T>
void LayerFactor<T>::solve(ColumnField<T>& x) const {
  const Structure s{below_first_, updates_, pivot_at_, block_at_, rows_, rows_below_};
  for (int g = 0; g < groups_; ++g) runSolve(s, values_.data() + g * group_size_, g * kLanes, x);
}

template struct LayerFactor<float>;
template struct LayerFactor<double>;

}  // namespace sim
