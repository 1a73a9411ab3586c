// The measure of roughness in time, and the tolerance that follows it.
#include "sim/motion_roughness.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/test_meshes.h"

namespace {

using sim::Vec3;

// The roughness of the last of many steps in which every vertex has velocity(t).
template <class Velocity>
double roughnessOf(const Velocity& velocity, double dt, int steps = 40) {
  const sim::HairMesh mesh = sim::buildHairMesh(test::combedShape({}));
  sim::MotionRoughness roughness(mesh);
  double last = 0;
  for (int n = 0; n < steps; ++n) {
    const std::vector<Vec3> velocities(mesh.vertexCount(), velocity(n * dt));
    last = roughness.at(mesh, velocities);
  }
  return last;
}

TEST(MotionRoughness, IsNothingUnderSteadyAccelerationAndWithoutHistory) {
  EXPECT_LT(roughnessOf([](double t) { return Vec3(0, -9.81 * t, 0); }, 1.0 / 60), 1e-9);
  EXPECT_EQ(roughnessOf([](double t) { return Vec3(std::sin(100 * t), 0, 0); }, 1.0 / 60, 2), 0);
  EXPECT_EQ(roughnessOf([](double) { return Vec3(1, 2, 3); }, 1.0 / 60), 0) << "no change, nothing to compare";
}

// v = (cos wt, sin wt): |d| and |d_n - d_(n-1)| are those of a regular polygon, their ratio 2 sin(w dt / 2).
TEST(MotionRoughness, OfATurningVelocityIsThatOfAPolygon) {
  for (const double turn : {0.05, 0.3, 1.0, 2.5}) {
    const double dt = 1.0 / 60;
    const auto velocity = [&](double t) { return Vec3(std::cos(turn * t / dt), std::sin(turn * t / dt), 0); };
    EXPECT_NEAR(roughnessOf(velocity, dt), 2 * std::sin(turn / 2), 1e-6) << turn;
  }
}

TEST(MotionRoughness, SmoothMotionIsSolvedToTheToleranceAndNoneBeyondTenTimesIt) {
  EXPECT_EQ(sim::toleranceFactor(0, 5), 1);
  EXPECT_EQ(sim::toleranceFactor(sim::kSmooth, 5), 1);
  EXPECT_DOUBLE_EQ(sim::toleranceFactor(sim::kSmooth + 0.4, 5), 3);
  EXPECT_EQ(sim::toleranceFactor(1e9, 5), sim::kMostSlack);
  EXPECT_EQ(sim::toleranceFactor(1e9, 0), 1);
  EXPECT_EQ(sim::toleranceFactor(INFINITY, 5), 1);
  EXPECT_EQ(sim::toleranceFactor(NAN, 5), 1);
}

}  // namespace
