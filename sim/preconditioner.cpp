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
int Preconditioner<T>::findOrAddResponse(int vertex, const V3<T>& direction) {
  for (int k = 0; k < response_count_; ++k) {
    if (responses_[k].vertex == vertex && dot(responses_[k].direction, direction) > T(1 - 1e-5)) return k;
  }
  if (response_count_ == kMostCorrected) return -1;
  if (response_count_ == static_cast<int>(responses_.size())) responses_.emplace_back();
  responses_[response_count_].vertex = vertex;
  responses_[response_count_].direction = direction;
  responses_[response_count_].column.resize(turned_.size());
  return response_count_++;
}

// The columns from `first` on, as many at once as a batch holds.
template <class T>
void Preconditioner<T>::computeResponses(int first) {
  constexpr int kSides = BlockCholesky<T>::kBatch;
  const bool warped = kind_ == Solver::kWarped;
  BlockCholesky<T>& factor = warped ? rest_factor_ : *direct_factor_;
  batch_.resize(3 * factor.order.size() * kSides);
  for (; first < response_count_; first += kSides) {
    const int last = std::min(first + kSides, response_count_);
    std::fill(batch_.begin(), batch_.end(), T(0));
    touched_.clear();
    for (int k = first; k < last; ++k) {
      const Response& response = responses_[k];
      const int position = factor.position[response.vertex];
      const V3<T> d =
          warped ? transposeTimes(rotations_.matrices[response.vertex], response.direction) : response.direction;
      T* at = batch_.data() + 3 * static_cast<std::size_t>(position) * kSides + (k - first);
      at[0] = d.x, at[kSides] = d.y, at[2 * kSides] = d.z;
      touched_.push_back(position);
    }
    factor.solveBatch(batch_, touched_);
    for (std::size_t i = 0; i < turned_.size(); ++i) {
      const int position = factor.position[i];
      for (int k = first; k < last; ++k) {
        V3<T>& z = responses_[k].column[i];
        z = {0, 0, 0};
        if (position < 0) continue;
        const T* at = batch_.data() + 3 * static_cast<std::size_t>(position) * kSides + (k - first);
        z = {at[0], at[kSides], at[2 * kSides]};
        if (warped) z = rotations_.matrices[i] * z;
      }
    }
  }
}

template <class T>
void Preconditioner<T>::setConstraints(std::span<const VertexConstraint> constraints) {
  removed_.clear();
  if (kind_ != Solver::kWarped && kind_ != Solver::kDirect) return;
  const int known = response_count_;
  for (const VertexConstraint& constraint : constraints) {
    for (int k = 0; k < constraint.removed; ++k) {
      const Vec3& d = constraint.directions[k];
      const int response =
          findOrAddResponse(constraint.vertex, {static_cast<T>(d.x()), static_cast<T>(d.y()), static_cast<T>(d.z())});
      if (response >= 0) removed_.push_back(response);
    }
  }
  const int count = static_cast<int>(removed_.size());
  if (count == 0) return;
  computeResponses(known);
  gram_.resize(count, count);
  for (int i = 0; i < count; ++i) {
    const Response& row = responses_[removed_[i]];
    for (int j = 0; j <= i; ++j) {
      gram_(i, j) = gram_(j, i) = static_cast<double>(dot(row.direction, responses_[removed_[j]].column[row.vertex]));
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
  for (std::size_t k = 0; k < removed_.size(); ++k) {
    multipliers_[k] = dot(responses_[removed_[k]].direction, z[responses_[removed_[k]].vertex]);
  }
  gram_factor_.solveInPlace(multipliers_);
  for (std::size_t k = 0; k < removed_.size(); ++k) {
    const T m = static_cast<T>(multipliers_[k]);
    const std::vector<V3<T>>& column = responses_[removed_[k]].column;
    for (std::size_t i = 0; i < z.size(); ++i) z[i] -= m * column[i];
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
