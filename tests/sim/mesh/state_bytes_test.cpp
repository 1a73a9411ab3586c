// A state holds all that outlives a step: reset, compared, saved and restored as one.
#include "sim/mesh/state_bytes.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "sim/step.h"
#include "tests/sim_probes.h"
#include "tests/test_meshes.h"

namespace state_bytes_test {

using sim::Vec3;
using test::Hair;

constexpr double kFrame = 1.0 / 60;

sim::HairMeshShape patch() {
  return test::combedShape(test::mixedPatch(5, 0.25));
}

// One frame of a head that shakes and a body that comes, as a function of the frame's number alone.
void frame(int n, const std::vector<Vec3>& rest, Hair& hair) {
  hair.time = n * kFrame;
  const bool moves = n < 40;
  const Eigen::AngleAxisd turn(moves ? 0.5 * std::sin(0.3 * n) : 0, Vec3(0.3, 1, 0.2).normalized());
  for (std::size_t c = 0; c < rest.size(); ++c) hair.roots[c] = turn * rest[c];
  hair.bodies.resize(1);
  hair.bodies[0].radii = Vec3(0.05, 0.08, 0.06);
  hair.bodies[0].velocity = moves ? Vec3(0.3, 0, 0) : Vec3(Vec3::Zero());
  hair.bodies[0].center = Vec3(-0.1 + 0.3 * std::min(n, 40) * kFrame, -0.12, 0.02);
  hair.step(kFrame);
}

// What a hair does that differs from the plainest: parameters that are dragged, contacts of all kinds, integrators.
struct Way {
  const char* name;
  void (*set)(sim::SimParams&);
  bool gradual = false;
};
const Way kWays[] = {
    {"Plain", [](sim::SimParams&) {}},
    {"SelfContact", [](sim::SimParams& p) { p.self_collide = true; }},
    {"Bdf2InDouble",
     [](sim::SimParams& p) { p.integrator = sim::Integrator::kBdf2, p.precision = sim::Precision::kDouble; }},
    {"Paper", [](sim::SimParams& p) { p.solver = sim::Solver::kPaper; }},
    {"DraggedSlider", [](sim::SimParams&) {}, true},
    {"Collided", [](sim::SimParams& p) { p.collide_inner = true; }},
};

void PrintTo(const Way& way, std::ostream* out) {
  *out << way.name;
}

class State : public testing::TestWithParam<Way> {
 protected:
  // Frames [first, end); the slider of the bend is dragged through some of them.
  void play(int first, int end, Hair& hair) const {
    const std::vector<Vec3> rest = test::rootsOf(hair.mesh, hair.mesh.shape.positions);
    hair.context.refreshGradually(GetParam().gradual);
    for (int n = first; n < end; ++n) {
      if (GetParam().gradual && n >= 15 && n < 35) hair.params.bend *= 1.1;
      frame(n, rest, hair);
    }
  }
  sim::SimParams params() const {
    sim::SimParams p;
    GetParam().set(p);
    return p;
  }
};

TEST_P(State, RestoredInANewContextGoesOnInTheSameBits) {
  for (const int moment : {1, 13, 37, 50, 90}) {
    Hair hair(patch(), params()), other(patch(), params());
    play(0, moment, hair);
    const std::vector<std::byte> bytes = sim::saveState(hair.mesh, hair.state);
    ASSERT_EQ(sim::loadState(other.mesh, bytes, other.state), "");
    EXPECT_TRUE(test::sameBits(hair.state, other.state));
    other.params = hair.params;
    for (Hair* one : {&hair, &other}) play(moment, moment + 40, *one);
    EXPECT_TRUE(test::sameBits(hair.state, other.state)) << "from frame " << moment;
  }
}

TEST_P(State, TwoHairsWithDifferentPastsAreTheSameAfterAResetAndGoOnTheSame) {
  Hair hair(patch(), params()), other(patch(), params());
  play(0, 30, hair);
  play(20, 75, other);
  for (Hair* one : {&hair, &other}) {
    one->state = sim::restState(one->mesh, Eigen::Isometry3d::Identity());
    one->params = params();
  }
  EXPECT_TRUE(test::sameBits(hair.state, other.state));
  for (Hair* one : {&hair, &other}) play(0, 50, *one);
  EXPECT_TRUE(test::sameBits(hair.state, other.state));
}

// A context holds what follows from mesh and parameters, and scratch: it can serve two hairs in turn.
TEST_P(State, OneContextServesTwoHairs) {
  Hair hair(patch(), params()), other(patch(), params());
  play(0, 60, hair);
  sim::HairState first = sim::restState(other.mesh, Eigen::Isometry3d::Identity()), second = first;
  sim::SimParams first_params = other.params, second_params = other.params;
  for (int n = 0; n < 60; ++n) {
    std::swap(other.state, first), std::swap(other.params, first_params);
    play(n, n + 1, other);
    std::swap(other.state, first), std::swap(other.params, first_params);
    std::swap(other.state, second), std::swap(other.params, second_params);
    play(n + 20, n + 21, other);
    std::swap(other.state, second), std::swap(other.params, second_params);
  }
  EXPECT_TRUE(test::sameBits(hair.state, first));
}

INSTANTIATE_TEST_SUITE_P(Of, State, testing::ValuesIn(kWays),
                         [](const testing::TestParamInfo<Way>& way) { return std::string(way.param.name); });

TEST(StateBytes, OneChangedBitAnywhereIsTold) {
  Hair hair(patch(), {});
  for (int n = 0; n < 5; ++n) hair.step(kFrame);
  const auto differs = [&](const auto& change) {
    sim::HairState other = hair.state;
    change(other);
    return !test::sameBits(hair.state, other);
  };
  EXPECT_FALSE(differs([](sim::HairState&) {}));
  EXPECT_TRUE(differs([](sim::HairState& s) { s.positions.back().z() = -s.positions.back().z(); }));
  EXPECT_TRUE(differs([](sim::HairState& s) { s.memory.good.velocities.front().x() += 1e-300; }));
  EXPECT_TRUE(differs([](sim::HairState& s) { s.memory.recovery.columns.back().upright += 1; }));
  EXPECT_TRUE(differs([](sim::HairState& s) { s.memory.rest.reference.front().positions.front().x() += 1; }));
  EXPECT_TRUE(differs([](sim::HairState& s) { s.memory.material.balanced.bend += 1; }));
}

TEST(StateBytes, WhatCannotBeRestoredSaysWhyAndChangesNothing) {
  Hair hair(patch(), {}), other(test::combedShape(test::mixedPatch(4, 0.25)), {});
  for (int n = 0; n < 3; ++n) hair.step(kFrame);
  const std::vector<std::byte> bytes = sim::saveState(hair.mesh, hair.state);
  sim::HairState state = sim::restState(hair.mesh, Eigen::Isometry3d::Identity());
  const sim::HairState before = state;
  const auto fault = [&](std::vector<std::byte> given) { return sim::loadState(hair.mesh, given, state); };
  const auto changed = [&](std::size_t at) {
    std::vector<std::byte> copy = bytes;
    copy[at] ^= std::byte{1};
    return copy;
  };
  EXPECT_NE(fault({}).find("is no saved state"), std::string::npos);
  EXPECT_NE(fault(changed(0)).find("is no saved state"), std::string::npos);
  EXPECT_NE(fault(changed(8)).find("version"), std::string::npos);
  EXPECT_NE(fault({bytes.begin(), bytes.end() - 1}).find("bytes where"), std::string::npos);
  for (const std::size_t at : {std::size_t{40}, bytes.size() / 2, bytes.size() - 1})
    EXPECT_NE(fault(changed(at)).find("has been changed"), std::string::npos) << at;
  EXPECT_NE(sim::loadState(other.mesh, bytes, state).find("another hair mesh"), std::string::npos);
  EXPECT_TRUE(test::sameBits(state, before));
  EXPECT_EQ(fault(bytes), "");
  EXPECT_TRUE(test::sameBits(state, hair.state));
}

// Bytes that are whole, but of a hand that knows another mesh.
TEST(StateBytes, ContactsOfVerticesThatAreNotThereAreRefused) {
  Hair hair(patch(), {});
  hair.step(kFrame);
  sim::HairState state = hair.state;
  for (const int vertex : {-1, hair.mesh.vertexCount()}) {
    sim::HairState strange = hair.state;
    strange.contacts.push_back({.vertex = vertex});
    EXPECT_NE(sim::loadState(hair.mesh, sim::saveState(hair.mesh, strange), state), "") << vertex;
    EXPECT_TRUE(test::sameBits(state, hair.state));
  }
  sim::HairState touching = hair.state;
  touching.contacts.push_back({.vertex = hair.mesh.vertexCount() - 1});
  EXPECT_EQ(sim::loadState(hair.mesh, sim::saveState(hair.mesh, touching), state), "");
}

// Fields come and go with kStateVersion: when this fails, count it up and enter the new number.
TEST(StateBytes, TheVersionSpeaksOfTheseFields) {
  Hair hair(patch(), {});
  EXPECT_EQ(sim::kStateVersion, 3u);
  EXPECT_EQ(sim::saveState(hair.mesh, {}).size(), 1157u);
}

}  // namespace state_bytes_test
