#include "tests/bench/preconditioners/preconditioner.h"

#include <algorithm>

#include "sim/linear/block_jacobi.h"

namespace bench {

using sim::BlockMatrix;
using sim::M3;
using sim::V3;

namespace {

template <class T>
M3<T> times(const M3<T>& a, const M3<T>& b) {
  M3<T> c{};
  for (int k = 0; k < 27; ++k) c.m[k / 9 * 3 + k % 3] += a.m[k / 9 * 3 + k / 3 % 3] * b.m[k / 3 % 3 * 3 + k % 3];
  return c;
}

template <class T>
void convert(const BlockMatrix<T>& a, sim::ColumnMatrix<T>& to) {
  to.setZero();
  for (int i = 0; i < a.pattern->size; ++i) {
    to.addBlock(i, i, a.diagonal[i]);
    for (int k = a.pattern->row_first[i]; k < a.pattern->row_first[i + 1]; ++k)
      to.addBlock(i, a.pattern->columns[k], a.lower[k]);
  }
}

}  // namespace

const char* nameOf(Kind kind) {
  constexpr const char* kNames[] = {"diagonal", "block-jacobi", "column", "incomplete", "two-level", "direct"};
  static_assert(std::size(kNames) == static_cast<int>(Kind::kCount));
  return kNames[static_cast<int>(kind)];
}

template <class T>
Preconditioner<T>::Preconditioner(const sim::HairMesh& mesh, const sim::BlockPattern& pattern, Kind kind)
    : mesh_(&mesh),
      pattern_(&pattern),
      asked_(kind),
      kind_(kind),
      layout_(mesh),
      columns_(mesh, layout_),
      inverse_diagonal_(mesh.vertexCount()),
      free_(mesh.vertexCount()) {
  for (int i = 0; i < mesh.vertexCount(); ++i) free_[i] = !mesh.isRoot(i);
}

// Of all blocks, or of those within columns alone.
template <class T>
bool Preconditioner<T>::factorFree(const BlockMatrix<T>& a, bool within_columns) {
  std::vector<Eigen::Triplet<T>> entries;
  const auto add = [&](int i, int j, const M3<T>& block) {
    for (int k = 0; free_[i] && free_[j] && k < 9; ++k) entries.emplace_back(3 * i + k / 3, 3 * j + k % 3, block.m[k]);
  };
  for (int i = 0; i < pattern_->size; ++i) {
    add(i, i, free_[i] ? a.diagonal[i] : M3<T>{});
    for (int k = 0; !free_[i] && k < 3; ++k) entries.emplace_back(3 * i + k, 3 * i + k, T(1));
    for (int k = pattern_->row_first[i]; k < pattern_->row_first[i + 1]; ++k) {
      const int j = pattern_->columns[k];
      if (!within_columns || mesh_->column_of[i] == mesh_->column_of[j]) add(i, j, a.lower[k]);
    }
  }
  Eigen::SparseMatrix<T> lower(3 * pattern_->size, 3 * pattern_->size);
  lower.setFromTriplets(entries.begin(), entries.end());
  factor_->compute(lower);
  return factor_->info() == Eigen::Success;
}

// S A S + (I - S) trace A_ii: the removed directions stand alone and keep their size.
template <class T>
bool Preconditioner<T>::factorWhole(const BlockMatrix<T>& a, std::span<const sim::VertexConstraint> constraints) {
  BlockMatrix<T> used = a;
  std::vector<M3<T>> keep(pattern_->size, M3<T>{1, 0, 0, 0, 1, 0, 0, 0, 1});
  for (const sim::VertexConstraint& constraint : constraints) {
    for (int k = 0; k < 9; ++k) keep[constraint.vertex].m[k] = static_cast<T>(constraint.keep(k / 3, k % 3));
  }
  for (int i = 0; i < pattern_->size; ++i) {
    M3<T>& d = used.diagonal[i];
    const T trace = d.m[0] + d.m[4] + d.m[8];
    d = times(times(keep[i], d), keep[i]);
    for (int k = 0; k < 9; ++k) d.m[k] += trace * (T(k % 4 == 0) - keep[i].m[k]);
    for (int k = pattern_->row_first[i]; k < pattern_->row_first[i + 1]; ++k)
      used.lower[k] = times(times(keep[i], used.lower[k]), keep[pattern_->columns[k]]);
  }
  return factorFree(used, false);
}

template <class T>
bool Preconditioner<T>::update(const BlockMatrix<T>& a, std::span<const V3<T>> x,
                               std::span<const sim::VertexConstraint> constraints) {
  kind_ = asked_;
  if (kind_ == Kind::kTwoLevel) {
    sim::ColumnMatrix<T> packed(layout_, columns_);
    convert(a, packed);
    return update(packed, x, constraints);
  }
  if (kind_ == Kind::kIncomplete && !incomplete_) incomplete_.emplace(*pattern_, free_);
  const bool done = kind_ == Kind::kDirect       ? factorWhole(a, constraints)
                    : kind_ == Kind::kColumn     ? factorFree(a, true)
                    : kind_ == Kind::kIncomplete ? incomplete_->factor(a)
                                                 : true;
  if (!done) kind_ = Kind::kBlockJacobi;
  for (std::size_t i = 0; i < a.diagonal.size(); ++i) {
    const M3<T>& d = a.diagonal[i];
    inverse_diagonal_[i] = kind_ == Kind::kDiagonal
                               ? M3<T>{T(1) / d.m[0], 0, 0, 0, T(1) / d.m[4], 0, 0, 0, T(1) / d.m[8]}
                               : sim::inverse(d);
  }
  return done;
}

template <class T>
bool Preconditioner<T>::update(const sim::ColumnMatrix<T>& a, std::span<const V3<T>> x,
                               std::span<const sim::VertexConstraint> constraints) {
  if (asked_ != Kind::kTwoLevel) {
    BlockMatrix<T> blocks(pattern_);
    toBlocks(*mesh_, a, blocks);
    return update(blocks, x, constraints);
  }
  if (!two_level_) two_level_.emplace(*mesh_);
  two_level_->memory.forget();
  two_level_->update(a, x, constraints);
  return true;
}

template <class T>
void Preconditioner<T>::apply(std::span<const V3<T>> r, std::span<V3<T>> z) {
  switch (kind_) {
    case Kind::kTwoLevel:
      return two_level_->apply(r, z);
    case Kind::kDirect:
    case Kind::kColumn: {
      using Vector = Eigen::Matrix<T, Eigen::Dynamic, 1>;
      const Vector solved = factor_->solve(Eigen::Map<const Vector>(&r[0].x, 3 * static_cast<Eigen::Index>(r.size())));
      for (std::size_t i = 0; i < z.size(); ++i)
        z[i] = free_[i] ? V3<T>{solved[3 * i], solved[3 * i + 1], solved[3 * i + 2]} : V3<T>{0, 0, 0};
      return;
    }
    case Kind::kIncomplete:
      return incomplete_->solve(r, z);
    default:
      for (std::size_t i = 0; i < inverse_diagonal_.size(); ++i) z[i] = inverse_diagonal_[i] * r[i];
  }
}

template <class T>
void toBlocks(const sim::HairMesh& mesh, const sim::ColumnMatrix<T>& a, BlockMatrix<T>& to) {
  const sim::ColumnLayout& layout = *a.layout;
  to.setZero();
  for (int v = 0; v < mesh.vertexCount(); ++v) to.diagonal[v] = a.diagonalBlock(v);
  for (const sim::BlockDiagonal& d : a.pattern->diagonals) {
    if (d.symmetric()) continue;
    for (int l = std::max(0, -d.offset); l < layout.length[d.a] && l + d.offset < layout.length[d.b]; ++l) {
      const int i = mesh.shape.column_first[d.a] + l, j = mesh.shape.column_first[d.b] + l + d.offset;
      const int block = to.pattern->find(std::max(i, j), std::min(i, j));
      if (block < 0) continue;
      M3<T> m;
      for (int k = 0; k < 9; ++k) m.m[i > j ? k : 3 * (k % 3) + k / 3] = a.values[d.values + k * layout.stride + l];
      to.lower[block] = m;
    }
  }
}
template void toBlocks(const sim::HairMesh&, const sim::ColumnMatrix<float>&, BlockMatrix<float>&);
template void toBlocks(const sim::HairMesh&, const sim::ColumnMatrix<double>&, BlockMatrix<double>&);

template class Preconditioner<float>;
template class Preconditioner<double>;

}  // namespace bench
