// Hair that rests in another shape than its own is guided to that where its energy is lower, and nowhere else.
#include "sim/stabilization/reference_hair.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/test_meshes.h"

namespace reference_hair_test {

using sim::Vec3;
using test::Hair;

constexpr double kFrame = 1.0 / 60;
constexpr double kGravity = 9.81;  // m/s^2

// Hair that hangs still, bent to the side by a share of its length.
struct Resting {
  sim::HairMesh mesh = sim::buildHairMesh(test::combedShape(test::mixedPatch(5, 0.25)));
  sim::HairState state = sim::restState(mesh, Eigen::Isometry3d::Identity());
  std::vector<char> touched;
  bool self_contact = false;

  explicit Resting(double share) {
    sim::sizeMemory(mesh, state.memory);
    for (int i = 0; i < mesh.vertexCount(); ++i) {
      if (!mesh.isRoot(i)) state.positions[i].x() += share * mesh.hair_length;
    }
  }
  double off() const { return test::largestDistance(state.positions, mesh.shape.positions) / mesh.hair_length; }
  const sim::RestMemory& rest() const { return state.memory.rest; }
  sim::RestStep step() const { return {mesh, kFrame, kGravity, 1, self_contact}; }
  // Steps in which inversion recovery alone moves the hair, whose energy is `higher` (J) above the reference hair's.
  // Returns whether it was guided.
  bool pass(double seconds, double higher) {
    bool led = false;
    for (double t = 0; t < seconds; t += kFrame) {
      const std::vector<Vec3> start = state.positions;
      led = sim::recoverInversions({mesh, start, kFrame}, touched, state) > 0 || led;
      if (state.memory.recovery.guided_columns == 0)
        std::fill(state.velocities.begin(), state.velocities.end(), Vec3::Zero());
      const auto energy = [&](const sim::HairState& one) { return &one == &state ? higher : 0; };
      if (sim::watchRest(step(), state)) judgeRest(step(), energy, state);
    }
    return led;
  }
};

TEST(RestCheck, HairThatRestsElsewhereAndHigherIsGuidedToRest) {
  Resting hair(0.05);
  EXPECT_TRUE(hair.pass(3, 0.01));
  EXPECT_LT(hair.off(), 1e-9);
}

TEST(RestCheck, HairThatRestsNoHigherIsLeftWhereItIs) {
  Resting hair(0.05);
  EXPECT_FALSE(hair.pass(3, -0.01));
  EXPECT_NEAR(hair.off(), 0.05, 1e-12);
}

// A pendulum is slow at its turning point: a reference is at rest once it has been slow for half a second.
TEST(RestCheck, AReferenceThatFallsOnIsNotTakenWhereItIsSlow) {
  Resting hair(0.05);
  EXPECT_FALSE(hair.pass(0.4, 0.01));
  hair.state.memory.rest.still = 3;
  const auto energy = [&](const sim::HairState& one) { return &one == &hair.state ? 0.01 : 0; };
  sim::HairState& reference = hair.state.memory.rest.reference.front();
  for (double t = 0; t < 3; t += kFrame) {
    reference.velocities.back() = Vec3(0, std::fmod(t, 0.4) < 0.2 ? -0.1 : 0, 0);
    judgeRest(hair.step(), energy, hair.state);
    EXPECT_EQ(hair.state.memory.recovery.guided_columns, 0) << t << " s";
    EXPECT_FALSE(hair.rest().judged) << t << " s";
  }
  reference.velocities.back().setZero();
  EXPECT_TRUE(hair.pass(1, 0.01)) << "then it rests";
}

TEST(RestCheck, WithSelfContactAReferenceWithItIsComparedToo) {
  Resting hair(0.05);
  hair.self_contact = true;
  for (int n = 0; n < 60 && !hair.rest().kept_apart; ++n) EXPECT_FALSE(hair.pass(0.9 * kFrame, -0.01));
  EXPECT_TRUE(hair.rest().kept_apart);
  EXPECT_TRUE(hair.pass(3, 0.01)) << "the second found something lower";
  EXPECT_FALSE(hair.rest().kept_apart);
}

TEST(RestCheck, HairAtRestIsNotMoved) {
  Resting hair(0.001);
  EXPECT_FALSE(hair.pass(3, 0.01));
}

TEST(RestCheck, HairThatABodyHoldsIsLeftWhereItIs) {
  Resting hair(0.05);
  hair.state.contacts.emplace_back();
  EXPECT_FALSE(hair.pass(3, 0.01));
}

TEST(RestCheck, HairThatMovesIsNotJudged) {
  Resting hair(0.05);
  for (Vec3& v : hair.state.velocities) v = Vec3(1, 0, 0);
  EXPECT_FALSE(sim::watchRest(hair.step(), hair.state));
}

}  // namespace reference_hair_test
