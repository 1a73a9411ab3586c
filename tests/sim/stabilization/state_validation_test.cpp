// State validation repairs faulty vertices and no others, reports the fault, and distinguishes a teleport from a
// motion.
#include "sim/stabilization/state_validation.h"

#include <gtest/gtest.h>

#include <limits>
#include <queue>

#include "sim/mesh/rigid_motion.h"
#include "tests/sim_probes.h"
#include "tests/test_meshes.h"

namespace state_validation_test {

using sim::Vec3;
using test::Hair;

constexpr double kFrame = 1.0 / 60;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

test::PatchOptions patch() {
  test::PatchOptions o;
  o.nx = 4, o.nz = 3, o.layers = 7, o.length = 0.25, o.mixed = true;
  return o;
}

sim::SimParams runningHair() {
  sim::SimParams params = test::tautHair();
  params.tolerance = 1e-4, params.acceleration_tolerance = 1e-3;
  return params;
}

// Roots that sway, so that the hair is in motion.
void sway(double time, const std::vector<Vec3>& rest, Hair& hair) {
  for (std::size_t c = 0; c < rest.size(); ++c) hair.roots[c] = rest[c] + Vec3(0.05 * std::sin(6 * time), 0, 0);
}

// Edges of the system's pattern between each vertex and the one that is given.
std::vector<int> distancesFrom(const sim::HairMesh& mesh, int vertex) {
  const sim::BlockPattern pattern = sim::systemPattern(mesh);
  std::vector<std::vector<int>> neighbours(mesh.vertexCount());
  for (int i = 0; i < mesh.vertexCount(); ++i) {
    for (int k = pattern.row_first[i]; k < pattern.row_first[i + 1]; ++k) {
      neighbours[i].push_back(pattern.columns[k]);
      neighbours[pattern.columns[k]].push_back(i);
    }
  }
  std::vector<int> distance(mesh.vertexCount(), 1000);
  std::queue<int> open;
  distance[vertex] = 0;
  for (open.push(vertex); !open.empty(); open.pop()) {
    for (const int next : neighbours[open.front()]) {
      if (distance[next] < 1000) continue;
      distance[next] = distance[open.front()] + 1;
      open.push(next);
    }
  }
  return distance;
}

TEST(StateValidation, RepairsFaultsAtRandomVerticesAndNothingElse) {
  Hair hair(test::combedShape(patch()), runningHair()), reference(test::combedShape(patch()), runningHair());
  const auto rest = hair.roots;
  test::Random random(11);
  const double faults[] = {kNaN, kInfinity, -kInfinity, 1e30, 1e6};
  double time = 0;
  int injected = 0, found = 0, roots = 0;
  for (int n = 1; n <= 400; ++n) {
    time += kFrame;
    sway(time, rest, hair), sway(time, rest, reference);
    int vertex = -1;
    if (n > 20 && n % 8 == 0) {
      reference.state = hair.state;  // what differs from here on is the fault's doing
      vertex = static_cast<int>(random(0, hair.mesh.vertexCount()));
      if (n % 40 == 0) vertex = hair.mesh.shape.column_first[hair.mesh.column_of[vertex]];
      Vec3& value = random(0, 1) < 0.5 ? hair.state.positions[vertex] : hair.state.velocities[vertex];
      value[static_cast<int>(random(0, 3))] = faults[static_cast<int>(random(0, 5))];
      ++injected;
    }
    const sim::StepReport report = hair.step(kFrame);
    reference.step(kFrame);
    for (int i = 0; i < hair.mesh.vertexCount(); ++i) {
      ASSERT_TRUE(hair.state.positions[i].allFinite() && hair.state.velocities[i].allFinite()) << i;
    }
    if (vertex < 0) {
      EXPECT_EQ(report.recoveries, 0) << n;
      continue;
    }
    EXPECT_EQ(report.recoveries, 1);
    EXPECT_EQ(report.fault_report.vertex, vertex);
    EXPECT_EQ(report.fault_report.vertices, 1);
    EXPECT_TRUE(report.fault_report.given);
    const std::string text = sim::faultText(report.fault_report);
    EXPECT_NE(text.find("vertex " + std::to_string(vertex) + " (column "), std::string::npos) << text;
    EXPECT_NE(text.find("largest force there: "), std::string::npos) << text;
    roots += hair.mesh.isRoot(vertex);
    found += report.recoveries;
    // The repaired vertex was put back and lost half of its speed relative to its root.
    const std::vector<int> distance = distancesFrom(hair.mesh, vertex);
    for (int i = 0; i < hair.mesh.vertexCount(); ++i) {
      const double moved = (hair.state.positions[i] - reference.state.positions[i]).norm() / hair.mesh.hair_length;
      EXPECT_LT(moved, distance[i] == 0 ? 0.03 : distance[i] == 1 ? 0.02 : 0.01) << "vertex " << i;
    }
  }
  EXPECT_GT(injected, 40);
  EXPECT_GT(roots, 8);
  EXPECT_EQ(found, injected);
}

TEST(StateValidation, ARepairChangesNoBitOfOtherVertices) {
  Hair hair(test::combedShape(patch()), runningHair());
  for (int n = 0; n < 10; ++n) hair.step(kFrame);
  const sim::GoodState good{hair.state.positions, hair.state.velocities};
  for (int vertex = 0; vertex < hair.mesh.vertexCount(); ++vertex) {
    sim::HairState state = hair.state;
    state.positions[vertex].y() = 1e6;
    sim::FaultReport fault_report;
    sim::repair(hair.mesh, hair.roots, {good.positions, good.velocities}, state, fault_report);
    EXPECT_EQ(fault_report.vertices, 1);
    EXPECT_EQ(fault_report.vertex, vertex);
    for (int i = 0; i < hair.mesh.vertexCount(); ++i) {
      // A root is put where the others say, to rounding.
      const double off = (state.positions[i] - hair.state.positions[i]).norm();
      EXPECT_LE(off, i == vertex && hair.mesh.isRoot(i) ? 1e-12 : 0) << vertex << " " << i;
      if (i != vertex) {
        EXPECT_EQ(state.velocities[i], hair.state.velocities[i]);
      }
    }
  }
}

TEST(StateValidation, RepairsManyFaultsAtOnceAndTheHairComesBack) {
  Hair hair(test::combedShape(patch()), runningHair());
  test::Random random(3);
  for (int n = 0; n < 30; ++n) hair.step(kFrame);
  for (Vec3& x : hair.state.positions) x = Vec3(kNaN, kInfinity, 1e20);
  for (Vec3& v : hair.state.velocities) v = Vec3(1e9, kNaN, 0);
  const sim::StepReport report = hair.step(kFrame);
  EXPECT_EQ(report.recoveries, 1);
  for (int n = 0; n < 120; ++n) EXPECT_EQ(hair.step(kFrame).recoveries, 0);
  EXPECT_LT(test::largestDistance(hair.state.positions, hair.mesh.shape.positions), 0.01 * hair.mesh.hair_length);
}

TEST(StateValidation, APlaceBeyondReachIsAbsurdAndAWildOneIsNot) {
  Hair hair(test::patchShape(patch()), runningHair());
  const int tip = hair.mesh.shape.column_first[1] - 1;
  const Vec3 there = hair.state.positions[tip];
  hair.state.positions[tip] = there + Vec3(3 * hair.mesh.hair_length, 0, 0);
  EXPECT_EQ(sim::examine(hair.mesh, hair.state, tip), sim::StateFault::kNone);
  hair.state.positions[tip] = there + Vec3(1.5, 0, 0);  // as a foot in a fast backflip may take it
  EXPECT_EQ(sim::examine(hair.mesh, hair.state, tip), sim::StateFault::kNone);
  hair.state.positions[tip] = there + Vec3(10, 0, 0);
  EXPECT_EQ(sim::examine(hair.mesh, hair.state, tip), sim::StateFault::kFarAway);
  hair.state.positions[tip] = there;
  hair.state.velocities[tip] = Vec3(0, 100, 0);
  EXPECT_EQ(sim::examine(hair.mesh, hair.state, tip), sim::StateFault::kNone);
  hair.state.velocities[tip] = Vec3(0, 1e4, 0);
  EXPECT_EQ(sim::examine(hair.mesh, hair.state, tip), sim::StateFault::kTooFast);
  hair.state.velocities[tip] = Vec3(0, kNaN, 0);
  EXPECT_EQ(sim::examine(hair.mesh, hair.state, tip), sim::StateFault::kNotFinite);
}

TEST(StateValidation, NamesTheElementThatPullsHardest) {
  const Hair hair(test::patchShape(patch()), runningHair());
  const sim::BlockPattern pattern = sim::systemPattern(hair.mesh);
  const sim::ForceModel<double> model = test::makeForceModel(hair.mesh, pattern, hair.params);
  sim::FaultReport fault_report;
  fault_report.vertex = hair.mesh.shape.column_first[3] - 1;
  std::vector<sim::V3<double>> x = test::plain<double>(hair.state.positions);
  x[fault_report.vertex].y -= 0.05;  // a tip pulled along its column
  sim::nameForce(model, x, fault_report);
  EXPECT_STREQ(fault_report.force, "stretch");
  const auto& ends = model.of<sim::Stretch>().vertices[fault_report.element];
  EXPECT_TRUE(ends[0] == fault_report.vertex || ends[1] == fault_report.vertex);
}

// A sequence of motions of the roots, each taken within one step.
Eigen::Isometry3d jump(double metres, double radians) {
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  motion = Eigen::Translation3d(metres, 0.2 * metres, 0) * Eigen::AngleAxisd(radians, Vec3(1, 2, 0).normalized());
  return motion;
}

TEST(Teleport, AJumpThatNoMotionCouldMakeCarriesTheHairAlong) {
  Hair hair(test::combedShape(patch()), runningHair());
  const auto rest = hair.roots;
  for (int n = 1; n <= 30; ++n) {
    sway(n * kFrame, rest, hair);
    EXPECT_FALSE(hair.step(kFrame).carried);
  }
  const sim::HairState before = hair.state;
  const Eigen::Isometry3d motion = jump(10, 1);
  Hair reference(test::combedShape(patch()), runningHair());
  reference.state = before, reference.roots = hair.roots, reference.time = hair.time;
  // Gravity alone would tell the two worlds apart.
  hair.params.gravity = reference.params.gravity = 0;
  reference.step(kFrame);
  for (Vec3& root : hair.roots) root = motion * root;
  const sim::StepReport report = hair.step(kFrame);
  EXPECT_TRUE(report.carried);
  EXPECT_EQ(report.recoveries, 0);
  // The shape of the hair that was not teleported.
  for (int i = 0; i < hair.mesh.vertexCount(); ++i) {
    EXPECT_LT((hair.state.positions[i] - motion * reference.state.positions[i]).norm(), 1e-3) << i;
  }
}

TEST(Teleport, TheThresholdIsTheParameters) {
  for (const double share : {0.9, 1.1}) {
    Hair hair(test::combedShape(patch()), runningHair());
    hair.params.teleport_speed = 40;
    for (Vec3& root : hair.roots) root += Vec3(share * 40 * kFrame, 0, 0);
    EXPECT_EQ(hair.step(kFrame).carried, share > 1);
  }
}

TEST(Teleport, CarryingAlongKeepsShapeAndVelocityAgainstTheHead) {
  Hair hair(test::combedShape(patch()), runningHair());
  const auto rest = hair.roots;
  for (int n = 1; n <= 20; ++n) sway(n * kFrame, rest, hair), hair.step(kFrame);
  const sim::HairState before = hair.state;
  const Eigen::Isometry3d from = jump(0.3, 0.2), to = jump(5, 2);
  const Eigen::Isometry3d motion = to * from.inverse();
  sim::carryAlong(from, to, hair.state);
  for (int i = 0; i < hair.mesh.vertexCount(); ++i) {
    EXPECT_LT((hair.state.positions[i] - motion * before.positions[i]).norm(), 1e-12);
    EXPECT_LT((hair.state.velocities[i] - motion.linear() * before.velocities[i]).norm(), 1e-12);
  }
}

// What a two-step integrator remembers comes along as well: without gravity the next step is the one that would have
// been taken, moved.
TEST(Teleport, CarriedHairTakesTheStepThatItWouldHaveTaken) {
  sim::SimParams params = runningHair();
  params.integrator = sim::Integrator::kBdf2;
  Hair hair(test::combedShape(patch()), params);
  const auto rest = hair.roots;
  for (int n = 1; n <= 20; ++n) sway(n * kFrame, rest, hair), hair.step(kFrame);
  // Only the reference may know the way up.
  hair.params.gravity = 0;
  Hair stays(test::combedShape(patch()), hair.params);
  stays.state = hair.state, stays.roots = hair.roots, stays.time = hair.time;
  stays.step(kFrame);
  const Eigen::Isometry3d motion = jump(5, 2);
  sim::carryAlong(Eigen::Isometry3d::Identity(), motion, hair.state);
  for (Vec3& root : hair.roots) root = motion * root;
  EXPECT_FALSE(hair.step(kFrame).carried);
  for (int i = 0; i < hair.mesh.vertexCount(); ++i) {
    EXPECT_LT((hair.state.positions[i] - motion * stays.state.positions[i]).norm(), 1e-4) << i;
    EXPECT_LT((hair.state.velocities[i] - motion.linear() * stays.state.velocities[i]).norm(), 1e-2) << i;
  }
}

// A body that jumps with the head has the velocity of its jump, and hair that lies on it must not feel it.
TEST(Teleport, HairOnABodyThatJumpsWithTheHeadStaysOnIt) {
  sim::Ellipsoid body;
  body.center = Vec3(0.04, -0.15, -0.05);
  body.radii = Vec3(0.09, 0.06, 0.05);
  Hair hair(test::combedShape(patch()), runningHair());
  hair.bodies = {body};
  for (int n = 0; n < 60; ++n) hair.step(kFrame);
  ASSERT_GT(hair.state.contacts.size(), 2u);
  hair.params.gravity = 0;  // the jump turns it against the hair
  Hair stays(test::combedShape(patch()), hair.params);
  stays.state = hair.state, stays.bodies = hair.bodies, stays.time = hair.time;
  stays.step(kFrame);
  const Eigen::Isometry3d motion = jump(10, 1);
  for (Vec3& root : hair.roots) root = motion * root;
  sim::Ellipsoid& moved = hair.bodies[0];
  moved.center = motion * body.center;
  moved.rotation = Eigen::Quaterniond(motion.linear());
  moved.velocity = (moved.center - body.center) / kFrame;
  const Eigen::AngleAxisd turn(motion.linear());
  moved.angular_velocity = turn.axis() * turn.angle() / kFrame;
  const sim::StepReport report = hair.step(kFrame);
  EXPECT_TRUE(report.carried);
  EXPECT_EQ(report.recoveries, 0);
  for (int i = 0; i < hair.mesh.vertexCount(); ++i)
    EXPECT_LT((hair.state.positions[i] - motion * stays.state.positions[i]).norm(), 1e-3) << i;
}

// Points of a plane have two motions that bring them anywhere, of which one is a mirror image.
TEST(Teleport, AMotionOfFlatRootsIsNoMirrorImage) {
  for (const double radians : {0.0, 0.4, 2.0, 3.1}) {
    for (const bool flat : {false, true}) {
      std::vector<Vec3> from, to;
      test::Random random(3);
      const Eigen::Isometry3d motion = jump(2, radians);
      for (int i = 0; i < 9; ++i) {
        from.push_back(random.vector(1));
        if (flat) from.back().y() = 0;
        to.push_back(motion * from.back());
      }
      const Eigen::Isometry3d found = sim::rigidMotion(from, to);
      EXPECT_LT((found.matrix() - motion.matrix()).cwiseAbs().maxCoeff(), 1e-9) << radians << " " << flat;
    }
  }
}

}  // namespace state_validation_test
