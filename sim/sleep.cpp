#include "sim/sleep.h"

#include <algorithm>
#include <cmath>

namespace sim {

namespace {

bool sameParams(const SimParams& a, const SimParams& b) {
  return std::ranges::all_of(paramFields(), [&](const ParamField& field) { return field.get(a) == field.get(b); });
}

bool near(std::span<const Vec3> a, std::span<const Vec3> b, double distance) {
  return a.size() == b.size() && std::equal(a.begin(), a.end(), b.begin(), [&](const Vec3& p, const Vec3& q) {
           return (p - q).squaredNorm() <= distance * distance;
         });
}

bool near(const Ellipsoid& a, const Ellipsoid& b) {
  if (a.radii != b.radii || (a.center - b.center).norm() > kStillInput) return false;
  // Of a rotation by the angle 2 phi between the two, |vec(a* b)| is sin phi.
  return 2 * (a.rotation.conjugate() * b.rotation).vec().norm() * a.radii.maxCoeff() <= kStillInput;
}

bool inputsStayed(const StepInput& input, const SleepState& sleep) {
  return near(input.roots, sleep.roots, kStillInput) && input.ellipsoids.size() == sleep.ellipsoids.size() &&
         std::equal(input.ellipsoids.begin(), input.ellipsoids.end(), sleep.ellipsoids.begin(),
                    [](const Ellipsoid& a, const Ellipsoid& b) { return near(a, b); }) &&
         input.pins.size() == sleep.pins.size() &&
         std::equal(input.pins.begin(), input.pins.end(), sleep.pins.begin(),
                    [](const PinnedVertex& a, const PinnedVertex& b) {
                      return a.vertex == b.vertex && a.stiffness == b.stiffness &&
                             (a.target - b.target).norm() <= kStillInput;
                    });
}

bool airChanges(const SimParams& params) {
  return params.gust != 0 && Vec3(params.wind_x, params.wind_y, params.wind_z).squaredNorm() > 0;
}

void beginWindow(const HairState& state, SleepState& sleep) {
  sleep.begin.assign(state.positions.begin(), state.positions.end());
  sleep.window_time = 0;
  sleep.path = 0;
}

void wake(const SimParams& params, const StepInput& input, const HairState& state, SleepState& sleep) {
  sleep.asleep = false;
  sleep.quiet_windows = 0;
  sleep.params = params;
  sleep.roots.assign(input.roots.begin(), input.roots.end());
  sleep.ellipsoids.assign(input.ellipsoids.begin(), input.ellipsoids.end());
  sleep.pins.assign(input.pins.begin(), input.pins.end());
  beginWindow(state, sleep);
}

}  // namespace

bool maySleep(const SimParams& params, const StepInput& input, double dt, const HairState& state, SleepState& sleep) {
  if (airChanges(params) || !inputsStayed(input, sleep) || !sameParams(params, sleep.params) ||
      state.positions.size() != sleep.begin.size() || state.memory.material.slices > 0 ||
      state.memory.material.outdated) {
    wake(params, input, state, sleep);
    return false;
  }
  if (sleep.asleep) {
    if (state.positions == sleep.begin) return true;
    wake(params, input, state, sleep);
    return false;
  }
  for (std::size_t i = 0; i < state.positions.size(); ++i) {
    sleep.path = std::max(sleep.path, (state.positions[i] - sleep.begin[i]).norm());
  }
  if (sleep.path > kQuietPath) {
    sleep.quiet_windows = 0;
    beginWindow(state, sleep);
    return false;
  }
  sleep.window_time += dt;
  if (sleep.window_time < kQuietWindow) return false;
  ++sleep.quiet_windows;
  const bool quiet = sleep.quiet_windows >= 2;
  beginWindow(state, sleep);
  sleep.asleep = quiet;
  return quiet;
}

}  // namespace sim
