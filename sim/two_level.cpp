#include "sim/two_level.h"

#include <algorithm>
#include <cstdlib>

#include "sim/elimination_order.h"
#include "sim/lanes.h"

namespace sim {
namespace {

template <class T>
void addScaled(const M3<T>& m, T scale, bool transposed, M3<T>& to) {
  for (int k = 0; k < 9; ++k) to.m[k] += scale * m.m[transposed ? 3 * (k % 3) + k / 3 : k];
}

// What the kernels below walk: columns of a padded field, their shares and rotations.
template <class T>
struct Columns {
  const ColumnLayout& layout;
  const CoarseSpace& space;
  const T* turn;
  std::size_t size;  // of a padded array
  M3<Lanes<T>> turnAt(int at) const {
    M3<Lanes<T>> m;
    for (int k = 0; k < 9; ++k) m.m[k] = load<T>(turn + k * size + at);
    return m;
  }
  // Of coarse column k, lane l: x, y and z are a stride apart.
  std::size_t across(int k, int lane) const { return static_cast<std::size_t>(3 * k) * layout.stride + lane; }
};
template <class T>
Columns<T> columnsOf(const ColumnLayout& layout, const CoarseSpace& space, const LineVector<T>& turn) {
  return {layout, space, turn.data(), static_cast<std::size_t>(layout.size())};
}

// across += what hangs on each coarse column of R^T r.
template <class T>
HAIRMESH_INLINE void gather(const Columns<T>& c, const ColumnField<T>& r, T* across) {
  for (int column = 0; column < c.layout.columns; ++column) {
    for (int lane = 0; lane < c.layout.stride; lane += kLanes) {
      const int at = c.layout.first(column) + lane;
      const V3<Lanes<T>> turned = transposeTimes(c.turnAt(at), loadAt(r, at));
      for (int s = c.space.column_first[column]; s < c.space.column_first[column + 1]; ++s) {
        const Lanes<T> weight = constant<Lanes<T>>(c.space.shares[s].weight);
        T* to = across + c.across(c.space.shares[s].coarse, lane);
        addTo<T>(to, weight * turned.x);
        addTo<T>(to + c.layout.stride, weight * turned.y);
        addTo<T>(to + 2 * c.layout.stride, weight * turned.z);
      }
    }
  }
}

// z = keep z + scale R (what the coarse columns say).
template <class T>
HAIRMESH_INLINE void scatter(const Columns<T>& c, const T* across, T keep, T scale, ColumnField<T>& z) {
  for (int column = 0; column < c.layout.columns; ++column) {
    for (int lane = 0; lane < c.layout.stride; lane += kLanes) {
      V3<Lanes<T>> moved{};
      for (int s = c.space.column_first[column]; s < c.space.column_first[column + 1]; ++s) {
        const Lanes<T> weight = constant<Lanes<T>>(c.space.shares[s].weight);
        const T* from = across + c.across(c.space.shares[s].coarse, lane);
        moved.x += weight * load<T>(from);
        moved.y += weight * load<T>(from + c.layout.stride);
        moved.z += weight * load<T>(from + 2 * c.layout.stride);
      }
      const int at = c.layout.first(column) + lane;
      const V3<Lanes<T>> turned = c.turnAt(at) * moved, before = loadAt(z, at);
      const Lanes<T> s = constant<Lanes<T>>(0) + scale, k = constant<Lanes<T>>(0) + keep;
      store<T>(z.x.data() + at, k * before.x + s * turned.x);
      store<T>(z.y.data() + at, k * before.y + s * turned.y);
      store<T>(z.z.data() + at, k * before.z + s * turned.z);
    }
  }
}

HAIRMESH_CLONES void runGather(const Columns<float>& c, const ColumnField<float>& r, float* across) {
  gather(c, r, across);
}
HAIRMESH_CLONES void runGather(const Columns<double>& c, const ColumnField<double>& r, double* across) {
  gather(c, r, across);
}
HAIRMESH_CLONES void runScatter(const Columns<float>& c, const float* across, float keep, float scale,
                                ColumnField<float>& z) {
  scatter(c, across, keep, scale, z);
}
HAIRMESH_CLONES void runScatter(const Columns<double>& c, const double* across, double keep, double scale,
                                ColumnField<double>& z) {
  scatter(c, across, keep, scale, z);
}

}  // namespace

template <class T>
TwoLevel<T>::TwoLevel(const HairMesh& mesh, const BlockPattern& system)
    : layout_(mesh),
      columns_(mesh, layout_),
      layers_(mesh, layout_, columns_),
      strands_(mesh, layout_, columns_),
      space_(mesh, system),
      coarse_matrix_(&space_.pattern),
      field_(layout_),
      turn_(9 * static_cast<std::size_t>(layout_.size())),
      across_(3 * static_cast<std::size_t>(space_.coarseColumns()) * layout_.stride),
      restricted_(space_.size()),
      solved_(space_.size()) {
  const std::vector<unsigned char> all(space_.size(), 1);
  masked_.reserve(mesh.vertexCount());
  coarse_.factor.analyze(space_.pattern, minimumDegreeOrder(space_.pattern, all));
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

// Returns whether the factors know these constraints already; if not, they are taken to from now on.
template <class T>
bool TwoLevel<T>::noteConstraints(std::span<const VertexConstraint> constraints) {
  if (std::ranges::equal(constraints, masked_, [](const VertexConstraint& c, const auto& known) {
        return c.vertex == known.first && c.removed == known.second;
      })) {
    return true;
  }
  masked_.clear();
  for (const VertexConstraint& c : constraints) masked_.emplace_back(c.vertex, c.removed);
  return false;
}

template <class T>
void TwoLevel<T>::setRotations(std::span<const M3<T>> turn) {
  const std::size_t size = layout_.size();
  for (std::size_t i = 0; i < turn.size(); ++i) {
    for (int k = 0; k < 9; ++k) turn_[k * size + layout_.slot[i]] = turn[i].m[k];
  }
}

template <class T>
void TwoLevel<T>::solveCoarse() {
  constexpr int kStep = CoarseSpace::kLayerStep;
  const int stride = layout_.stride;
  const Columns<T> columns = columnsOf(layout_, space_, turn_);
  std::fill(across_.begin(), across_.end(), T(0));
  runGather(columns, field_, across_.data());
  // Hat functions along the hair: coarse vertex m reaches kStep - 1 layers up and down.
  const auto eachHat = [&](auto&& visit) {
    for (int k = 0; k < space_.coarseColumns(); ++k) {
      for (int m = 1; m <= space_.coarse_first[k + 1] - space_.coarse_first[k]; ++m) {
        for (int l = (m - 1) * kStep + 1; l < std::min((m + 1) * kStep, stride); ++l) {
          const T hat = T(1) - static_cast<T>(std::abs(l - m * kStep)) / kStep;
          visit(space_.coarse_first[k] + m - 1, columns.across(k, l), hat);
        }
      }
    }
  };
  std::fill(restricted_.begin(), restricted_.end(), V3<T>{});
  eachHat([&](int vertex, std::size_t at, T hat) {
    restricted_[vertex] += hat * V3<T>{across_[at], across_[at + stride], across_[at + 2 * stride]};
  });
  coarse_.solve(restricted_, solved_);
  std::fill(across_.begin(), across_.end(), T(0));
  eachHat([&](int vertex, std::size_t at, T hat) {
    const V3<T> moved = hat * solved_[vertex];
    across_[at] += moved.x, across_[at + stride] += moved.y, across_[at + 2 * stride] += moved.z;
  });
}

template <class T>
void TwoLevel<T>::applyCoarse(std::span<const V3<T>> r, std::span<V3<T>> z) {
  field_.pack(layout_, r);
  solveCoarse();
  runScatter(columnsOf(layout_, space_, turn_), across_.data(), 0, 1, field_);
  field_.unpack(layout_, z);
}

template <class T>
void TwoLevel<T>::apply(std::span<const V3<T>> r, std::span<V3<T>> z) {
  field_.pack(layout_, r);
  solveCoarse();
  layers_.solve(field_);
  runScatter(columnsOf(layout_, space_, turn_), across_.data(), 1, coarse_weight, field_);
  field_.unpack(layout_, z);
  strands_.addSolution(r, kStrandWeight, z);
}

template struct TwoLevel<float>;
template struct TwoLevel<double>;

}  // namespace sim
