// Variable-step BDF2: exact on an oscillator whatever the steps' lengths, of second order, and its history follows
// corrections of positions.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <complex>
#include <cstdio>

#include "tests/test_meshes.h"

namespace two_step_test {

using sim::Vec3;
using test::Hair;
using Complex = std::complex<double>;

constexpr double kAcross = 0.01;  // m, the amplitude
constexpr double kStiffness = 2;  // N/m

sim::SimParams freeParticles() {
  sim::SimParams params = test::looseParticles();
  params.integrator = sim::Integrator::kBdf2;
  params.gravity = 0;
  params.collide = false;
  params.tolerance = 1e-13, params.acceleration_tolerance = 1e-16, params.displacement_tolerance = 0;
  return params;
}

// One vertex on a spring without damping, the others loose and at rest: x'' = -w^2 x along a slanted line.
struct Oscillator {
  Hair hair;
  Vec3 middle;
  int vertex;
  double frequency;  // rad/s

  Oscillator() : hair(test::patchShape({}), freeParticles()) {
    vertex = hair.mesh.vertexCount() - 1;
    middle = hair.state.positions[vertex];
    frequency = std::sqrt(kStiffness / (hair.params.density * hair.mesh.vertex_volume[vertex]));
    hair.pins = {{vertex, middle, Vec3::Zero(), kStiffness}};
    hair.state.positions[vertex] += kAcross * axis();
  }
  static Vec3 axis() { return Vec3(2, -1, 2) / 3; }
  // y = x - i v / w, of which y' = i w y.
  Complex amplitude() const {
    return {axis().dot(hair.state.positions[vertex] - middle), -axis().dot(hair.state.velocities[vertex]) / frequency};
  }
};

// The derivative, at the last of three times, of the parabola through three values, by Lagrange's formula: its weights.
std::array<double, 3> lastSlope(double t0, double t1, double t2) {
  return {(t2 - t1) / ((t0 - t1) * (t0 - t2)), (t2 - t0) / ((t1 - t0) * (t1 - t2)),
          (2 * t2 - t0 - t1) / ((t2 - t0) * (t2 - t1))};
}

TEST(TwoStep, EachStepIsTheParabolasWhateverTheStepBefore) {
  Oscillator one;
  const double unit = 0.4 / one.frequency;  // s
  double t0 = 0, t1 = 0;
  Complex y0, y1 = one.amplitude();
  for (const double length : {1.0, 1.0, 0.5, 0.5, 1.0, 2.0, 0.25, 1.0, 1.5, 3.0, 0.1, 0.2, 1.0}) {
    const double t2 = t1 + length * unit;
    ASSERT_EQ(one.hair.step(length * unit).recoveries, 0);
    // sum of weights times values = i w y2; the first step, without a step before, is implicit Euler's.
    const Complex turn(0, one.frequency);
    Complex expected = y1 / (1.0 - turn * (t2 - t1));
    if (t1 > 0) {
      const std::array<double, 3> weight = lastSlope(t0, t1, t2);
      expected = -(weight[0] * y0 + weight[1] * y1) / (weight[2] - turn);
    }
    const Complex y2 = one.amplitude();
    EXPECT_LT(std::abs(y2 - expected), 1e-9 * kAcross) << "a step of " << length << " at " << t1 / unit;
    t0 = t1, t1 = t2, y0 = y1, y1 = y2;
  }
}

// Steps as a governor changes them: alternating lengths, and two of each.
TEST(TwoStep, ChangingStepsKeepTheSecondOrder) {
  for (const auto& pattern :
       {std::array{1.0, 1.0, 1.0, 1.0}, std::array{1.0, 0.5, 1.0, 0.5}, std::array{2.0, 2.0, 1.0, 1.0}}) {
    std::vector<double> steps, errors;
    for (const int count : {40, 80, 160, 320}) {
      Oscillator one;
      const double end = 3 / one.frequency, sum = pattern[0] + pattern[1] + pattern[2] + pattern[3];
      for (int n = 0; n < count; ++n) one.hair.step(end * 4 / count * pattern[n % 4] / sum);
      const Complex exact = kAcross * std::polar(1.0, 3.0);
      steps.push_back(end / count), errors.push_back(std::abs(one.amplitude() - exact));
    }
    const double order = test::observedOrder(steps, errors);
    std::printf("steps of %.1f %.1f %.1f %.1f: order %.2f\n", pattern[0], pattern[1], pattern[2], pattern[3], order);
    EXPECT_NEAR(order, 2, 0.2);
    EXPECT_LT(errors.back(), 1e-3 * kAcross);
  }
}

// What no force acts on flies on at the velocity that the step has left it, corrected or not: a correction that does
// not restart the history comes back as a kick in the next step.
void expectStraightFlight(Hair& hair, double dt, const char* after) {
  const sim::HairState before = hair.state;
  hair.step(dt);
  for (int i = 0; i < hair.mesh.vertexCount(); ++i) {
    if (hair.mesh.isRoot(i)) continue;
    const Vec3 flown = hair.state.positions[i] - before.positions[i];
    EXPECT_LT((flown - dt * before.velocities[i]).norm(), 1e-9) << "vertex " << i << ", after " << after;
    EXPECT_LT((hair.state.velocities[i] - before.velocities[i]).norm(), 1e-7) << "vertex " << i << ", after " << after;
  }
}

TEST(TwoStep, CorrectedVerticesAndTheirFollowersGoOnAtTheirVelocity) {
  for (const bool follow : {false, true}) {
    for (const double next : {1.0 / 120, 1.0 / 60, 1.0 / 240}) {
      sim::SimParams params = freeParticles();
      params.minimize_deformation = follow;
      Hair hair(test::patchShape({}), params);
      constexpr double kStep = 1.0 / 120;
      for (int n = 0; n < 3; ++n) hair.step(kStep);
      hair.params.collide = true;
      // A ball that strikes the hair from the side within the step.
      sim::Ellipsoid ball;
      ball.radii = Vec3::Constant(0.05);
      ball.velocity = Vec3(2, 0, 0);
      ball.center = Vec3(-0.042, -0.15, 0.02);
      hair.bodies = {ball};
      const std::vector<Vec3> start = hair.state.positions;
      const sim::StepReport report = hair.step(kStep);
      EXPECT_GT(report.corrected, 0);
      EXPECT_EQ(report.initial_overlap, 0);
      int moved = 0;
      for (std::size_t i = 0; i < start.size(); ++i) moved += start[i] != hair.state.positions[i];
      EXPECT_TRUE(follow ? moved > report.corrected : moved > 0);
      hair.bodies.clear();
      hair.params.collide = false;
      expectStraightFlight(hair, next, follow ? "corrections that others followed" : "corrections");
    }
  }
}

// A ball pushes hair aside and stops within a step. The step before still moves, and the contact holds all the same:
// its vertices go where the ball carries them, as roots do with the scalp.
TEST(TwoStep, VerticesThatStickStopWithTheirBody) {
  sim::SimParams params;
  params.integrator = sim::Integrator::kBdf2;
  params.friction = 2;
  Hair hair(test::combedShape(test::mixedPatch(5, 0.25)), params);
  constexpr double kStep = 1.0 / 240, kSpeed = 0.1;
  sim::Ellipsoid ball;
  ball.radii = Vec3::Constant(0.1);
  ball.center = Vec3(-0.14, -0.15, 0);
  int stuck = 0;
  double strayed = 0;  // m along the surface, in the step of the stop
  for (int n = 0; n < 240; ++n) {
    const bool last = n == 239;
    ball.velocity = last ? Vec3::Zero() : Vec3(kSpeed, 0, 0);
    ball.center += kStep * ball.velocity;
    hair.bodies = {ball};
    const std::vector<Vec3> start = hair.state.positions;
    hair.step(kStep);
    if (!last) continue;
    for (const sim::Contact& contact : hair.state.contacts) {
      if (!contact.sticks) continue;
      const Vec3 moved = hair.state.positions[contact.vertex] - start[contact.vertex];
      strayed = std::max(strayed, (moved - moved.dot(contact.normal) * contact.normal).norm());
      ++stuck;
    }
  }
  std::printf("%d vertices stick, and stray by at most %.1e m\n", stuck, strayed);
  EXPECT_GT(stuck, 0);
  EXPECT_LT(strayed, 0.01 * kStep * kSpeed);
}

}  // namespace two_step_test
