// The two-level preconditioner: P = L^-1 + s H^-1 + B C^-1 B^T, an additive Schwarz method (Dryja and Widlund 1987).
//
// L: the matrix without the couplings between layers (layer_factor.h). H: without those between columns
// (column_factor.h), weighted by s, for the diagonal is in both. Both leave out the directions that contacts remove:
// each that P does not know of adds an eigenvalue far from the others, which costs an iteration. C = B^T A B: the
// projection onto rigid motions of patches (coarse_space.h), for what many vertices do together.
//
// Each of the two parts, the factors L and H and the coarse space, serves some solves: the matrix changes little from
// one step to the next. A part serves until the iterations that its age has cost add up to what making it anew costs,
// or a number of solves.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "sim/linear/coarse_space.h"
#include "sim/linear/column_factor.h"
#include "sim/linear/column_matrix.h"
#include "sim/linear/layer_factor.h"
#include "sim/mesh/hair_memory.h"
#include "sim/mesh/hair_mesh.h"

namespace sim {

template <class T>
struct TwoLevel {
  explicit TwoLevel(const HairMesh& mesh);

  // Takes the matrix of a solve, the positions that it is of (m, one a vertex, relative to any point) and the
  // constraints. Makes those parts anew that serve no longer: old ones, the factors where other directions are held,
  // the coarse space where more than kMaxUnknown vertices are held that it does not know of.
  void update(const ColumnMatrix<T>& a, std::span<const V3<T>> x, std::span<const VertexConstraint> constraints = {},
              const MatrixTerms& terms = {});
  // Between solves of one system, when contacts have let go or stick: makes the factors anew where more than kMaxOther
  // directions, and half of those held, are held otherwise. Constraints of the vertices of update(), or some of them.
  void follow(const ColumnMatrix<T>& a, std::span<const V3<T>> x, std::span<const VertexConstraint> constraints,
              const MatrixTerms& terms);
  // Before update(), where `memory` may be another hair's than that of the last solve: makes the parts again that it
  // speaks of. `assemble` gives the matrix at positions (m) with terms.
  using Assemble = std::function<const ColumnMatrix<T>&(std::span<const V3<T>> x, const MatrixTerms& terms)>;
  void recall(const Assemble& assemble);
  // The solve with it took so many iterations.
  void count(int iterations);
  // The material is another: what `memory` speaks of is to be made again.
  void drop();

  TwoLevelMemory memory;                  // of the hair that is solved for
  int made_factors = 0, made_coarse = 0;  // so far

  // Iterations that making a part costs, and solves that it serves at most. On four walks (short low to long medium)
  // solves take within a tenth as long with twice of each.
  static constexpr double kFactorsCost = 1, kCoarseCost = 3;
  static constexpr int kFactorsServe = 4, kCoarseServes = 8;
  // s. Iterations with 0.3, 0.5 and 0.75 differ by one in twenty.
  static constexpr T kColumnWeight = T(0.5);
  static constexpr int kMaxUnknown = 2;  // with thirty a solve's iterations tripled
  static constexpr int kMaxOther = 8;    // each may cost an iteration; with 4 calm walks made twice the factors

  // z = P r.
  void apply(std::span<const V3<T>> r, std::span<V3<T>> z);

 private:
  ColumnLayout layout_;
  ColumnPattern pattern_;
  LayerFactor<T> layers_;
  ColumnFactor<T> columns_;
  CoarseSpace<T> coarse_;
  bool has_coarse_ = false;                          // else a pivot was not positive: P goes without
  PartMemory::Input factors_of_, coarse_of_;         // that the parts at hand were made for
  bool factors_kept_ = false, coarse_kept_ = false;  // in the present solve
  ColumnField<T> field_;                             // r, then z
  std::vector<V3<T>> x_;
  void makeFactors(const ColumnMatrix<T>& a, const PartMemory::Input& input);
  void makeCoarse(const ColumnMatrix<T>& a, std::span<const V3<T>> x, const PartMemory::Input& input);
};

}  // namespace sim
