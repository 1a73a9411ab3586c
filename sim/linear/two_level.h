// The two-level preconditioner: P = L^-1 + s H^-1 + B C^-1 B^T, an additive Schwarz method (Dryja and Widlund 1987).
//
// L: the matrix without the couplings between layers (layer_factor.h). H: without those between columns
// (column_factor.h), weighted by s, for the diagonal is in both. Both leave out the directions that contacts remove:
// each that P does not know of adds an eigenvalue far from the others, which costs an iteration. C = B^T A B: the
// projection onto rigid motions of patches (coarse_space.h), for what many vertices do together.
//
// Each of the two parts, the factors L and H and the coarse space, serves some solves: the matrix changes little from
// one step to the next.
#pragma once

#include <algorithm>
#include <span>
#include <utility>
#include <vector>

#include "sim/linear/coarse_space.h"
#include "sim/linear/column_factor.h"
#include "sim/linear/column_matrix.h"
#include "sim/linear/layer_factor.h"
#include "sim/mesh/hair_mesh.h"

namespace sim {

// How long a part made for one matrix serves the matrices after it: until the iterations that its age has cost add up
// to what making it anew costs, or a number of solves.
struct PartAge {
  double cost;        // of making it, in iterations
  int oldest;         // solves that it serves at most
  int age = oldest;   // solves since it was made
  int fresh = 0;      // iterations of its first solve
  double lost = 0;    // iterations beyond those of the first, since then
  bool kept = false;  // in the present solve

  bool serves() const { return age < oldest && lost < cost; }
  void forget() { age = oldest; }
  void count(int iterations) {
    if (!kept) age = 0, lost = 0, fresh = iterations;
    ++age;
    lost += std::max(0, iterations - fresh);
  }
};

template <class T>
struct TwoLevel {
  explicit TwoLevel(const HairMesh& mesh);

  // Takes the matrix of a solve, the positions that it is of (m, one a vertex, relative to any point) and the
  // constraints. Makes those parts anew that serve no longer: old ones, the factors where other directions are held,
  // the coarse space where more than kMaxUnknown vertices are held that it does not know of.
  void update(const ColumnMatrix<T>& a, std::span<const V3<T>> x, std::span<const VertexConstraint> constraints = {});
  // The solve with it took so many iterations.
  void count(int iterations);
  // The matrices to come have little to do with those before: other stiffness, mass or time step.
  void forget();

  // Iterations that making a part costs, and solves that it serves at most. On four walks (short low to long medium)
  // solves take within a tenth as long with twice of each.
  static constexpr double kFactorsCost = 1, kCoarseCost = 3;
  static constexpr int kFactorsServe = 4, kCoarseServes = 8;
  // s. Iterations with 0.3, 0.5 and 0.75 differ by one in twenty.
  static constexpr T kColumnWeight = T(0.5);
  static constexpr int kMaxUnknown = 2;  // with thirty a solve's iterations tripled

  // z = P r.
  void apply(std::span<const V3<T>> r, std::span<V3<T>> z);

 private:
  ColumnLayout layout_;
  ColumnPattern pattern_;
  LayerFactor<T> layers_;
  ColumnFactor<T> columns_;
  CoarseSpace<T> coarse_;
  bool has_coarse_ = false;  // else a pivot was not positive: P goes without
  PartAge factors_age_{kFactorsCost, kFactorsServe}, coarse_age_{kCoarseCost, kCoarseServes};
  std::vector<std::pair<int, int>> held_;  // vertices that the factors know constrained, and in how many directions
  ColumnField<T> field_;                   // r, then z
  bool noteHeld(std::span<const VertexConstraint> constraints);
};

}  // namespace sim
