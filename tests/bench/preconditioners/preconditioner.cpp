#include "sim/linear/preconditioner.h"

#include <algorithm>

#include "sim/linear/elimination_order.h"

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
  for (const Vec3& at : mesh.shape.positions) {
    const Vec3 p = at - mesh.shape.positions[0];
    positions_.push_back({static_cast<T>(p.x()), static_cast<T>(p.y()), static_cast<T>(p.z())});
  }
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
TwoLevel<T>& Preconditioner<T>::twoLevel() {
  if (!two_level_) two_level_.emplace(*mesh_);
  return *two_level_;
}

template <class T>
bool Preconditioner<T>::setRestMatrix(const BlockMatrix<T>& rest, bool compact) {
  twoLevel();  // may stand in later, in a step that is to take no memory
  if (rest_.factor.order.empty()) rest_.factor.analyze(*mesh_, *pattern_, free_);
  making_.stage = RestFactorInMaking<T>::Stage::kIdle;
  rest_.make(rest, compact);
  return rest_.fine;
}

template <class T>
void Preconditioner<T>::beginRestMatrix(const ColumnMatrix<T>& rest) {
  if (!making_.matrix.pattern) making_.matrix = BlockMatrix<T>(pattern_);
  rest.toBlocks(*mesh_, making_.matrix);
  making_.begin(rest_);
}

template <class T>
bool Preconditioner<T>::continueRestMatrix(int slices, std::span<const VertexConstraint> lasting) {
  return making_.work(rest_.factor.factorOperations() / slices, lasting, rotations_.matrices, rest_);
}

template <class T>
void Preconditioner<T>::updateRotations(std::span<const V3<T>> x) {
  rotations_.update(x);
}

template <class T>
void Preconditioner<T>::update(const BlockMatrix<T>& a, Solver solver, std::span<const VertexConstraint> constraints) {
  kind_ = solver;
  rest_.responses.clear();
  if (solver == Solver::kWarped) return;
  if (solver == Solver::kDirect) {
    if (!direct_factor_) {
      direct_factor_.emplace();
      direct_factor_->analyze(*mesh_, *pattern_, free_);
    }
    if (direct_factor_->factor(a)) {
      direct_responses_.reset(mesh_->vertexCount());
      return;
    }
    kind_ = Solver::kBlockJacobi;
  }
  if (solver == Solver::kColumn) {
    if (factorColumns(a)) return;
    kind_ = Solver::kBlockJacobi;
  }
  if (solver == Solver::kIncomplete) {
    if (!incomplete_factor_) incomplete_factor_.emplace(*pattern_, free_);
    if (incomplete_factor_->factor(a)) return;
    kind_ = Solver::kBlockJacobi;
  }
  if (solver == Solver::kTwoLevel) return twoLevel().update(a, positions_, {}, constraints);
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
bool Preconditioner<T>::setRestMatrix(const ColumnMatrix<T>& rest, bool compact) {
  return setRestMatrix(toBlocks(rest), compact);
}

template <class T>
void Preconditioner<T>::update(const ColumnMatrix<T>& a, Solver solver, Keep keep,
                               std::span<const VertexConstraint> constraints) {
  if (solver == Solver::kWarped && !rest_.fine) solver = Solver::kTwoLevel;
  kind_ = solver;
  rest_.responses.clear();
  if (solver == Solver::kWarped) return;
  if (solver == Solver::kTwoLevel) return twoLevel().update(a, positions_, keep, constraints);
  if (solver == Solver::kDirect || solver == Solver::kColumn || solver == Solver::kIncomplete) {
    return update(toBlocks(a), solver);
  }
  for (int i = 0; i < mesh_->vertexCount(); ++i) setDiagonal(i, a.diagonalBlock(i));
}

template <class T>
bool Preconditioner<T>::setConstraints(std::span<const VertexConstraint> constraints, int batches) {
  if (kind_ == Solver::kWarped) {
    return rest_.responses.setConstraints(rest_.factor, rotations_.matrices, constraints, batches);
  }
  if (kind_ == Solver::kDirect) return direct_responses_.setConstraints(*direct_factor_, {}, constraints, batches);
  return true;
}

template <class T>
double Preconditioner<T>::restFactorRatio() const {
  constexpr double kBlockBytes = 9 * sizeof(std::int16_t);
  const double matrix = pattern_->size + pattern_->blockCount();
  const double factor = rest_.compact ? static_cast<double>(rest_.compact->bytes()) / kBlockBytes
                                      : 2.0 * static_cast<double>(rest_.factor.factorBlocks());
  return factor / matrix;
}

template <class T>
void Preconditioner<T>::apply(std::span<const V3<T>> r, std::span<V3<T>> z) {
  switch (kind_) {
    case Solver::kWarped:
      for (std::size_t i = 0; i < turned_.size(); ++i) turned_[i] = transposeTimes(rotations_.matrices[i], r[i]);
      rest_.solve(turned_, z);
      for (std::size_t i = 0; i < turned_.size(); ++i) z[i] = rotations_.matrices[i] * z[i];
      return;
    case Solver::kTwoLevel:
      two_level_->apply(r, z);
      return;
    case Solver::kDirect:
      direct_factor_->solve(r, z);
      direct_responses_.correct(z);
      return;
    case Solver::kColumn:
      column_factor_->solve(r, z);
      return;
    case Solver::kIncomplete:
      incomplete_factor_->solve(r, z);
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
