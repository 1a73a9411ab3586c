// Buzzing: vertices that go to and fro with every step are brought to their balance, and no other motion is touched.
#include "sim/stabilization/oscillation_damping.h"

#include <gtest/gtest.h>

#include "sim/step.h"
#include "tests/test_meshes.h"

namespace oscillation_damping_test {

using sim::Vec3;

constexpr double kFrame = 1.0 / 60;

struct Patch {
  sim::HairMesh mesh = sim::buildHairMesh(test::combedShape(test::mixedPatch(5, 0.25)));
  sim::HairState state = sim::restState(mesh, Eigen::Isometry3d::Identity());

  Patch() { sim::sizeMemory(mesh, state.memory); }

  // A step that takes every vertex but the roots where `to` says, from where it is off its rest; roots and rest go
  // along with the head.
  int step(const Vec3& head, const auto& to) {
    const std::vector<Vec3> start = state.positions;
    for (int i = 0; i < mesh.vertexCount(); ++i) {
      const Vec3 rest = mesh.shape.positions[i] + gone;
      state.positions[i] = rest + head + (mesh.isRoot(i) ? Vec3(Vec3::Zero()) : to(i, Vec3(start[i] - rest)));
      state.velocities[i] = (state.positions[i] - start[i]) / kFrame;
    }
    gone += head;
    return sim::dampOscillation(mesh, start, state);
  }
  double furthest() const {
    double most = 0;
    for (int i = 0; i < mesh.vertexCount(); ++i)
      most = std::max(most, (state.positions[i] - mesh.shape.positions[i] - gone).norm());
    return most;
  }
  Vec3 gone = Vec3::Zero();
};

TEST(OscillationDamping, WhatGoesToAndFroWithEveryStepComesToRestUnderAMovingHeadToo) {
  for (const double eigenvalue : {-1.0, -1.5, -2.5}) {
    for (const double speed : {0.0, 1.0}) {
      Patch hair;
      for (int i = 0; i < hair.mesh.vertexCount(); ++i) {
        if (!hair.mesh.isRoot(i)) hair.state.positions[i] += Vec3(2e-4, 1e-4, 0);
      }
      int most = 0;
      for (int n = 0; n < 200; ++n) {
        most = std::max(most, hair.step(speed * kFrame * Vec3::UnitX(), [&](int, const Vec3& off) {
          // The oscillation is bounded, as in hair: far from rest the vertex is drawn back.
          return Vec3(eigenvalue * off / (1 + off.norm() / 0.002));
        }));
      }
      EXPECT_GT(most, 0);
      // The rest is below the threshold of an oscillation, but for the few steps that detect it again.
      EXPECT_LT(hair.furthest(), 3e-4) << eigenvalue << " at " << speed << " m/s";
    }
  }
}

TEST(OscillationDamping, OtherMotionKeepsEveryBit) {
  Patch hair;
  for (int n = 0; n < 300; ++n) {
    // The fastest swing that so long steps show as one: five there and five back, the head with it or not.
    const double way = 0.005 * std::abs(n % 10 - 5);
    const auto swing = [&](int i, const Vec3&) { return Vec3(0.01 * std::sin(0.1 * i), way, 0); };
    EXPECT_EQ(hair.step(Vec3(n % 2 ? -0.01 : 0.01, 0, 0), swing), 0) << "step " << n;
  }
  EXPECT_EQ(hair.step(Vec3::Zero(), [](int, const Vec3& off) { return off; }), 0);
}

// A clip at fifty times its speed throws the head to and fro with every frame, and the hair that lags behind it.
TEST(OscillationDamping, HairThatTheHeadThrowsToAndFroKeepsEveryBit) {
  Patch hair;
  for (int n = 0; n < 60; ++n) {
    const Vec3 head(n % 2 ? -0.02 : 0.02, 0, 0);
    const auto lag = [&](int, const Vec3&) { return Vec3(n % 2 ? 0.0 : -0.015, 0, 0); };
    EXPECT_EQ(hair.step(head, lag), 0) << "step " << n;
  }
}

}  // namespace oscillation_damping_test
