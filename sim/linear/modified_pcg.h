// Modified preconditioned conjugate gradients with a filter per constrained vertex, after Baraff and Witkin, "Large
// Steps in Cloth Simulation" (1998), section 5.3.
//
// Solves A x = b for the free directions: x keeps its value in the removed directions, where the residual is the
// constraint's reaction. All vectors have one V3 per block row.
#pragma once

#include <limits>
#include <span>
#include <vector>

#include "sim/linear/block_matrix.h"
#include "sim/linear/column_matrix.h"
#include "sim/linear/preconditioner.h"

namespace sim {

// The constrained vertices, each with the projector S onto its free directions: zero (all three removed), I - n n^T, t
// t^T or, for vertices not listed, the identity.
template <class T>
struct Filter {
  std::vector<int> vertices;
  std::vector<M3<T>> keep;
  void clear() { vertices.clear(), keep.clear(); }
  void apply(std::span<V3<T>> x) const {
    for (std::size_t k = 0; k < vertices.size(); ++k) x[vertices[k]] = keep[k] * x[vertices[k]];
  }
  // As apply, and keeps what it takes away; putBack undoes it to the last bit but rounding's.
  void take(std::span<V3<T>> x, std::vector<V3<T>>& removed) const {
    removed.clear();
    for (std::size_t k = 0; k < vertices.size(); ++k) {
      V3<T>& at = x[vertices[k]];
      const V3<T> kept = keep[k] * at;
      removed.push_back(at - kept);
      at = kept;
    }
  }
  void putBack(std::span<const V3<T>> removed, std::span<V3<T>> x) const {
    for (std::size_t k = vertices.size(); k-- > 0;) x[vertices[k]] += removed[k];
  }
};

// When to stop: at the relative residual, measured in the preconditioner's norm against the first; or when no vertex's
// residual exceeds `acceleration` (m/s^2, against `inverse_mass_dt`, 1 / (m h) per vertex); or when no vertex would
// move by more than `displacement` (m) in the time `h` for the velocity that the preconditioner answers to the
// residual, which estimates the error itself where the preconditioner is near to the inverse; or at max_iterations. A
// tolerance that the arithmetic does not resolve ends, not converged, where iterations change nothing but the rounding.
//
// `foresee`: the relative residual is also estimated from what the iterations have gained so far (SolverScratch::gain),
// which saves the application of the preconditioner that would only have told that nothing more is needed. For
// preconditioners near to the inverse, whose iterations gain evenly and whose norm is the error's energy.
template <class T>
struct StopRule {
  double relative = 1e-3;
  bool foresee = false;
  double acceleration = 0;             // 0: off
  std::span<const T> inverse_mass_dt;  // 1/(kg s) per vertex; needed for `acceleration` and residual_acceleration
  double displacement = 0;             // 0: off
  double h = 0;                        // s
  int max_iterations = 400;
  double head_start = 0;  // J: the squared energy norm by which x is nearer than what progress is measured from
  double most_first = std::numeric_limits<double>::infinity();  // J: progress is measured from no more than this
};

// How a solve begins. `fresh`: from x and b. `restart`: from x and the residual in the scratch, which the caller has
// kept true while b or the filter changed; the search directions begin anew. `exchange`: as restart, the preconditioner
// being another one. Both measure progress from the first solve's first norm. `prepared`: fresh, but with the residual
// already in the scratch, and with nothing in it along the deflated directions (as SolutionProjection leaves it).
enum class SolveStart { kFresh, kPrepared, kRestart, kExchange };

struct SolveReport {
  int iterations = 0;
  int applications = 0;              // of the preconditioner
  double relative_residual = 0;      // in the preconditioner's norm, or estimated
  double residual_acceleration = 0;  // m/s^2, largest over vertices
  bool converged = false;
};

// A direction x that the solve looks along when it begins, and keeps its search directions conjugate to: q = A x,
// `energy` = x . q. All are within the free directions and conjugate to one another.
template <class T>
struct Deflated {
  std::span<const V3<T>> x, q;
  double energy = 0;  // J, positive
};

// What a solve leaves behind, sized once. `r` is b - A x in all directions: in the removed ones, minus the constraint's
// reaction.
template <class T>
struct SolverScratch {
  std::vector<V3<T>> r, z, d, q;
  std::vector<V3<T>> removed;           // of r at the filter's vertices, while the preconditioner reads it
  double square = 0, first_square = 0;  // r . P r now and at the fresh start
  // The last iteration took `gain` off the squared energy norm of the error (Hestenes and Stiefel 1952), `last_ratio`
  // times what the one before it had taken: a geometric series of gains estimates what is left (after Strakos and Tichy
  // 2002). `rate`: the larger of the last two ratios.
  double gain = 0, last_ratio = 0, rate = 0;
  double gained = 0;  // J, since the fresh start
  // Search directions are kept conjugate to these, so that every iterate is the best also over them (deflated
  // conjugate gradients, after Saad, Yeung, Erhel and Guyomarc'h 2000). Set by the caller, per solve.
  std::span<const Deflated<T>> deflation;
  void resize(int n) { r.resize(n), z.resize(n), d.resize(n), q.resize(n), removed.reserve(n); }
};

// The product with a system matrix, in either of its layouts.
template <class T>
struct BlockOperator {
  using Number = T;
  const BlockMatrix<T>& matrix;
  void operator()(std::span<const V3<T>> x, std::span<V3<T>> y) const { multiply<T>(matrix, x, y); }
};
template <class T>
struct ColumnOperator {
  using Number = T;
  const ColumnMatrix<T>& matrix;
  ColumnProduct<T>& scratch;
  void operator()(std::span<const V3<T>> x, std::span<V3<T>> y) const { multiply<T>(matrix, scratch, x, y); }
};

template <class Operator>
SolveReport solveModifiedPcg(const Operator& a, std::span<const V3<typename Operator::Number>> b,
                             const Filter<typename Operator::Number>& filter,
                             Preconditioner<typename Operator::Number>& preconditioner,
                             const StopRule<typename Operator::Number>& stop,
                             SolverScratch<typename Operator::Number>& scratch,
                             std::span<V3<typename Operator::Number>> x, SolveStart start = SolveStart::kFresh);

template <class T>
SolveReport solveModifiedPcg(const BlockMatrix<T>& a, std::span<const V3<T>> b, const Filter<T>& filter,
                             Preconditioner<T>& preconditioner, const StopRule<T>& stop, SolverScratch<T>& scratch,
                             std::span<V3<T>> x) {
  return solveModifiedPcg<BlockOperator<T>>({a}, b, filter, preconditioner, stop, scratch, x);
}

}  // namespace sim
