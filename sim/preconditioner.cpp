#include "sim/preconditioner.h"

#include <algorithm>

#include "sim/elimination_order.h"

namespace sim {

template <class T>
M3<T> inverse(const M3<T>& a) {
  const T* m = a.m;
  const T c0 = m[4] * m[8] - m[5] * m[7], c1 = m[5] * m[6] - m[3] * m[8], c2 = m[3] * m[7] - m[4] * m[6];
  const T det = m[0] * c0 + m[1] * c1 + m[2] * c2;
  const T scale = m[0] + m[4] + m[8];
  if (!(det > T(1e-9) * scale * scale * scale)) {
    return {T(1) / m[0], 0, 0, 0, T(1) / m[4], 0, 0, 0, T(1) / m[8]};
  }
  const T s = T(1) / det;
  return {s * c0, s * (m[2] * m[7] - m[1] * m[8]), s * (m[1] * m[5] - m[2] * m[4]),
          s * c1, s * (m[0] * m[8] - m[2] * m[6]), s * (m[2] * m[3] - m[0] * m[5]),
          s * c2, s * (m[1] * m[6] - m[0] * m[7]), s * (m[0] * m[4] - m[1] * m[3])};
}

template <class T>
Preconditioner<T>::Preconditioner(const HairMesh& mesh, const BlockPattern& pattern)
    : mesh_(&mesh), pattern_(&pattern), rotations_(mesh) {
  free_.resize(mesh.vertexCount());
  for (int i = 0; i < mesh.vertexCount(); ++i) free_[i] = !mesh.isRoot(i);
  inverse_diagonal_.resize(mesh.vertexCount());
  turned_.resize(mesh.vertexCount());
  responses_.reserve(kMostCorrected);
}

template <class T>
bool Preconditioner<T>::factorColumns(const BlockMatrix<T>& a) {
  if (!column_factor_) {
    std::vector<std::pair<int, int>> pairs;
    for (int c = 0; c < mesh_->columnCount(); ++c) {
      const int first = mesh_->shape.column_first[c], length = mesh_->shape.columnLength(c);
      for (int l = 0; l < length; ++l) {
        for (int step = 1; step <= 2 && l + step < length; ++step) pairs.emplace_back(first + l, first + l + step);
      }
    }
    column_pattern_ = makePattern(pattern_->size, std::move(pairs));
    column_matrix_.emplace(&*column_pattern_);
    for (int i = 0; i < pattern_->size; ++i) {
      for (int k = column_pattern_->row_first[i]; k < column_pattern_->row_first[i + 1]; ++k) {
        column_block_.push_back(pattern_->find(i, column_pattern_->columns[k]));
      }
    }
    column_factor_.emplace();
    column_factor_->analyze(*column_pattern_, minimumDegreeOrder(*column_pattern_, free_));
  }
  column_matrix_->diagonal = a.diagonal;
  for (std::size_t k = 0; k < column_block_.size(); ++k) {
    column_matrix_->lower[k] = column_block_[k] < 0 ? M3<T>{} : a.lower[column_block_[k]];
  }
  return column_factor_->factor(*column_matrix_);
}

template <class T>
bool Preconditioner<T>::setRestMatrix(const BlockMatrix<T>& rest) {
  if (rest_factor_.order.empty()) {
    rest_factor_.analyze(*mesh_, *pattern_, free_);
  }
  rest_factor_fine_ = rest_factor_.factor(rest);
  return rest_factor_fine_;
}

template <class T>
void Preconditioner<T>::updateRotations(std::span<const V3<T>> x) {
  rotations_.update(x);
  response_count_ = 0;
}

template <class T>
void Preconditioner<T>::update(const BlockMatrix<T>& a, Solver solver) {
  kind_ = solver;
  removed_.clear();
  response_count_ = 0;
  if (solver == Solver::kWarped) return;
  if (solver == Solver::kDirect) {
    if (!direct_factor_) {
      direct_factor_.emplace();
      direct_factor_->analyze(*mesh_, *pattern_, free_);
    }
    if (direct_factor_->factor(a)) return;
    kind_ = Solver::kBlockJacobi;
  }
  if (solver == Solver::kColumn) {
    if (factorColumns(a)) return;
    kind_ = Solver::kBlockJacobi;
  }
  for (std::size_t i = 0; i < a.diagonal.size(); ++i) setDiagonal(static_cast<int>(i), a.diagonal[i]);
}

template <class T>
void Preconditioner<T>::setDiagonal(int i, const M3<T>& d) {
  inverse_diagonal_[i] =
      kind_ == Solver::kDiagonal ? M3<T>{T(1) / d.m[0], 0, 0, 0, T(1) / d.m[4], 0, 0, 0, T(1) / d.m[8]} : inverse(d);
}

template <class T>
const BlockMatrix<T>& Preconditioner<T>::toBlocks(const ColumnMatrix<T>& a) {
  if (!blocks_) blocks_.emplace(pattern_);
  a.toBlocks(*mesh_, *blocks_);
  return *blocks_;
}

template <class T>
bool Preconditioner<T>::setRestMatrix(const ColumnMatrix<T>& rest) {
  return setRestMatrix(toBlocks(rest));
}

template <class T>
void Preconditioner<T>::update(const ColumnMatrix<T>& a, Solver solver) {
  if (solver == Solver::kWarped && !rest_factor_fine_) solver = Solver::kBlockJacobi;
  kind_ = solver;
  removed_.clear();
  response_count_ = 0;
  if (solver == Solver::kWarped) return;
  if (solver == Solver::kDirect || solver == Solver::kColumn) return update(toBlocks(a), solver);
  for (int i = 0; i < mesh_->vertexCount(); ++i) setDiagonal(i, a.diagonalBlock(i));
}

template <class T>
int Preconditioner<T>::knownResponse(int vertex) const {
  for (int k = 0; k < response_count_; ++k) {
    if (responses_[k].vertex == vertex) return k;
  }
  return -1;
}

// Responses of the constrained vertices that have none yet, as many axes at once as a batch holds.
template <class T>
void Preconditioner<T>::computeResponses(std::span<const VertexConstraint> constraints) {
  constexpr int kSides = BlockCholesky<T>::kBatch, kTogether = kSides / 3;
  BlockCholesky<T>& factor = kind_ == Solver::kWarped ? rest_factor_ : *direct_factor_;
  const bool warped = kind_ == Solver::kWarped;
  const std::size_t n = turned_.size();
  batch_.resize(3 * factor.order.size() * kSides);
  std::size_t next = 0;
  while (next < constraints.size() && response_count_ < kMostCorrected) {
    const int first = response_count_;
    for (; next < constraints.size() && response_count_ < std::min(first + kTogether, kMostCorrected); ++next) {
      if (knownResponse(constraints[next].vertex) >= 0) continue;
      if (response_count_ == static_cast<int>(responses_.size())) responses_.emplace_back();
      Response& response = responses_[response_count_++];
      response.vertex = constraints[next].vertex;
      for (auto& column : response.columns) column.resize(n);
    }
    if (response_count_ == first) break;
    std::fill(batch_.begin(), batch_.end(), T(0));
    for (int k = first; k < response_count_; ++k) {
      const int v = responses_[k].vertex;
      for (int axis = 0; axis < 3; ++axis) {
        // R^T times the axis is a row of R.
        for (int row = 0; row < 3; ++row) {
          const T value = warped ? rotations_.matrices[v].m[3 * axis + row] : T(axis == row);
          batch_[(3 * static_cast<std::size_t>(factor.position[v]) + row) * kSides + 3 * (k - first) + axis] = value;
        }
      }
    }
    factor.solveBatch(batch_);
    for (std::size_t i = 0; i < n; ++i) {
      const int position = factor.position[i];
      for (int k = first; k < response_count_; ++k) {
        for (int axis = 0; axis < 3; ++axis) {
          V3<T>& z = responses_[k].columns[axis][i];
          z = {0, 0, 0};
          if (position < 0) continue;
          const T* at = batch_.data() + 3 * static_cast<std::size_t>(position) * kSides + 3 * (k - first) + axis;
          z = {at[0], at[kSides], at[2 * kSides]};
          if (warped) z = rotations_.matrices[i] * z;
        }
      }
    }
  }
}

template <class T>
void Preconditioner<T>::setConstraints(std::span<const VertexConstraint> constraints) {
  removed_.clear();
  if (kind_ != Solver::kWarped && kind_ != Solver::kDirect) return;
  computeResponses(constraints);
  for (const VertexConstraint& constraint : constraints) {
    const int response = knownResponse(constraint.vertex);
    if (response < 0) break;
    for (int k = 0; k < constraint.removed; ++k) {
      const Vec3& d = constraint.directions[k];
      removed_.push_back(
          {constraint.vertex, response, {static_cast<T>(d.x()), static_cast<T>(d.y()), static_cast<T>(d.z())}});
    }
  }
  const int count = static_cast<int>(removed_.size());
  if (count == 0) return;
  gram_.resize(count, count);
  for (int i = 0; i < count; ++i) {
    for (int j = 0; j <= i; ++j) {
      const Removed& n = removed_[j];
      const auto& columns = responses_[n.response].columns;
      const int at = removed_[i].vertex;
      const V3<T> moved =
          n.direction.x * columns[0][at] + n.direction.y * columns[1][at] + n.direction.z * columns[2][at];
      gram_(i, j) = gram_(j, i) = static_cast<double>(dot(removed_[i].direction, moved));
    }
  }
  gram_factor_.compute(gram_);
  if (gram_factor_.info() != Eigen::Success) removed_.clear();  // the filter alone serves
}

template <class T>
void Preconditioner<T>::apply(std::span<const V3<T>> r, std::span<V3<T>> z) {
  applyUnconstrained(r, z);
  if (removed_.empty()) return;
  multipliers_.resize(static_cast<Eigen::Index>(removed_.size()));
  for (std::size_t k = 0; k < removed_.size(); ++k) multipliers_[k] = dot(removed_[k].direction, z[removed_[k].vertex]);
  gram_factor_.solveInPlace(multipliers_);
  for (std::size_t k = 0; k < removed_.size(); ++k) {
    const T m = static_cast<T>(multipliers_[k]);
    const V3<T> d = m * removed_[k].direction;
    const auto& columns = responses_[removed_[k].response].columns;
    for (std::size_t i = 0; i < z.size(); ++i) z[i] -= d.x * columns[0][i] + d.y * columns[1][i] + d.z * columns[2][i];
  }
}

template <class T>
void Preconditioner<T>::applyUnconstrained(std::span<const V3<T>> r, std::span<V3<T>> z) {
  switch (kind_) {
    case Solver::kWarped:
      for (std::size_t i = 0; i < turned_.size(); ++i) turned_[i] = transposeTimes(rotations_.matrices[i], r[i]);
      rest_factor_.solve(turned_, z);
      for (std::size_t i = 0; i < turned_.size(); ++i) z[i] = rotations_.matrices[i] * z[i];
      return;
    case Solver::kDirect:
      direct_factor_->solve(r, z);
      return;
    case Solver::kColumn:
      column_factor_->solve(r, z);
      return;
    default:
      for (std::size_t i = 0; i < inverse_diagonal_.size(); ++i) z[i] = inverse_diagonal_[i] * r[i];
  }
}

template M3<float> inverse(const M3<float>&);
template M3<double> inverse(const M3<double>&);
template struct Preconditioner<float>;
template struct Preconditioner<double>;

}  // namespace sim
