// Coulomb friction at contacts: it holds and lets go where the law says, and only ever takes energy.
#include <gtest/gtest.h>

#include "sim/contact/contact.h"
#include "tests/test_meshes.h"

namespace friction_test {

using sim::Contact;
using sim::Ellipsoid;
using sim::Vec3;
using test::Hair;

constexpr double kFrame = 1.0 / 60;

// A particle (hair without stiffness) put at rest on a great sphere where the slope is `angle`: how fast it slides
// along the slope after `steps`.
double slideSpeed(double angle, double friction, int steps) {
  sim::SimParams params = test::looseParticles();
  params.friction = friction;
  test::PatchOptions o;
  o.nx = o.nz = 1, o.layers = 3, o.length = 0.1;
  Hair hair(test::patchShape(o), params);
  const int tip = hair.mesh.shape.column_first[1] - 1;
  const Vec3 normal(std::sin(angle), std::cos(angle), 0), down(std::cos(angle), -std::sin(angle), 0);
  constexpr double kRadius = 50;
  const Vec3 foot = hair.state.positions[tip] - params.contact_offset * normal;
  Ellipsoid hill;
  hill.center = foot - kRadius * normal, hill.radii = Vec3::Constant(kRadius);
  hair.bodies = {hill};
  double speed = 0;
  for (int n = 0; n < steps; ++n) {
    const sim::StepReport report = hair.step(kFrame);
    EXPECT_EQ(report.recoveries, 0);
    // The other vertices are of no interest: they stay where they are.
    for (int i = 0; i < hair.mesh.vertexCount(); ++i) {
      if (i != tip) hair.state.positions[i] = hair.mesh.shape.positions[i], hair.state.velocities[i].setZero();
    }
    std::erase_if(hair.state.contacts, [&](const Contact& c) { return c.vertex != tip; });
    speed = hair.state.velocities[tip].dot(down);
    EXPECT_NEAR(sim::closestPoint(hair.bodies[0], hair.state.positions[tip]).distance, params.contact_offset, 2e-4);
  }
  return speed;
}

// A vertex on level ground that slid along +x, and is pushed back.
Contact sliding(double pressure) {
  Contact contact;
  contact.normal = Vec3::UnitY();
  contact.friction_direction = -Vec3::UnitX();
  contact.pressure = pressure;
  return contact;
}

TEST(Friction, ThatTurnsAVertexBackHoldsItInstead) {
  const sim::FrictionLaw law{0.3, 0.01, 1e-4};
  const Vec3 reaction(0, 2, 0);
  Contact still_slides = sliding(1);
  EXPECT_FALSE(sim::updateSticking(law, reaction, Vec3(0.5, 0, 0), still_slides));
  EXPECT_FALSE(still_slides.sticks);
  EXPECT_EQ(still_slides.pressure, 2);

  Contact thrown = sliding(100);  // 0.3 N s at 1 m/s backwards
  EXPECT_TRUE(sim::updateSticking(law, reaction, Vec3(-1, 0, 0), thrown));
  EXPECT_TRUE(thrown.sticks);
  // However hard it is held sideways, it does not slide again in this step; but it goes where it would pull.
  EXPECT_FALSE(sim::updateSticking(law, Vec3(50, 2, 0), Vec3::Zero(), thrown));
  EXPECT_TRUE(thrown.sticks);
  EXPECT_TRUE(sim::updateSticking(law, Vec3(50, -2, 0), Vec3::Zero(), thrown));
  EXPECT_FALSE(thrown.sticks);
  EXPECT_EQ(thrown.pressure, 0);

  Contact barely = sliding(1);  // what it gains is not worth another solve
  EXPECT_FALSE(sim::updateSticking(law, reaction, Vec3(-0.01, 0, 0), barely));
  EXPECT_FALSE(barely.sticks);
}

TEST(Friction, HoldsWithinItsConeAndLetsGoBeyond) {
  const sim::FrictionLaw law{0.3, 0.01, 1e-4};
  Contact held = sliding(1.5);
  held.friction_direction.setZero();
  held.sticks = true;
  EXPECT_FALSE(sim::updateSticking(law, Vec3(0.59, 2, 0), Vec3::Zero(), held));
  EXPECT_TRUE(held.sticks);
  EXPECT_EQ(held.pressure, 2);
  held.pressure = 1.5;
  EXPECT_TRUE(sim::updateSticking(law, Vec3(0.61, 2, 0), Vec3::Zero(), held));
  EXPECT_FALSE(held.sticks);
  EXPECT_NEAR((held.friction_direction - Vec3::UnitX()).norm(), 0, 1e-12);
  EXPECT_EQ(held.pressure, 1.5) << "sticking presses harder than sliding will";
}

TEST(Friction, HoldsBelowTheFrictionAngleAndSlidesAboveItAtCoulombsRate) {
  constexpr int kSteps = 20;
  for (const double friction : {0.0, 0.3, 0.6}) {
    const double limit = std::atan(friction);
    for (const double angle : {limit - 0.1, limit + 0.1, limit + 0.3}) {
      if (angle <= 0) continue;
      const double speed = slideSpeed(angle, friction, kSteps);
      const double expected = 9.81 * (std::sin(angle) - friction * std::cos(angle)) * kSteps * kFrame;
      std::printf("friction %.1f, slope %.2f rad: slides at %.3f m/s, Coulomb %.3f\n", friction, angle, speed,
                  std::max(0.0, expected));
      if (angle < limit) {
        EXPECT_LT(std::abs(speed), 1e-3);
      } else {
        // Friction starts a step late, since it follows from the last solve's pressure.
        EXPECT_GT(speed, 0.98 * expected);
        EXPECT_LT(speed, 1.02 * expected + friction * 9.81 * std::cos(angle) * kFrame);
      }
    }
  }
}

}  // namespace friction_test
