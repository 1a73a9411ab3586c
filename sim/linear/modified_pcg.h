// Modified preconditioned conjugate gradients with a filter per constrained vertex, after Baraff and Witkin, "Large
// Steps in Cloth Simulation" (1998), section 5.3. Solves A x = b for the free directions: x keeps its value in the
// removed directions, where the residual is the constraint's reaction. All vectors have one V3 per vertex.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "sim/linear/vector3.h"
#include "sim/linear/vector_kernels.h"

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
  // As apply; `removed` gets what was taken away, and putBack adds it again, to rounding.
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

// A solve stops, converged, at the first of
// - the relative error, in the energy norm, estimated by the gains of the iterations and by the residual in the
//   preconditioner's norm;
// - no vertex's residual above `acceleration` (against `inverse_mass_dt`);
// - no vertex moved by more than `displacement` in the time `h` by the velocity P r, an estimate of the error.
// It stops, not converged, at max_iterations, or where iterations change x by no more than rounding does.
template <class T>
struct StopRule {
  double relative = 1e-3;
  double acceleration = 0;             // m/s^2; 0: off
  std::span<const T> inverse_mass_dt;  // 1/(kg s) per vertex; needed for `acceleration` and residual_acceleration
  double displacement = 0;             // m; 0: off
  double h = 0;                        // s
  int max_iterations = 400;
  double head_start = 0;  // J: the squared energy norm by which x is nearer than what progress is measured from
  double most_first = std::numeric_limits<double>::infinity();  // J: progress is measured from no more than this
};

// How a solve begins.
// kFresh: from x and b.
// kPrepared: as kFresh, with the residual already in the scratch and nothing in it along the deflated directions.
// kRestart: from x and the residual in the scratch, after b or the filter changed. The search directions begin anew;
// progress is measured from the first norm of the fresh start.
enum class SolveStart { kFresh, kPrepared, kRestart };

struct SolveReport {
  int iterations = 0;
  double relative_residual = 0;      // in the preconditioner's norm
  double residual_acceleration = 0;  // m/s^2, largest over vertices
  bool converged = false;
};

// A direction x that the search directions are kept conjugate to: q = A x, `energy` = x . q (J, positive). All are
// within the free directions and conjugate to one another.
template <class T>
struct Deflated {
  std::span<const V3<T>> x, q;
  double energy = 0;
};

// What a solve leaves behind, sized once. `r` is b - A x: in the removed directions, minus the constraint's reaction.
template <class T>
struct SolverScratch {
  std::vector<V3<T>> r, z, d, q;
  std::vector<V3<T>> removed;           // of r at the filter's vertices, while the preconditioner reads it
  double square = 0, first_square = 0;  // r . P r now and at the fresh start, J
  double gained = 0;                    // J, of the squared energy norm of the error since the fresh start
  // Deflated conjugate gradients (Saad, Yeung, Erhel and Guyomarc'h 2000): every iterate is the best over these
  // directions, too. Set by the caller, per solve.
  std::span<const Deflated<T>> deflation;
  void resize(int n) { r.resize(n), z.resize(n), d.resize(n), q.resize(n), removed.reserve(n); }
};

// One run: x unknown, b right-hand side, r residual, z = S P S r, d search direction, q = A d. S, the filter, keeps z
// and with it d within the free directions. r stays whole, for its removed directions are the reactions.
template <class T, class Operator, class Preconditioner>
class PcgRun {
 public:
  PcgRun(const Operator& a, const Filter<T>& filter, Preconditioner& preconditioner, const StopRule<T>& stop,
         SolverScratch<T>& scratch, std::span<V3<T>> x)
      : a_(a),
        filter_(filter),
        preconditioner_(preconditioner),
        stop_(stop),
        s_(scratch),
        x_(x),
        r_(scratch.r),
        z_(scratch.z),
        d_(scratch.d),
        q_(scratch.q) {}

  SolveReport solve(std::span<const V3<T>> b, SolveStart start) {
    begin(b, start);
    report_.converged = closeEnough();
    while (!report_.converged && report_.iterations < stop_.max_iterations && iterate()) {
    }
    if (!std::isfinite(s_.square)) report_.converged = false;
    if (s_.first_square > 0) report_.relative_residual = std::sqrt(std::max(s_.square, 0.0) / s_.first_square);
    filter_.take(r_, s_.removed);
    report_.residual_acceleration = largestAcceleration();
    filter_.putBack(s_.removed, r_);
    return report_;
  }

 private:
  static constexpr int kRealign = 16;        // iterations, after which rounding has left something along the deflated
  static constexpr int kLookBack = 16;       // iterations from one test for stagnation to the next
  static constexpr double kNormShare = 0.1;  // of the squared tolerance
  static constexpr double kNoise = 64;       // squared rounding errors that kLookBack iterations gain in stagnation

  void begin(std::span<const V3<T>> b, SolveStart start) {
    if (start == SolveStart::kFresh) {
      a_(x_, q_);
      for (std::size_t i = 0; i < b.size(); ++i) r_[i] = b[i] - q_[i];
    }
    if (start != SolveStart::kPrepared) alignToDeflated();
    precondition();
    std::copy(z_.begin(), z_.end(), d_.begin());
    deflate();
    if (start == SolveStart::kRestart) return;
    s_.first_square = std::min(s_.square + stop_.head_start, stop_.most_first);
    s_.gained = stop_.head_start;
  }

  // False: stagnated, or a value is not finite.
  bool iterate() {
    a_(d_, q_);
    const double curvature = innerProduct<T>(d_, q_);
    if (!(curvature > 0)) return false;
    // d . r, not `square`: equal without rounding, but what rounding leaves in r along the deflated directions makes
    // steps by `square` diverge in single precision.
    const double step = innerProduct<T>(d_, r_) / curvature, before = s_.square;
    const T alpha = static_cast<T>(step);
    addScaled<T>(alpha, d_, x_);
    addScaled<T>(-alpha, q_, r_);
    countGain(step * step * curvature);
    ++report_.iterations;
    if (report_.iterations % kRealign == 0) alignToDeflated();
    precondition();
    scaleAndAdd<T>(static_cast<T>(s_.square / before), z_, d_);
    deflate();
    report_.converged = closeEnough();
    return std::isfinite(s_.square) && (report_.converged || !stagnates());
  }

  // The filter is applied on both sides of P: without the right one the method diverges with partial constraints.
  void precondition() {
    filter_.take(r_, s_.removed);
    preconditioner_.apply(r_, z_);
    calm_ = stop_.acceleration > 0 && allWithin(stop_.acceleration, r_, stop_.inverse_mass_dt);
    filter_.putBack(s_.removed, r_);
    filter_.apply(z_);
    s_.square = innerProduct<T>(r_, z_);
  }

  // The gain of an iteration (J, of the squared energy norm of the error; Hestenes and Stiefel 1952). The larger of the
  // last two ratios of gains, as a geometric series, estimates what is left (after Strakos and Tichy 2002).
  void countGain(double gain) {
    const double ratio = gain_ > 0 ? gain / gain_ : 1;
    rate_ = std::max(ratio, last_ratio_);
    last_ratio_ = ratio;
    gain_ = gain;
    recent_ += gain;
    s_.gained += gain;
  }

  // By the preconditioner's norm of the residual, which may be less than the energy norm of the error by an order, or
  // by the estimate of that norm. In single precision factors of very uneven hair may come out indefinite: a negative
  // square is no norm, and directions stay conjugate all the same.
  bool withinTolerance() const {
    const double bound = stop_.relative * stop_.relative;
    if (s_.square >= 0 && !(s_.square > kNormShare * bound * s_.first_square)) return true;
    if (!(rate_ < 1)) return false;
    const double left = gain_ * rate_ / (1 - rate_);
    return left <= bound * std::min(s_.gained + left, stop_.most_first);
  }

  bool closeEnough() const {
    return withinTolerance() || calm_ || (stop_.displacement > 0 && allWithin(stop_.displacement / stop_.h, z_, {}));
  }

  // Beyond rounding, in the energy norm, filtered directions are no longer conjugate and the residual grows again.
  bool stagnates() {
    if (report_.iterations % kLookBack != 0) return false;
    constexpr double kRounding = std::numeric_limits<T>::epsilon();
    return std::exchange(recent_, 0) <= kNoise * kRounding * kRounding * s_.gained;
  }

  void deflate() {
    for (const Deflated<T>& one : s_.deflation)
      addScaled<T>(static_cast<T>(-innerProduct<T>(one.q, z_) / one.energy), one.x, d_);
  }

  // Moves x so that its residual has nothing along the deflated directions.
  void alignToDeflated() {
    for (const Deflated<T>& one : s_.deflation) {
      const T step = static_cast<T>(innerProduct<T>(one.x, r_) / one.energy);
      addScaled<T>(step, one.x, x_);
      addScaled<T>(-step, one.q, r_);
    }
  }

  double largestAcceleration() const {
    double largest = 0;
    for (std::size_t i = 0; i < stop_.inverse_mass_dt.size(); ++i) {
      const double weight = static_cast<double>(stop_.inverse_mass_dt[i]);
      const double a = static_cast<double>(dot(r_[i], r_[i])) * weight * weight;
      if (!(a <= largest)) largest = a;  // a value that is not finite wins
    }
    return std::sqrt(largest);
  }

  // Whether no entry, times its weight where there are weights, is longer than the bound.
  static bool allWithin(double bound, std::span<const V3<T>> entries, std::span<const T> weights) {
    for (std::size_t i = 0; i < entries.size(); ++i) {
      const double weight = weights.empty() ? 1 : static_cast<double>(weights[i]);
      if (!(static_cast<double>(dot(entries[i], entries[i])) * weight * weight <= bound * bound)) return false;
    }
    return true;
  }

  const Operator& a_;
  const Filter<T>& filter_;
  Preconditioner& preconditioner_;
  const StopRule<T>& stop_;
  SolverScratch<T>& s_;
  std::span<V3<T>> x_, r_, z_, d_, q_;
  SolveReport report_;
  bool calm_ = false;                            // no vertex's residual exceeds the bound on its acceleration
  double recent_ = 0;                            // J, gained since the last test for stagnation
  double gain_ = 0, last_ratio_ = 1, rate_ = 1;  // see countGain
};

// `a(x, y)`: y = A x. `preconditioner.apply(r, z)`: z = P r, P symmetric and positive definite.
template <class T, class Operator, class Preconditioner>
SolveReport solveModifiedPcg(const Operator& a, std::span<const V3<T>> b, const Filter<T>& filter,
                             Preconditioner& preconditioner, const StopRule<T>& stop, SolverScratch<T>& scratch,
                             std::span<V3<T>> x, SolveStart start = SolveStart::kFresh) {
  return PcgRun<T, Operator, Preconditioner>(a, filter, preconditioner, stop, scratch, x).solve(b, start);
}

}  // namespace sim
