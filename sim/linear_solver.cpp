// x: unknown, b: right-hand side, r: residual, z = P r, d: search direction, q = A d. S, the filter, is applied
// wherever a vector must stay within the free directions: to r, to z and to q. Left out at one place, the method still
// converges when only whole vertices are pinned, and diverges with partial constraints.
#include "sim/linear_solver.h"

#include <cmath>

namespace sim {
namespace {

// Sums in double whatever T: single-precision sums of thousands of terms would decide the stop by rounding.
template <class T>
double innerProduct(std::span<const V3<T>> a, std::span<const V3<T>> b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += static_cast<double>(dot(a[i], b[i]));
  return sum;
}

template <class T>
double largestAcceleration(std::span<const V3<T>> r, std::span<const T> inverse_mass_dt) {
  double largest = 0;
  for (std::size_t i = 0; i < inverse_mass_dt.size(); ++i) {
    const double a = static_cast<double>(dot(r[i], r[i])) * inverse_mass_dt[i] * inverse_mass_dt[i];
    if (!(a <= largest)) largest = a;  // a value that is not finite wins
  }
  return std::sqrt(largest);
}

}  // namespace

template <class Operator>
SolveReport solveModifiedPcg(const Operator& a, std::span<const V3<typename Operator::Number>> b,
                             const Filter<typename Operator::Number>& filter,
                             Preconditioner<typename Operator::Number>& preconditioner,
                             const StopRule<typename Operator::Number>& stop,
                             SolverScratch<typename Operator::Number>& scratch,
                             std::span<V3<typename Operator::Number>> x) {
  using T = typename Operator::Number;
  const std::size_t n = b.size();
  const std::span<V3<T>> r(scratch.r), z(scratch.z), d(scratch.d), q(scratch.q);
  SolveReport report;
  a(x, q);
  for (std::size_t i = 0; i < n; ++i) r[i] = b[i] - q[i];
  filter.apply(r);
  preconditioner.apply(r, z);
  filter.apply(z);
  for (std::size_t i = 0; i < n; ++i) d[i] = z[i];
  double delta = innerProduct<T>(r, z);
  report.first_norm = std::sqrt(std::max(delta, 0.0));
  const double first = stop.first_norm > 0 ? stop.first_norm * stop.first_norm : delta;
  report.residual_acceleration = largestAcceleration<T>(r, stop.inverse_mass_dt);
  const auto slowEnough = [&] { return stop.acceleration > 0 && report.residual_acceleration <= stop.acceleration; };
  report.converged = !(first > 0) || slowEnough();
  while (!report.converged && report.iterations < stop.max_iterations) {
    a(d, q);
    filter.apply(q);
    const double curvature = innerProduct<T>(d, q);
    if (!(curvature > 0)) break;  // rounding has eaten the direction, or a value is not finite
    const T alpha = static_cast<T>(delta / curvature);
    for (std::size_t i = 0; i < n; ++i) {
      x[i] += alpha * d[i];
      r[i] -= alpha * q[i];
    }
    preconditioner.apply(r, z);
    filter.apply(z);
    const double next = innerProduct<T>(r, z);
    const T beta = static_cast<T>(next / delta);
    for (std::size_t i = 0; i < n; ++i) d[i] = z[i] + beta * d[i];
    delta = next;
    ++report.iterations;
    report.residual_acceleration = largestAcceleration<T>(r, stop.inverse_mass_dt);
    report.converged = delta <= stop.relative * stop.relative * first || slowEnough();
    if (!std::isfinite(delta)) break;
  }
  report.relative_residual = first > 0 ? std::sqrt(std::max(delta, 0.0) / first) : 0;
  return report;
}

#define HAIRMESH_INSTANTIATE(Operator, T)                                                             \
  template SolveReport solveModifiedPcg(const Operator<T>&, std::span<const V3<T>>, const Filter<T>&, \
                                        Preconditioner<T>&, const StopRule<T>&, SolverScratch<T>&, std::span<V3<T>>)
HAIRMESH_INSTANTIATE(BlockOperator, float);
HAIRMESH_INSTANTIATE(BlockOperator, double);
HAIRMESH_INSTANTIATE(ColumnOperator, float);
HAIRMESH_INSTANTIATE(ColumnOperator, double);
#undef HAIRMESH_INSTANTIATE

}  // namespace sim
