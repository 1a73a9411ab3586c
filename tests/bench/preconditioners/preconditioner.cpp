#include "tests/bench/preconditioners/preconditioner.h"

#include <algorithm>

#include "sim/linear/block_jacobi.h"
#include "sim/linear/elimination_order.h"

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

template <class T>
bool Preconditioner<T>::factorColumns(const BlockMatrix<T>& a) {
  if (!used_) {
    std::vector<std::pair<int, int>> pairs;
    for (int c = 0; c < mesh_->columnCount(); ++c) {
      const int first = mesh_->shape.column_first[c], length = mesh_->shape.columnLength(c);
      for (int l = 0; l < length; ++l) {
        for (int step = 1; step <= 2 && l + step < length; ++step) pairs.emplace_back(first + l, first + l + step);
      }
    }
    factor_pattern_ = sim::makePattern(pattern_->size, std::move(pairs));
    used_.emplace(&factor_pattern_);
    factor_.analyze(factor_pattern_, sim::minimumDegreeOrder(factor_pattern_, free_));
  }
  used_->diagonal = a.diagonal;
  for (int i = 0; i < factor_pattern_.size; ++i) {
    for (int k = factor_pattern_.row_first[i]; k < factor_pattern_.row_first[i + 1]; ++k) {
      const int block = pattern_->find(i, factor_pattern_.columns[k]);
      used_->lower[k] = block < 0 ? M3<T>{} : a.lower[block];
    }
  }
  return factor_.factor(*used_);
}

// S A S + (I - S) trace A_ii: the removed directions stand alone and keep their size.
template <class T>
bool Preconditioner<T>::factorWhole(const BlockMatrix<T>& a, std::span<const sim::VertexConstraint> constraints) {
  if (!used_) {
    used_.emplace(pattern_);
    factor_.analyze(*pattern_, sim::minimumDegreeOrder(*pattern_, free_));
  }
  *used_ = a;
  std::vector<M3<T>> keep(pattern_->size, M3<T>{1, 0, 0, 0, 1, 0, 0, 0, 1});
  for (const sim::VertexConstraint& constraint : constraints) {
    for (int k = 0; k < 9; ++k) keep[constraint.vertex].m[k] = static_cast<T>(constraint.keep(k / 3, k % 3));
  }
  for (int i = 0; i < pattern_->size; ++i) {
    M3<T>& d = used_->diagonal[i];
    const T trace = d.m[0] + d.m[4] + d.m[8];
    d = times(times(keep[i], d), keep[i]);
    for (int k = 0; k < 9; ++k) d.m[k] += trace * (T(k % 4 == 0) - keep[i].m[k]);
    for (int k = pattern_->row_first[i]; k < pattern_->row_first[i + 1]; ++k)
      used_->lower[k] = times(times(keep[i], used_->lower[k]), keep[pattern_->columns[k]]);
  }
  return factor_.factor(*used_);
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
                    : kind_ == Kind::kColumn     ? factorColumns(a)
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
    a.toBlocks(*mesh_, blocks);
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
    case Kind::kColumn:
      return factor_.solve(r, z);
    case Kind::kIncomplete:
      return incomplete_->solve(r, z);
    default:
      for (std::size_t i = 0; i < inverse_diagonal_.size(); ++i) z[i] = inverse_diagonal_[i] * r[i];
  }
}

template class Preconditioner<float>;
template class Preconditioner<double>;

}  // namespace bench
