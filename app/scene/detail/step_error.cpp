#include "app/scene/detail/step_error.h"

#include <cmath>

namespace app {

namespace {
// s; ratios of the true error to the estimate's mean, geometric means over the scenes of hairmesh-bench --ladder. They
// spread by a factor of three either way: an estimate says in which decade the error lies.
constexpr double kEulerMemory = 0.25, kBdf2Memory = 0.25;
}  // namespace

double stepError(const sim::HairMesh& mesh, sim::Integrator integrator, const sim::HairState& state,
                 StepErrorMeter& meter) {
  const std::size_t n = state.velocities.size();
  const double h = state.previous_dt;
  if (h <= 0 || state.previous_velocities.size() != n) {
    meter.step = 0;
    return 0;
  }
  const bool two_step = integrator == sim::Integrator::kBdf2 && meter.step > 0 && meter.change.size() == n;
  meter.change.resize(n, sim::Vec3::Zero());
  double sum = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const sim::Vec3 change = state.velocities[i] - state.previous_velocities[i];
    const sim::Vec3 local = two_step ? sim::Vec3(2.0 / 9 * (change - h / meter.step * meter.change[i])) : 0.5 * change;
    sum += local.squaredNorm();  // times h: a position, over h: per second
    meter.change[i] = change;
  }
  meter.step = h;
  return std::sqrt(sum / static_cast<double>(n)) / mesh.hair_length;
}

double accumulatedError(sim::Integrator integrator, double mean_step_error) {
  return mean_step_error * (integrator == sim::Integrator::kBdf2 ? kBdf2Memory : kEulerMemory);
}

}  // namespace app
