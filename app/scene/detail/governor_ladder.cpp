// The ladder's rungs and the work that a step counts, as measured.
//
// Cost and error: `hairmesh-bench --ladder`, geometric means over head_shake, walk_contact, walk_shoulder and jump_1x
// of two seconds at 360 vertices, means of the last two measurements (errors differ by a quarter from one to the other:
// where contacts are made a little earlier paths part); the settings that no other beats in both, thinned where two lie
// close together. Costs of other meshes differ by a third or so, which the governor learns as it goes; their errors
// differ too, which it does not learn. docs/performance.md holds the measurement.
#include <cmath>

#include "app/scene/detail/governor.h"

namespace app {

namespace {

using sim::Integrator;

constexpr int kMaxIterations = 60;
constexpr Rung kLadder[] = {
    {"linearized-euler 1/10 s, tolerance 1e-2", Integrator::kLinearizedEuler, 10, 1e-2, kMaxIterations, 0.44, 2.6e-2},
    {"linearized-euler 1/15 s, tolerance 1e-2", Integrator::kLinearizedEuler, 15, 1e-2, kMaxIterations, 0.51, 2.4e-2},
    {"linearized-euler 1/20 s, tolerance 1e-2", Integrator::kLinearizedEuler, 20, 1e-2, kMaxIterations, 0.58, 2.3e-2},
    {"linearized-euler 1/30 s, tolerance 1e-2", Integrator::kLinearizedEuler, 30, 1e-2, kMaxIterations, 0.72, 1.95e-2},
    {"linearized-euler 1/60 s, tolerance 1e-2", Integrator::kLinearizedEuler, 60, 1e-2, kMaxIterations, 1, 1.3e-2},
    {"linearized-euler 1/120 s, tolerance 1e-2", Integrator::kLinearizedEuler, 120, 1e-2, kMaxIterations, 2.15, 9.5e-3},
    {"bdf2 1/120 s, tolerance 1e-2", Integrator::kBdf2, 120, 1e-2, kMaxIterations, 2.5, 4.8e-3},
    {"bdf2 1/240 s, tolerance 1e-2", Integrator::kBdf2, 240, 1e-2, kMaxIterations, 4.7, 2.5e-3},
    {"bdf2 1/480 s, tolerance 1e-2", Integrator::kBdf2, 480, 1e-2, kMaxIterations, 9, 1.8e-3},
};
static_assert(std::size(kLadder) <= kMaxRungs);

// s a vertex: of a step without iterations. Fitted, as the next, to walks of all styles and resolutions.
constexpr double kPerSolve = 3.3e-7;

// s an iteration and vertex: grows as matrix and factors leave the caches.
double perIteration(int vertices) {
  return 5e-8 * std::pow(vertices / 2300.0, 0.2);
}

}  // namespace

std::span<const Rung> ladder() {
  return kLadder;
}

int defaultRung() {
  const sim::SimParams standard;
  for (int k = 0; k < static_cast<int>(std::size(kLadder)); ++k) {
    const Rung& rung = kLadder[k];
    if (rung.integrator == standard.integrator && std::abs(rung.steps_per_second * standard.time_step - 1) < 1e-9 &&
        rung.tolerance == standard.tolerance) {
      return k;
    }
  }
  return 0;
}

double countedCost(int vertices, const sim::StepReport& report) {
  return vertices * (kPerSolve * report.solves + perIteration(vertices) * report.solver_iterations);
}

}  // namespace app
