// Preconditioners of the Modified PCG beside the simulator's own, for comparisons.
#pragma once

#include <Eigen/SparseCholesky>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "sim/contact/contact.h"
#include "sim/linear/block_matrix.h"
#include "sim/linear/column_matrix.h"
#include "sim/linear/two_level.h"
#include "tests/bench/preconditioners/incomplete_cholesky.h"

namespace bench {

enum class Kind {
  kDiagonal,     // scalar diagonal
  kBlockJacobi,  // 3x3 diagonal blocks: the paper's
  kColumn,       // block-tridiagonal factor of each column
  kIncomplete,   // incomplete Cholesky factor without fill, in 3x3 blocks
  kTwoLevel,     // sim::TwoLevel: the default's
  kDirect,       // factor of the matrix itself, without the directions that constraints remove
  kCount
};
const char* nameOf(Kind kind);

// An approximate inverse P of the system matrix, symmetric and positive definite.
template <class T>
class Preconditioner {
 public:
  Preconditioner(const sim::HairMesh& mesh, const sim::BlockPattern& pattern, Kind kind);

  // Takes a matrix, the positions that it is of (m) and the constraints, known to `two-level` and `direct` alone; P
  // stays symmetric and positive whatever the filter is. False when a factorization failed: 3x3 blocks serve instead.
  bool update(const sim::BlockMatrix<T>& a, std::span<const sim::V3<T>> x,
              std::span<const sim::VertexConstraint> constraints = {});
  bool update(const sim::ColumnMatrix<T>& a, std::span<const sim::V3<T>> x,
              std::span<const sim::VertexConstraint> constraints = {});

  // z = P r.
  void apply(std::span<const sim::V3<T>> r, std::span<sim::V3<T>> z);

 private:
  const sim::HairMesh* mesh_;
  const sim::BlockPattern* pattern_;
  Kind asked_, kind_;
  sim::ColumnLayout layout_;
  sim::ColumnPattern columns_;
  std::vector<sim::M3<T>> inverse_diagonal_;  // scalar diagonals or 3x3 inverses
  std::vector<unsigned char> free_;           // not a root
  std::optional<sim::TwoLevel<T>> two_level_;
  using Factor = Eigen::SimplicialLLT<Eigen::SparseMatrix<T>>;
  std::unique_ptr<Factor> factor_ = std::make_unique<Factor>();  // of the free vertices
  std::optional<IncompleteCholesky<T>> incomplete_;

  bool factorFree(const sim::BlockMatrix<T>& a, bool within_columns);
  bool factorWhole(const sim::BlockMatrix<T>& a, std::span<const sim::VertexConstraint> constraints);
};

// The same matrix as blocks by vertex. `to` has the mesh's system pattern.
template <class T>
void toBlocks(const sim::HairMesh& mesh, const sim::ColumnMatrix<T>& a, sim::BlockMatrix<T>& to);

}  // namespace bench
