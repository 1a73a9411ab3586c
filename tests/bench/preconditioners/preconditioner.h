// Preconditioners of the Modified PCG, chosen by name at run time.
#pragma once

#include <algorithm>
#include <optional>
#include <span>
#include <vector>

#include "sim/contact/contact.h"
#include "sim/linear/block_cholesky.h"
#include "sim/linear/block_matrix.h"
#include "sim/linear/column_matrix.h"
#include "sim/linear/contact_response.h"
#include "sim/linear/incomplete_cholesky.h"
#include "sim/linear/rest_factor.h"
#include "sim/linear/rotation.h"
#include "sim/linear/two_level.h"
#include "sim/sim_params.h"

namespace sim {

// An approximate inverse P of the system matrix, symmetric and positive definite.
//
//   paper, block-jacobi   3x3 diagonal blocks
//   diagonal              scalar diagonal
//   column                block-tridiagonal factor of each column
//   incomplete            incomplete Cholesky factor without fill, in 3x3 blocks
//   two-level             factors of the current matrix's layers and columns, without what constraints remove, and of
//                         its projection onto rigid motions of patches (two_level.h)
//   warped                factor of the rest shape's matrix, residuals turned into the rest frame and back by each
//                         vertex's own rotation: P = R (A_rest)^-1 R^T
//   direct                factor of the current matrix
template <class T>
struct Preconditioner {
  explicit Preconditioner(const HairMesh& mesh, const BlockPattern& pattern);

  // Refreshes what follows the current matrix. Falls back to 3x3 blocks when a factorization fails.
  // `constraints`: those that `two-level` is to know of; its P stays symmetric and positive whatever the filter is.
  void update(const BlockMatrix<T>& a, Solver solver, std::span<const VertexConstraint> constraints = {});
  // `keep`: of what `two-level` made last.
  using Keep = typename TwoLevel<T>::Keep;
  void update(const ColumnMatrix<T>& a, Solver solver, Keep keep = {},
              std::span<const VertexConstraint> constraints = {});
  // What `warped` needs: the factor of the rest shape's matrix (rarely), and the rotations (every step).
  // `compact`: keep the factor in 16 bits for the solves (single precision only).
  bool setRestMatrix(const BlockMatrix<T>& rest, bool compact = false);
  bool setRestMatrix(const ColumnMatrix<T>& rest, bool compact = false);
  void updateRotations(std::span<const V3<T>> x);
  // What `two-level` needs: the positions (m, relative to any point) that the matrix is of; the rest shape's at first.
  void setPositions(std::span<const V3<T>> x) { std::copy(x.begin(), x.end(), positions_.begin()); }

  // The rest factor made anew off the critical path, where there is one: begin takes the matrix, each continue works
  // for one `slices`-th of a factorization and answers whether the new factor has just taken the old one's place.
  void beginRestMatrix(const ColumnMatrix<T>& rest);
  bool continueRestMatrix(int slices, std::span<const VertexConstraint> lasting);
  bool restMatrixPending() const { return making_.stage != RestFactorInMaking<T>::Stage::kIdle; }

  // The constraints of the solves to come. `warped` and `direct`, whose P knows nothing of them, correct it with what
  // their factor answers at the constrained vertices (contact_response.h), without which a few contacts cost tens of
  // iterations; at most `batches` batches of answers are computed anew. Returns whether all constraints are met by P.
  bool setConstraints(std::span<const VertexConstraint> constraints, int batches = 1 << 20);

  // z = P r.
  void apply(std::span<const V3<T>> r, std::span<V3<T>> z);

  Solver kind() const { return kind_; }
  // Blocks of the rest factor, counted in 16 bits an entry, over those of the matrix.
  double restFactorRatio() const;
  bool restFactorFine() const { return rest_.fine; }

 private:
  const HairMesh* mesh_;
  const BlockPattern* pattern_;
  Solver kind_ = Solver::kBlockJacobi;
  std::vector<M3<T>> inverse_diagonal_;  // per block row: scalar diagonals or 3x3 inverses
  std::vector<V3<T>> turned_, positions_;
  VertexRotations<T> rotations_;
  RestFactor<T> rest_;  // where it is not fine, 3x3 blocks stand in for `warped`
  RestFactorInMaking<T> making_;
  std::optional<TwoLevel<T>> two_level_;
  std::optional<BlockCholesky<T>> direct_factor_, column_factor_;
  std::optional<IncompleteCholesky<T>> incomplete_factor_;
  std::optional<BlockPattern> column_pattern_;
  std::optional<BlockMatrix<T>> column_matrix_;
  std::vector<int> column_block_;    // pattern block of each block of column_pattern_
  std::vector<unsigned char> free_;  // not a root

  ContactResponses<T> direct_responses_;
  std::optional<BlockMatrix<T>> blocks_;  // a matrix given in column layout, for the factorizations

  bool factorColumns(const BlockMatrix<T>& a);
  const BlockMatrix<T>& toBlocks(const ColumnMatrix<T>& a);
  void setDiagonal(int i, const M3<T>& d);
  TwoLevel<T>& twoLevel();
};

// Inverse of a symmetric positive definite 3x3 block; a singular block gives the inverse of its diagonal.
template <class T>
M3<T> inverse(const M3<T>& a);

}  // namespace sim
