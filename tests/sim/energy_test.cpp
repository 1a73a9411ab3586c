// With the roots still, no body, no wind and damping, nothing that a step does may raise the mechanical energy: from
// one step to the next, not only against what the motion left.
#include <gtest/gtest.h>

#include "tests/sim_probes.h"
#include "tests/test_meshes.h"

namespace energy_test {

using sim::Integrator;
using sim::Vec3;
using test::Hair;

struct Disturbance {
  const char* name;
  void (*apply)(Hair& hair);
};

// About the middle of its roots.
void swing(Hair& hair) {
  for (std::size_t i = 0; i < hair.state.positions.size(); ++i) {
    if (hair.mesh.isRoot(static_cast<int>(i))) continue;
    hair.state.velocities[i] = Vec3(8, 0, 5).cross(hair.state.positions[i] - hair.roots[0]);
  }
}

void stretch(Hair& hair) {
  for (std::size_t i = 0; i < hair.state.positions.size(); ++i) {
    const Vec3& root = hair.roots[hair.mesh.column_of[i]];
    hair.state.positions[i] = root + 1.1 * (hair.state.positions[i] - root);
  }
}

void squeeze(Hair& hair) {
  for (std::size_t i = 0; i < hair.state.positions.size(); ++i) {
    if (!hair.mesh.isRoot(static_cast<int>(i))) hair.state.positions[i].x() *= 0.8;
  }
}

constexpr Disturbance kDisturbances[] = {{"swing", swing}, {"stretch", stretch}, {"squeeze", squeeze}};

sim::SimParams solvedTightly(Integrator integrator) {
  sim::SimParams params;
  params.collide = false;
  params.integrator = integrator;
  params.precision = sim::Precision::kDouble;
  params.tolerance = 1e-8, params.acceleration_tolerance = 0, params.displacement_tolerance = 0;
  return params;
}

// The largest rise of the energy in a step, of what the disturbance put in.
double largestRise(const sim::SimParams& params, const Disturbance& disturbance, double dt) {
  Hair hair(test::combedShape(test::mixedPatch(7, 0.3)), params);
  const auto energy = [&] { return test::mechanicalEnergy(hair.mesh, params, hair.context, hair.state); };
  const double rest = energy();
  disturbance.apply(hair);
  double before = energy(), worst = 0;
  const double put_in = before - rest;
  EXPECT_GT(put_in, 0) << disturbance.name;
  for (int n = 0; n < 1.0 / dt; ++n) {
    hair.step(dt);
    const double now = energy();
    worst = std::max(worst, (now - before) / put_in);
    before = now;
  }
  EXPECT_LT(before - rest, 0.1 * put_in) << disturbance.name << ": and it comes to rest";
  return worst;
}

// Rounding only, where an implicit Euler step is solved to the end; and the demo's own settings leave a solve's error.
TEST(Energy, NeverGrowsWithoutInput) {
  sim::SimParams usual;
  usual.collide = false;
  for (const Disturbance& disturbance : kDisturbances) {
    for (const double dt : {1.0 / 240, 1.0 / 60, 1.0 / 30}) {
      EXPECT_LT(largestRise(solvedTightly(Integrator::kLinearizedEuler), disturbance, dt), 1e-12)
          << disturbance.name << ", " << dt;
      EXPECT_LT(largestRise(usual, disturbance, dt), 1e-6) << disturbance.name << ", " << dt << ": as the demo steps";
    }
  }
}

// A second-order step keeps to the energy of two steps, not of one: a turning point that falls between two long steps
// shows as a rise of a thousandth.
TEST(Energy, OfTheSecondOrderStepRisesByNoMoreThanATurningPointBetweenSteps) {
  for (const Disturbance& disturbance : kDisturbances) {
    for (const double dt : {1.0 / 240, 1.0 / 60, 1.0 / 30}) {
      const double bound = dt > 1.0 / 50 ? 3e-3 : 1e-6;
      EXPECT_LT(largestRise(solvedTightly(Integrator::kBdf2), disturbance, dt), bound)
          << disturbance.name << ", " << dt;
    }
  }
}

}  // namespace energy_test
