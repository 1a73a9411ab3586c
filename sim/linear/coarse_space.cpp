#include "sim/linear/coarse_space.h"

#include <algorithm>
#include <array>
#include <map>

#include "sim/linear/lanes.h"

namespace sim {
namespace {

constexpr int kEntries = 36;  // of a block between two patches: six motions of either
// Of the largest entry on a block's diagonal: a patch of vertices on one line can turn about it without anything moving
// but by what rounding has put them beside it.
constexpr double kRaise = 1e-4;
constexpr double kMaxFree = 0.6;  // of a column's neighbours, that a group begins with

// A column and its neighbours, in the order of the columns, where most of these have no group yet; what is left then
// joins the neighbouring group that has most of its neighbours.
std::vector<int> groupColumns(int columns, const std::vector<std::vector<int>>& neighbours, int& groups) {
  std::vector<int> group(columns, -1);
  groups = 0;
  const auto isFree = [&](int c) { return group[c] < 0; };
  for (int c = 0; c < columns; ++c) {
    const auto free = std::count_if(neighbours[c].begin(), neighbours[c].end(), isFree);
    if (!isFree(c) || static_cast<double>(free) < kMaxFree * static_cast<double>(neighbours[c].size())) continue;
    group[c] = groups;
    for (const int near : neighbours[c]) {
      if (isFree(near)) group[near] = groups;
    }
    ++groups;
  }
  for (int c = 0; c < columns; ++c) {
    if (!isFree(c)) continue;
    std::map<int, int> shared;
    for (const int near : neighbours[c]) {
      if (!isFree(near)) ++shared[group[near]];
    }
    const auto most = std::max_element(shared.begin(), shared.end(),
                                       [](const auto& p, const auto& q) { return p.second < q.second; });
    group[c] = most == shared.end() ? groups++ : most->first;
  }
  return group;
}

template <class T>
struct Fields {
  const ColumnField<T>& arm;
  const T* moves;
};

template <class T>
HAIRMESH_INLINE V3<Lanes<T>> cross(const V3<Lanes<T>>& a, const V3<Lanes<T>>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

// sums = B_a^T A B_b over the blocks of the diagonals listed, entry by entry of the six by six.
template <class T>
HAIRMESH_INLINE void project(std::span<const BlockDiagonal> diagonals, std::span<const int> which, const T* values,
                             std::ptrdiff_t stride, const Fields<T>& f, T* sums) {
  for (int l = 0; l < stride; l += kLanes) {
    Lanes<T> six[kEntries] = {};
    for (const int k : which) {
      const BlockDiagonal& d = diagonals[k];
      if (l >= d.lanes) continue;
      const T* const from = values + d.values + l;
      const Lanes<T> moves = load<T>(f.moves + d.row + l) * load<T>(f.moves + d.column + l);
      Lanes<T> m[9];
      if (d.symmetric()) {
        constexpr int kEntry[9] = {0, 1, 2, 1, 3, 4, 2, 4, 5};
        for (int e = 0; e < 9; ++e) m[e] = moves * load<T>(from + kEntry[e] * stride);
      } else {
        for (int e = 0; e < 9; ++e) m[e] = moves * load<T>(from + e * stride);
      }
      const V3<Lanes<T>> arm_a = loadAt(f.arm, d.row + l), arm_b = loadAt(f.arm, d.column + l);
      // Rows of A B_b: of the block, and of its product with the turn.
      Lanes<T> wide[3][6];
      for (int r = 0; r < 3; ++r) {
        const V3<Lanes<T>> row{m[3 * r], m[3 * r + 1], m[3 * r + 2]}, turn = cross<T>(arm_b, row);
        wide[r][0] = row.x, wide[r][1] = row.y, wide[r][2] = row.z;
        wide[r][3] = turn.x, wide[r][4] = turn.y, wide[r][5] = turn.z;
      }
#pragma GCC unroll 6
      for (int c = 0; c < 6; ++c) {
        const V3<Lanes<T>> column{wide[0][c], wide[1][c], wide[2][c]}, turn = cross<T>(arm_a, column);
        six[c] += column.x, six[6 + c] += column.y, six[12 + c] += column.z;
        six[18 + c] += turn.x, six[24 + c] += turn.y, six[30 + c] += turn.z;
      }
    }
    for (int e = 0; e < kEntries; ++e) store<T>(sums + e * stride + l, six[e]);
  }
}

// sums: of one group of columns, forces and torques by layer.
template <class T>
HAIRMESH_INLINE void gather(std::span<const int> columns, const ColumnLayout& layout, const Fields<T>& f,
                            const ColumnField<T>& r, T* sums) {
  const int stride = layout.stride;
  for (const int column : columns) {
    for (int l = 0; l < stride; l += kLanes) {
      const int at = layout.first(column) + l;
      const V3<Lanes<T>> force = loadAt(r, at), torque = cross<T>(loadAt(f.arm, at), force);
      const Lanes<T> moves = load<T>(f.moves + at);
      const Lanes<T> six[6] = {moves * force.x, moves * force.y, moves * force.z, torque.x, torque.y, torque.z};
      for (int k = 0; k < 6; ++k) addTo<T>(sums + k * stride + l, six[k]);
    }
  }
}

// z += what the motions of the group's patches, by layer, make of its columns.
template <class T>
HAIRMESH_INLINE void scatter(std::span<const int> columns, const ColumnLayout& layout, const Fields<T>& f,
                             const T* motion, ColumnField<T>& z) {
  const int stride = layout.stride;
  for (const int column : columns) {
    for (int l = 0; l < stride; l += kLanes) {
      const int at = layout.first(column) + l;
      Lanes<T> six[6];
      for (int k = 0; k < 6; ++k) six[k] = load<T>(motion + k * stride + l);
      const V3<Lanes<T>> turned = cross<T>({six[3], six[4], six[5]}, loadAt(f.arm, at));
      const Lanes<T> moves = load<T>(f.moves + at);
      addAt<T>(z, at, {moves * six[0] + turned.x, moves * six[1] + turned.y, moves * six[2] + turned.z});
    }
  }
}

#define HAIRMESH_KERNELS(T)                                                                                     \
  HAIRMESH_CLONES void runProject(std::span<const BlockDiagonal> diagonals, std::span<const int> which,         \
                                  const T* values, std::ptrdiff_t stride, const Fields<T>& f, T* sums) {        \
    project<T>(diagonals, which, values, stride, f, sums);                                                      \
  }                                                                                                             \
  HAIRMESH_CLONES void runGather(std::span<const int> columns, const ColumnLayout& layout, const Fields<T>& f,  \
                                 const ColumnField<T>& r, T* sums) {                                            \
    gather<T>(columns, layout, f, r, sums);                                                                     \
  }                                                                                                             \
  HAIRMESH_CLONES void runScatter(std::span<const int> columns, const ColumnLayout& layout, const Fields<T>& f, \
                                  const T* motion, ColumnField<T>& z) {                                         \
    scatter<T>(columns, layout, f, motion, z);                                                                  \
  }
HAIRMESH_KERNELS(float)
HAIRMESH_KERNELS(double)
#undef HAIRMESH_KERNELS

}  // namespace

template <class T>
CoarseSpace<T>::CoarseSpace(const HairMesh& mesh, const ColumnLayout& layout, const ColumnPattern& pattern)
    : mesh_(&mesh),
      layout_(&layout),
      pattern_(&pattern),
      arm_(layout),
      moves_(layout.size()),
      sums_(static_cast<std::size_t>(kEntries) * layout.stride),
      held_(mesh.vertexCount()) {
  formGroups();
  couplePatches();
  motion_.resize(2 * patches());
}

// Columns into groups, and the layers of a group into patches.
template <class T>
void CoarseSpace<T>::formGroups() {
  std::vector<std::vector<int>> neighbours(layout_->columns);
  for (const BlockDiagonal& d : pattern_->diagonals) {
    if (d.a == d.b || d.offset != 0) continue;
    neighbours[d.a].push_back(d.b);
    neighbours[d.b].push_back(d.a);
  }
  int groups = 0;
  group_of_ = groupColumns(layout_->columns, neighbours, groups);
  group_first_.push_back(0);
  for (int g = 0; g < groups; ++g) {
    int longest = 0;
    for (int c = 0; c < layout_->columns; ++c) {
      if (group_of_[c] != g) continue;
      grouped_.push_back(c);
      longest = std::max(longest, layout_->length[c]);
    }
    group_first_.push_back(static_cast<int>(grouped_.size()));
    patch_first_.push_back(patch_first_.back() + (std::max(longest - 1, 0) + kLayers - 1) / kLayers);
  }
}

// The classes of block diagonals, the pairs of patches that each couples, and the envelope of these pairs.
template <class T>
void CoarseSpace<T>::couplePatches() {
  std::map<std::array<int, 4>, std::vector<int>> by_class;
  for (std::size_t k = 0; k < pattern_->diagonals.size(); ++k) {
    const BlockDiagonal& d = pattern_->diagonals[k];
    by_class[{group_of_[d.a], group_of_[d.b], d.offset, d.symmetric()}].push_back(static_cast<int>(k));
  }
  std::vector<int> first(6 * patches());
  for (int row = 0; row < 6 * patches(); ++row) first[row] = row / 6 * 6;
  for (const auto& [key, members] : by_class) {
    Class one{static_cast<int>(diagonals_.size()), 0, static_cast<int>(targets_.size()), 0, key[3] != 0};
    diagonals_.insert(diagonals_.end(), members.begin(), members.end());
    const auto patch = [&](int group, int layer) {
      const int at = patch_first_[group] + (layer - 1) / kLayers;
      return layer >= 1 && at < patch_first_[group + 1] ? at : -1;
    };
    for (int l = 0; l < layout_->stride; ++l) {
      const int p = patch(key[0], l), q = patch(key[1], l + key[2]);
      if (p < 0 || q < 0) continue;
      const int row = std::max(p, q), column = std::min(p, q);
      if (static_cast<int>(targets_.size()) > one.target_first && targets_.back().row == row &&
          targets_.back().column == column && targets_.back().turned == (p < q) && targets_.back().last == l - 1) {
        targets_.back().last = l;
        continue;
      }
      targets_.push_back({l, l, row, column, p < q});
      for (int k = 6 * row; k < 6 * row + 6; ++k) first[k] = std::min(first[k], 6 * column);
    }
    one.diagonal_end = static_cast<int>(diagonals_.size());
    one.target_end = static_cast<int>(targets_.size());
    if (one.target_end > one.target_first) classes_.push_back(one);
  }
  factor_.analyze(first);
}

template <class T>
void CoarseSpace<T>::setArms(std::span<const V3<T>> x, std::span<const VertexConstraint> constraints) {
  std::fill(held_.begin(), held_.end(), 0);
  for (const VertexConstraint& c : constraints) held_[c.vertex] = 1;
  std::fill(motion_.begin(), motion_.end(), V3<T>{});  // sums of positions, and in the turn's place their number
  const auto eachMoving = [&](auto&& visit) {
    for (std::size_t i = 0; i < x.size(); ++i) {
      const int v = static_cast<int>(i), layer = mesh_->layer_of[v];
      if (layer > 0 && !held_[v]) visit(v, patchOf(mesh_->column_of[v], layer), layout_->slot[v]);
    }
  };
  eachMoving([&](int v, int patch, int) {
    motion_[2 * patch] += x[v];
    motion_[2 * patch + 1].x += 1;
  });
  arm_.setZero();
  std::fill(moves_.begin(), moves_.end(), T(0));
  eachMoving([&](int v, int patch, int slot) {
    const V3<T> arm = x[v] - (T(1) / motion_[2 * patch + 1].x) * motion_[2 * patch];
    arm_.x[slot] = arm.x, arm_.y[slot] = arm.y, arm_.z[slot] = arm.z;
    moves_[slot] = 1;
  });
}

// The sums over a class's lanes into the blocks of the patches.
template <class T>
void CoarseSpace<T>::addSums(const Class& one) {
  const int stride = layout_->stride;
  for (int k = one.target_first; k < one.target_end; ++k) {
    const Target& t = targets_[k];
    T six[kEntries];
    for (int e = 0; e < kEntries; ++e) {
      T sum = 0;
      for (int l = t.first; l <= t.last; ++l) sum += sums_[static_cast<std::size_t>(e) * stride + l];
      six[e] = sum;
    }
    const bool within = t.row == t.column;
    const auto add = [&](bool turned) {
      for (int r = 0; r < 6; ++r) {
        for (int c = 0; c < (within ? r + 1 : 6); ++c)
          factor_.at(6 * t.row + r, 6 * t.column + c) += six[turned ? 6 * c + r : 6 * r + c];
      }
    };
    add(t.turned);
    // Within a patch, blocks off the matrix's diagonal stand for their transposes as well.
    if (within && !one.symmetric) add(!t.turned);
  }
}

template <class T>
bool CoarseSpace<T>::factor() {
  for (int row = 0; row < 6 * patches(); row += 3) {
    const auto diagonal = [&](int k) -> T& { return factor_.at(row + k, row + k); };
    const T largest = std::max({diagonal(0), diagonal(1), diagonal(2)});
    for (int k = 0; k < 3; ++k) diagonal(k) += largest > 0 ? static_cast<T>(kRaise) * largest : T(1);
  }
  return factor_.factor();
}

template <class T>
bool CoarseSpace<T>::make(const ColumnMatrix<T>& a, std::span<const V3<T>> x,
                          std::span<const VertexConstraint> constraints) {
  setArms(x, constraints);
  factor_.setZero();
  const Fields<T> fields{arm_, moves_.data()};
  for (const Class& one : classes_) {
    const auto which = std::span(diagonals_).subspan(one.diagonal_first, one.diagonal_end - one.diagonal_first);
    runProject(pattern_->diagonals, which, a.values.data(), layout_->stride, fields, sums_.data());
    addSums(one);
  }
  return factor();
}

template <class T>
int CoarseSpace<T>::unknown(std::span<const VertexConstraint> constraints) const {
  return static_cast<int>(
      std::ranges::count_if(constraints, [&](const VertexConstraint& c) { return held_[c.vertex] == 0; }));
}

template <class T>
void CoarseSpace<T>::solve(const ColumnField<T>& r) {
  const int stride = layout_->stride;
  const Fields<T> fields{arm_, moves_.data()};
  for (std::size_t g = 0; g + 1 < group_first_.size(); ++g) {
    std::fill_n(sums_.begin(), 6 * stride, T(0));
    runGather(std::span(grouped_).subspan(group_first_[g], group_first_[g + 1] - group_first_[g]), *layout_, fields, r,
              sums_.data());
    for (int p = patch_first_[g]; p < patch_first_[g + 1]; ++p) {
      const int first = (p - patch_first_[g]) * kLayers + 1, last = std::min(first + kLayers, stride);
      V3<T> force{}, torque{};
      for (int l = first; l < last; ++l) {
        const T* at = sums_.data() + l;
        force += V3<T>{at[0], at[stride], at[2 * stride]};
        torque += V3<T>{at[3 * stride], at[4 * stride], at[5 * stride]};
      }
      motion_[2 * p] = force, motion_[2 * p + 1] = torque;
    }
  }
  if (!motion_.empty()) factor_.solve(&motion_[0].x);
}

template <class T>
void CoarseSpace<T>::add(ColumnField<T>& z) {
  const int stride = layout_->stride;
  const Fields<T> fields{arm_, moves_.data()};
  for (std::size_t g = 0; g + 1 < group_first_.size(); ++g) {
    std::fill_n(sums_.begin(), 6 * stride, T(0));
    for (int p = patch_first_[g]; p < patch_first_[g + 1]; ++p) {
      const int first = (p - patch_first_[g]) * kLayers + 1, last = std::min(first + kLayers, stride);
      const V3<T>&shift = motion_[2 * p], &turn = motion_[2 * p + 1];
      for (int l = first; l < last; ++l) {
        T* at = sums_.data() + l;
        at[0] = shift.x, at[stride] = shift.y, at[2 * stride] = shift.z;
        at[3 * stride] = turn.x, at[4 * stride] = turn.y, at[5 * stride] = turn.z;
      }
    }
    runScatter(std::span(grouped_).subspan(group_first_[g], group_first_[g + 1] - group_first_[g]), *layout_, fields,
               sums_.data(), z);
  }
}

template class CoarseSpace<float>;
template class CoarseSpace<double>;

}  // namespace sim
