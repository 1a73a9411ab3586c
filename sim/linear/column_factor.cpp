#include "sim/linear/column_factor.h"

#include <algorithm>
#include <numeric>

#include "sim/linear/lane_blocks.h"
#include "sim/linear/vector3.h"

namespace sim {
namespace {

constexpr int kPivot = 6, kBlock = 9, kReach = 2;
constexpr int kRow = kPivot + kReach * kBlock;  // entries of a row, each of so many lanes

template <class T, int W, int kCount>
HAIRMESH_INLINE void loadAll(const T* from, Lanes<T, W>* m) {
  for (int k = 0; k < kCount; ++k) m[k] = load<T, W>(from + k * W);
}

// pivot -= l u^T, of which the upper triangle is kept.
template <class T, int W>
HAIRMESH_INLINE void subtractFromPivot(const Lanes<T, W>* l, const Lanes<T, W>* u, T* pivot) {
  for (int r = 0; r < 3; ++r) {
    for (int c = r; c < 3; ++c, pivot += W) {
      store<T, W>(
          pivot, load<T, W>(pivot) - (l[3 * r] * u[3 * c] + l[3 * r + 1] * u[3 * c + 1] + l[3 * r + 2] * u[3 * c + 2]));
    }
  }
}

// l = u d, into memory too.
template <class T, int W>
HAIRMESH_INLINE void timesPivot(const Lanes<T, W>* u, const Lanes<T, W>* d, Lanes<T, W>* l, T* to) {
  for (int r = 0; r < 3; ++r) {
    const Lanes<T, W> a = u[3 * r], b = u[3 * r + 1], c = u[3 * r + 2];
    l[3 * r] = a * d[0] + b * d[1] + c * d[2];
    l[3 * r + 1] = a * d[1] + b * d[3] + c * d[4];
    l[3 * r + 2] = a * d[2] + b * d[4] + c * d[5];
    for (int k = 3 * r; k < 3 * r + 3; ++k) store<T, W>(to + k * W, l[k]);
  }
}

// `row`: the first of so many rows.
template <class T, int W>
HAIRMESH_INLINE void eliminateGroup(int rows, T* row) {
  for (int i = 0; i < rows; ++i, row += kRow * W) {
    Lanes<T, W> p[kPivot], d[kPivot], next[kBlock], second[kBlock], l[kBlock];
    loadAll<T, W, kPivot>(row, p);
    invertPivot<T, W>(p, d);
    for (int k = 0; k < kPivot; ++k) store<T, W>(row + k * W, d[k]);
    T *const next_at = row + kPivot * W, *const second_at = next_at + kBlock * W;
    loadAll<T, W, kBlock>(next_at, next);
    loadAll<T, W, kBlock>(second_at, second);
    timesPivot<T, W>(next, d, l, next_at);
    if (i + 1 < rows) subtractFromPivot<T, W>(l, next, row + kRow * W);
    timesPivot<T, W>(second, d, l, second_at);
    if (i + 2 >= rows) continue;
    subtractFromPivot<T, W>(l, second, row + 2 * kRow * W);
    T* to = row + (kRow + kPivot) * W;  // couples the next vertex with the one after it
    for (int k = 0; k < kBlock; ++k, to += W) {
      const Lanes<T, W>*left = l + k / 3 * 3, *right = next + k % 3 * 3;
      store<T, W>(to, load<T, W>(to) - (left[0] * right[0] + left[1] * right[1] + left[2] * right[2]));
    }
  }
}

template <class T, int W>
HAIRMESH_INLINE V3<Lanes<T, W>> vectorAt(const T* at) {
  return {load<T, W>(at), load<T, W>(at + W), load<T, W>(at + 2 * W)};
}
template <class T, int W>
HAIRMESH_INLINE void setVector(T* at, const V3<Lanes<T, W>>& v) {
  store<T, W>(at, v.x), store<T, W>(at + W, v.y), store<T, W>(at + 2 * W, v.z);
}
template <class T, int W>
HAIRMESH_INLINE M3<Lanes<T, W>> blockAt(const T* at) {
  M3<Lanes<T, W>> block;
  loadAll<T, W, kBlock>(at, block.m);
  return block;
}

// In place in `x`, three times W entries a row.
template <class T, int W>
HAIRMESH_INLINE void solveGroup(int rows, const T* values, T* x) {
  V3<Lanes<T, W>> before{}, second{};  // what the rows passed leave to the present one and to the next
  const T* row = values;
  for (int i = 0; i < rows; ++i, row += kRow * W) {
    const V3<Lanes<T, W>> y = vectorAt<T, W>(x + 3 * i * W) - before;
    setVector<T, W>(x + 3 * i * W, y);
    before = second + blockAt<T, W>(row + kPivot * W) * y;
    second = blockAt<T, W>(row + (kPivot + kBlock) * W) * y;
  }
  V3<Lanes<T, W>> next{}, after{};
  for (int i = rows - 1; i >= 0; --i) {
    row -= kRow * W;
    Lanes<T, W> d[kPivot];
    loadAll<T, W, kPivot>(row, d);
    const V3<Lanes<T, W>> y = vectorAt<T, W>(x + 3 * i * W);
    const V3<Lanes<T, W>> own{d[0] * y.x + d[1] * y.y + d[2] * y.z, d[1] * y.x + d[3] * y.y + d[4] * y.z,
                              d[2] * y.x + d[4] * y.y + d[5] * y.z};
    const V3<Lanes<T, W>> z = own - (transposeTimes(blockAt<T, W>(row + kPivot * W), next) +
                                     transposeTimes(blockAt<T, W>(row + (kPivot + kBlock) * W), after));
    setVector<T, W>(x + 3 * i * W, z);
    after = next, next = z;
  }
}

HAIRMESH_CLONES void runElimination(int rows, float* row) {
  eliminateGroup<float, kWideLanes>(rows, row);
}
HAIRMESH_CLONES void runElimination(int rows, double* row) {
  eliminateGroup<double, kLanes>(rows, row);
}
HAIRMESH_CLONES void runSolve(int rows, const float* values, float* x) {
  solveGroup<float, kWideLanes>(rows, values, x);
}
HAIRMESH_CLONES void runSolve(int rows, const double* values, double* x) {
  solveGroup<double, kLanes>(rows, values, x);
}

}  // namespace

template <class T>
ColumnFactor<T>::ColumnFactor(const HairMesh& mesh, const ColumnLayout& layout, const ColumnPattern& pattern)
    : mesh_(&mesh),
      layout_(&layout),
      lanes_(std::is_same_v<T, float> ? kWideLanes : kLanes),
      place_(layout.columns),
      source_(layout.columns, {-1, -1, -1}) {
  std::vector<int> order(layout.columns);
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return layout.length[a] > layout.length[b]; });
  std::size_t size = 0;
  int deepest = 1;
  for (int first = 0; first < layout.columns; first += lanes_) {
    const int depth = layout.length[order[first]];
    groups_.push_back({depth, size, static_cast<int>(columns_.size())});
    for (int lane = 0; lane < lanes_; ++lane) {
      const int column = first + lane < layout.columns ? order[first + lane] : -1;
      columns_.push_back(column);
      if (column >= 0) place_[column] = {static_cast<int>(groups_.size()) - 1, lane};
    }
    size += static_cast<std::size_t>(std::max(0, depth - 1)) * kRow * lanes_;
    deepest = std::max(deepest, depth);
  }
  values_.resize(size);
  rows_.resize(3 * static_cast<std::size_t>(deepest) * lanes_);
  for (const BlockDiagonal& d : pattern.diagonals) {
    if (d.a == d.b && d.offset <= kReach) source_[d.a][d.offset] = static_cast<std::ptrdiff_t>(d.values);
  }
}

// Entries of a column's vertex: those of its pivot (step 0), or of the block that couples it with the `step`-th after.
template <class T>
T* ColumnFactor<T>::at(int column, int layer, int step) {
  const Place place = place_[column];
  const int entry = (layer - 1) * kRow + (step == 0 ? 0 : kPivot + (step - 1) * kBlock);
  return values_.data() + groups_[place.group].values + static_cast<std::size_t>(entry) * lanes_ + place.lane;
}

template <class T>
void ColumnFactor<T>::clearWithIdentity() {
  std::fill(values_.begin(), values_.end(), T(0));
  for (const Group& group : groups_) {
    for (int lane = 0; lane < lanes_; ++lane) {
      const int column = columns_[group.lanes + lane], length = column < 0 ? 1 : std::max(1, layout_->length[column]);
      for (int layer = length; layer < group.depth; ++layer) {
        T* pivot = values_.data() + group.values + static_cast<std::size_t>((layer - 1) * kRow) * lanes_ + lane;
        for (const int component : {0, 3, 5}) pivot[component * lanes_] = 1;
      }
    }
  }
}

template <class T>
void ColumnFactor<T>::factor(const ColumnMatrix<T>& a, std::span<const VertexConstraint> constraints) {
  clearWithIdentity();
  const int stride = layout_->stride;
  for (int c = 0; c < layout_->columns; ++c) {
    for (int step = 0; step <= kReach; ++step) {
      if (source_[c][step] < 0) continue;
      for (int k = 0; k < (step == 0 ? kPivot : kBlock); ++k) {
        // Kept is the row of the later vertex, stored that of the earlier one.
        const int entry = step == 0 ? k : 3 * (k % 3) + k / 3;
        const T* from = a.values.data() + source_[c][step] + static_cast<std::ptrdiff_t>(k) * stride;
        for (int layer = 1; layer + step < layout_->length[c]; ++layer)
          at(c, layer, step)[entry * lanes_] = from[layer];
      }
    }
  }
  mask(constraints);
  eliminate();
}

template <class T>
void ColumnFactor<T>::mask(std::span<const VertexConstraint> constraints) {
  for (const VertexConstraint& constraint : constraints) {
    const int c = mesh_->column_of[constraint.vertex], layer = mesh_->layer_of[constraint.vertex];
    if (layer == 0) continue;
    const M3<T> keep = keptBy<T>(constraint);
    maskPivot(at(c, layer, 0), lanes_, keep);
    for (int step = 1; step <= kReach; ++step) {
      if (layer + step < layout_->length[c]) maskBlock(at(c, layer, step), lanes_, keep, false);
      if (layer - step >= 1) maskBlock(at(c, layer - step, step), lanes_, keep, true);
    }
  }
}

template <class T>
void ColumnFactor<T>::eliminate() {
  for (const Group& group : groups_) runElimination(std::max(0, group.depth - 1), values_.data() + group.values);
}

template <class T>
void ColumnFactor<T>::addSolution(std::span<const V3<T>> r, T scale, std::span<V3<T>> z) {
  for (const Group& group : groups_) {
    const int rows = std::max(0, group.depth - 1);
    const auto eachVertex = [&](auto&& visit) {
      for (int lane = 0; lane < lanes_; ++lane) {
        const int column = columns_[group.lanes + lane];
        if (column < 0) continue;
        const int first = mesh_->shape.column_first[column];
        for (int layer = 1; layer < layout_->length[column]; ++layer) {
          visit(first + layer, rows_.data() + static_cast<std::ptrdiff_t>(3 * (layer - 1)) * lanes_ + lane);
        }
      }
    };
    std::fill(rows_.begin(), rows_.end(), T(0));
    eachVertex([&](int i, T* x) { x[0] = r[i].x, x[lanes_] = r[i].y, x[2 * lanes_] = r[i].z; });
    runSolve(rows, values_.data() + group.values, rows_.data());
    eachVertex([&](int i, const T* x) { z[i] += scale * V3<T>{x[0], x[lanes_], x[2 * lanes_]}; });
  }
}

template struct ColumnFactor<float>;
template struct ColumnFactor<double>;

}  // namespace sim
