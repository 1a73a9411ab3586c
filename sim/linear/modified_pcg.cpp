// x: unknown, b: right-hand side, r: residual, z = P r, d: search direction, q = A d. S, the filter, keeps z and with
// it d within the free directions. r stays whole, because its removed directions are the reactions of the constraints;
// only what the preconditioner reads of it is filtered. Left out there, the method still converges when only whole
// vertices are pinned, and diverges with partial constraints.
#include "sim/linear/modified_pcg.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/linear/vector_kernels.h"

namespace sim {
namespace {

constexpr int kLookAgain = 16;  // iterations, after which rounding has left something along the deflated directions
constexpr int kLookBack = 16;   // iterations
constexpr double kNoise = 64;   // of the squared rounding error, that so many iterations gain where there is nothing to
constexpr double kEven = 0.5;   // gains that fall by at least so much an iteration foretell the next ones

template <class T>
double largestAcceleration(std::span<const V3<T>> r, std::span<const T> inverse_mass_dt) {
  double largest = 0;
  for (std::size_t i = 0; i < inverse_mass_dt.size(); ++i) {
    const double a = static_cast<double>(dot(r[i], r[i])) * inverse_mass_dt[i] * inverse_mass_dt[i];
    if (!(a <= largest)) largest = a;  // a value that is not finite wins
  }
  return std::sqrt(largest);
}

// Whether no vertex's squared entry, times the square of its weight where there are weights, exceeds the bound. Ends at
// the first that does, as a rule at once.
template <class T>
bool allWithin(double bound, std::span<const V3<T>> r, std::span<const T> weights = {}) {
  for (std::size_t i = 0; i < r.size(); ++i) {
    const double weight = weights.empty() ? 1 : static_cast<double>(weights[i]);
    if (!(static_cast<double>(dot(r[i], r[i])) * weight * weight <= bound * bound)) return false;
  }
  return true;
}

// Keeps a search direction conjugate to the deflated ones; z: the preconditioned residual that it goes by.
template <class T>
void deflate(std::span<const Deflated<T>> deflation, std::span<const V3<T>> z, std::span<V3<T>> d) {
  for (const Deflated<T>& one : deflation)
    addScaled<T>(static_cast<T>(-innerProduct<T>(one.q, z) / one.energy), one.x, d);
}

// Moves x so that its residual says nothing along the deflated directions.
template <class T>
void lookAlong(std::span<const Deflated<T>> deflation, std::span<V3<T>> x, std::span<V3<T>> r) {
  for (const Deflated<T>& one : deflation) {
    const T step = static_cast<T>(innerProduct<T>(one.x, r) / one.energy);
    addScaled<T>(step, one.x, x);
    addScaled<T>(-step, one.q, r);
  }
}

// The gain of an iteration (J, of the squared energy norm of the error) into the series that foretells the next ones.
template <class T>
void countGain(double gain, SolverScratch<T>& scratch) {
  if (scratch.gain > 0) {
    const double ratio = gain / scratch.gain;
    scratch.rate = std::max(ratio, scratch.last_ratio);
    scratch.last_ratio = ratio;
  }
  scratch.gain = gain;
}

// Of the squared error, after the last iteration.
template <class T>
double foreseen(const SolverScratch<T>& scratch) {
  return scratch.gain * scratch.rate / (1 - scratch.rate);
}

}  // namespace

template <class Operator>
SolveReport solveModifiedPcg(const Operator& a, std::span<const V3<typename Operator::Number>> b,
                             const Filter<typename Operator::Number>& filter,
                             Preconditioner<typename Operator::Number>& preconditioner,
                             const StopRule<typename Operator::Number>& stop,
                             SolverScratch<typename Operator::Number>& scratch,
                             std::span<V3<typename Operator::Number>> x, SolveStart start) {
  using T = typename Operator::Number;
  const std::size_t n = b.size();
  const std::span<V3<T>> r(scratch.r), z(scratch.z), d(scratch.d), q(scratch.q);
  SolveReport report;
  bool preconditioned = false;  // z, square and calm are those of the present r
  bool calm = false;            // no vertex's residual exceeds the bound on its acceleration
  // z = S P S r, square = r . z.
  const auto precondition = [&] {
    filter.take(r, scratch.removed);
    preconditioner.apply(r, z);
    ++report.applications;
    calm = stop.acceleration > 0 && allWithin<T>(stop.acceleration, r, stop.inverse_mass_dt);
    filter.putBack(scratch.removed, r);
    filter.apply(z);
    scratch.square = innerProduct<T>(r, z);
    preconditioned = true;
  };
  const auto closeEnough = [&] {
    return !(scratch.square > stop.relative * stop.relative * scratch.first_square) || calm ||
           (stop.displacement > 0 && allWithin<T>(stop.displacement / stop.h, z));
  };
  const auto foreseenEnough = [&] {
    return stop.foresee && scratch.rate > 0 && scratch.rate < kEven && scratch.gain > 0 &&
           foreseen(scratch) <= stop.relative * stop.relative * scratch.first_square;
  };
  const bool first = start == SolveStart::kFresh || start == SolveStart::kPrepared;
  if (start == SolveStart::kFresh) {
    a(x, q);
    for (std::size_t i = 0; i < n; ++i) r[i] = b[i] - q[i];
  }
  if (first || start == SolveStart::kExchange) scratch.rate = scratch.last_ratio = 0;
  const double before_start = scratch.square;
  if (start != SolveStart::kPrepared) lookAlong<T>(scratch.deflation, x, r);
  precondition();
  std::copy(z.begin(), z.end(), d.begin());
  deflate<T>(scratch.deflation, z, d);
  if (first) scratch.first_square = std::min(scratch.square + stop.head_start, stop.most_first);
  // In the norm of the new preconditioner the progress so far counts for as much as it did in the old one's.
  if (start == SolveStart::kExchange && before_start > 0) scratch.first_square *= scratch.square / before_start;
  scratch.gain = 0;
  if (first) scratch.gained = stop.head_start;
  double recent = 0;  // J, gained since the last look back
  // Whether the iterations since change x by no more than rounding does, in the energy norm. Beyond that filtered
  // directions are no longer conjugate: in single precision the residual was seen to grow by twelve orders again.
  const auto nothingChanges = [&] {
    if (report.iterations % kLookBack != 0) return false;
    constexpr double kRounding = std::numeric_limits<T>::epsilon();
    const bool nothing = recent <= kNoise * kRounding * kRounding * scratch.gained;
    recent = 0;
    return nothing;
  };
  report.converged = closeEnough();
  while (!report.converged && report.iterations < stop.max_iterations) {
    a(d, q);
    const double curvature = innerProduct<T>(d, q);
    if (!(curvature > 0)) break;  // rounding has eaten the direction, or a value is not finite
    // d . r, which without rounding were the square: what rounding leaves in r along the deflated directions counts in
    // the one and not in the other, and steps by the square blew up in single precision.
    const double step = innerProduct<T>(d, r) / curvature, before = scratch.square;
    const T alpha = static_cast<T>(step);
    addScaled<T>(alpha, d, x);
    addScaled<T>(-alpha, q, r);
    preconditioned = false;
    countGain(step * step * curvature, scratch);
    recent += scratch.gain;
    scratch.gained += scratch.gain;
    ++report.iterations;
    report.converged = foreseenEnough();
    if (report.converged) break;
    if (report.iterations % kLookAgain == 0) lookAlong<T>(scratch.deflation, x, r);
    precondition();
    scaleAndAdd<T>(static_cast<T>(scratch.square / before), z, d);
    deflate<T>(scratch.deflation, z, d);
    report.converged = closeEnough();
    if (!std::isfinite(scratch.square) || (!report.converged && nothingChanges())) break;
  }
  if (!std::isfinite(scratch.square)) report.converged = false;
  const double left = preconditioned ? scratch.square : foreseen(scratch);
  report.relative_residual = scratch.first_square > 0 ? std::sqrt(std::max(left, 0.0) / scratch.first_square) : 0;
  filter.take(r, scratch.removed);
  report.residual_acceleration = largestAcceleration<T>(r, stop.inverse_mass_dt);
  filter.putBack(scratch.removed, r);
  return report;
}

#define HAIRMESH_INSTANTIATE(Operator, T)                                                                            \
  template SolveReport solveModifiedPcg(const Operator<T>&, std::span<const V3<T>>, const Filter<T>&,                \
                                        Preconditioner<T>&, const StopRule<T>&, SolverScratch<T>&, std::span<V3<T>>, \
                                        SolveStart)
HAIRMESH_INSTANTIATE(BlockOperator, float);
HAIRMESH_INSTANTIATE(BlockOperator, double);
HAIRMESH_INSTANTIATE(ColumnOperator, float);
HAIRMESH_INSTANTIATE(ColumnOperator, double);
#undef HAIRMESH_INSTANTIATE

}  // namespace sim
