// Pins: springs and firm holds from hair mesh vertices to points that move.
#include <gtest/gtest.h>

#include "sim/forces/model.h"
#include "sim/stabilization/safety_nets.h"
#include "tests/sim_probes.h"
#include "tests/test_meshes.h"

namespace pin_test {

using sim::PinnedVertex;
using sim::Vec3;
using test::Hair;

constexpr double kFrame = 1.0 / 60;

sim::SimParams usualHair() {
  sim::SimParams params;
  params.collide = false;
  return params;
}

test::PatchOptions patch() {
  return test::mixedPatch(7, 0.2);
}

int tipOf(const Hair& hair, int column) {
  return hair.mesh.shape.column_first[column + 1] - 1;
}

double mass(const Hair& hair, int vertex) {
  return hair.params.density * hair.mesh.vertex_volume[vertex];
}

// Loose particles feel their pin and their weight alone: x = target - m g / k.
TEST(Pin, AVertexHangsFromItsSpringAsTheSpringLawSays) {
  for (const auto integrator : {sim::Integrator::kLinearizedEuler, sim::Integrator::kBdf2}) {
    sim::SimParams params = test::looseParticles();
    params.integrator = integrator;
    params.air_drag = 5;
    params.collide = false;
    Hair hair(test::patchShape(patch()), params);
    const int tip = tipOf(hair, 3);
    const Vec3 target = hair.state.positions[tip];
    const double stiffness = mass(hair, tip) * 400;
    hair.pins = {{tip, target, Vec3::Zero(), stiffness}};
    sim::StepReport report;
    for (int k = 0; k < 900; ++k) report = hair.step(kFrame);
    const Vec3 sag(0, -mass(hair, tip) * params.gravity / stiffness, 0);
    EXPECT_LT((hair.state.positions[tip] - target - sag).norm(), 1e-6 * sag.norm());
    EXPECT_NEAR(report.pin_force, mass(hair, tip) * params.gravity, 1e-6 * mass(hair, tip) * params.gravity);
    EXPECT_EQ(report.pins, 1);
  }
}

// A vertex of a whole mesh: what the spring pulls is what the hair's forces pull back with.
TEST(Pin, ASpringsPullBalancesTheHairsForces) {
  sim::SimParams params = test::tautHair();
  params.collide = false;
  params.air_drag = 5;
  Hair hair(test::combedShape(patch()), params);
  const int tip = tipOf(hair, 7);
  const Vec3 target = hair.state.positions[tip] + Vec3(0.01, 0.004, -0.006);
  hair.pins = {{tip, target, Vec3::Zero(), 2.0}};
  for (int k = 0; k < 1200; ++k) hair.step(kFrame);
  const auto model = test::makeForceModel(hair.mesh, sim::systemPattern(hair.mesh), params);
  std::vector<sim::V3<double>> force(hair.mesh.vertexCount(), {0, 0, 0});
  sim::Evaluation<double> out;
  out.force = force;
  sim::evaluate<double>(model, test::plain<double>(hair.state.positions), out);
  const Vec3 weight(0, -mass(hair, tip) * params.gravity, 0), pull = 2.0 * (target - hair.state.positions[tip]);
  EXPECT_GT(pull.norm(), 1e-3);
  EXPECT_LT((test::eigen(force[tip]) + weight + pull).norm(), 1e-4 * pull.norm());
}

// The roots turned and moved about as a head is shaken, the pins' targets with them.
template <class Check>
void shakeHead(Hair& hair, const Check& check) {
  const std::vector<Vec3> roots = hair.roots;
  const std::vector<PinnedVertex> pins = hair.pins;
  const auto headAt = [](double t) {
    Eigen::Isometry3d head = Eigen::Isometry3d::Identity();
    head.linear() = Eigen::AngleAxisd(0.9 * std::sin(9 * t), Vec3(0.2, 1, 0.1).normalized()).toRotationMatrix();
    head.translation() = Vec3(0.1 * std::sin(5 * t), 0, 0.05 * std::sin(7 * t));
    return head;
  };
  for (int k = 1; k <= 180; ++k) {
    const Eigen::Isometry3d now = headAt(k * kFrame), before = headAt((k - 1) * kFrame);
    for (std::size_t c = 0; c < roots.size(); ++c) hair.roots[c] = now * roots[c];
    for (std::size_t p = 0; p < pins.size(); ++p) {
      hair.pins[p].target = now * pins[p].target;
      hair.pins[p].velocity = (hair.pins[p].target - before * pins[p].target) / kFrame;
    }
    check(hair.step(kFrame));
  }
}

TEST(Pin, AFirmOneHoldsThroughAHeadShake) {
  for (const auto solver : {sim::Solver::kPaper, sim::Solver::kDefault}) {
    for (const auto precision : {sim::Precision::kFloat, sim::Precision::kDouble}) {
      sim::SimParams params = usualHair();
      params.solver = solver, params.precision = precision;
      params.collide = true;
      Hair hair(test::combedShape(patch()), params);
      hair.bodies.push_back({Vec3(0.04, -0.25, 0), Eigen::Quaterniond::Identity(), Vec3(0.08, 0.1, 0.08)});
      for (const int column : {2, 9})
        hair.pins.push_back({tipOf(hair, column), hair.state.positions[tipOf(hair, column)]});
      double worst = 0, force = 0;
      shakeHead(hair, [&](const sim::StepReport& report) {
        for (const PinnedVertex& pin : hair.pins)
          worst = std::max(worst, (hair.state.positions[pin.vertex] - pin.target).norm());
        EXPECT_TRUE(std::isfinite(report.pin_force));
        EXPECT_EQ(report.pins, 2);
        EXPECT_EQ(report.recoveries, 0);
        force = std::max(force, report.pin_force);
      });
      EXPECT_LT(worst, 1e-6);
      EXPECT_GT(force, mass(hair, tipOf(hair, 2)) * 9.81);
      EXPECT_LT(force, 1e3);
    }
  }
}

// Head, hair and pin in even flight: no force acts, so that nothing changes but the place.
TEST(Pin, InEvenFlightItPullsNothing) {
  const Vec3 flight(3, 0.5, -2);  // m/s, faster than a pin closes in on its target
  for (const double stiffness : {20.0, double{INFINITY}}) {
    sim::SimParams params = usualHair();
    params.gravity = params.air_drag = 0;
    params.precision = sim::Precision::kDouble;
    params.tolerance = 1e-8, params.acceleration_tolerance = 0, params.displacement_tolerance = 0;
    Hair hair(test::combedShape(patch()), params);
    hair.context.safetyNets() = sim::kAsPublished;  // none may hide what the solve makes of the pin
    const std::vector<Vec3> rest = hair.state.positions, roots = hair.roots;
    for (Vec3& v : hair.state.velocities) v = flight;
    for (const int column : {2, 9}) hair.pins.push_back({tipOf(hair, column), {}, flight, stiffness});
    for (int k = 1; k <= 30; ++k) {
      const Vec3 way = k * kFrame * flight;
      for (std::size_t c = 0; c < roots.size(); ++c) hair.roots[c] = roots[c] + way;
      for (PinnedVertex& pin : hair.pins) pin.target = rest[pin.vertex] + way;
      hair.step(kFrame);
      for (std::size_t i = 0; i < rest.size(); ++i) {
        ASSERT_LT((hair.state.positions[i] - rest[i] - way).norm(), 1e-6) << i << " in step " << k;
        ASSERT_LT((hair.state.velocities[i] - flight).norm(), 1e-4) << i << " in step " << k;
      }
    }
  }
}

// A stiff spring is as good as a firm hold, and its damper lets it follow without lag.
TEST(Pin, AStiffSpringFollowsItsTarget) {
  for (const auto integrator : {sim::Integrator::kLinearizedEuler, sim::Integrator::kBdf2}) {
    sim::SimParams params = usualHair();
    params.integrator = integrator;
    Hair hair(test::combedShape(patch()), params);
    const int tip = tipOf(hair, 5);
    hair.pins = {{tip, hair.state.positions[tip], Vec3::Zero(), 2e3}};
    double worst = 0;
    shakeHead(hair, [&](const sim::StepReport& report) {
      worst = std::max(worst, (hair.state.positions[tip] - hair.pins[0].target).norm());
      EXPECT_EQ(report.recoveries, 0);
    });
    EXPECT_LT(worst, 2e-3);
  }
}

TEST(Pin, LetGoTheHairReturnsToRest) {
  for (const double stiffness : {5.0, double{INFINITY}}) {
    Hair hair(test::combedShape(patch()), usualHair());
    const std::vector<Vec3> rest = hair.state.positions;
    const int tip = tipOf(hair, 4);
    hair.pins = {{tip, rest[tip] + Vec3(0.05, 0.03, 0), Vec3::Zero(), stiffness}};
    for (int k = 0; k < 60; ++k) hair.step(kFrame);
    EXPECT_GT((hair.state.positions[tip] - rest[tip]).norm(), 0.01);
    hair.pins.clear();
    for (int k = 0; k < 600; ++k) EXPECT_EQ(hair.step(kFrame).recoveries, 0);
    EXPECT_LT(test::largestDistance(hair.state.positions, rest), 0.01 * hair.mesh.hair_length);
  }
}

// A firm pin that is far off closes in at a bounded speed; one out of reach lets go and is counted.
TEST(Pin, ReachesNoFartherThanHairStretches) {
  Hair hair(test::combedShape(patch()), usualHair());
  const int tip = tipOf(hair, 4);
  const Vec3 there = hair.state.positions[tip], target = there + Vec3(0.1, 0.1, 0);
  hair.pins = {{tip, target}};
  hair.step(kFrame);
  EXPECT_LE((hair.state.positions[tip] - there).norm(), sim::kPinClosing * kFrame * (1 + 1e-9));
  for (int k = 0; k < 30; ++k) hair.step(kFrame);
  EXPECT_LT((hair.state.positions[tip] - target).norm(), 1e-6);
  hair.pins[0].target.y() += 10;
  const sim::StepReport report = hair.step(kFrame);
  EXPECT_EQ(report.pins, 0);
  EXPECT_EQ(report.pins_out_of_reach, 1);
  EXPECT_LT((hair.state.positions[tip] - target).norm(), 0.2);
}

// Springs whose targets stand still put no energy in.
TEST(Pin, CountsInTheMechanicalEnergyAndAddsNone) {
  sim::SimParams params = usualHair();
  params.precision = sim::Precision::kDouble;
  params.tolerance = 1e-8, params.acceleration_tolerance = 0, params.displacement_tolerance = 0;
  Hair hair(test::combedShape(patch()), params);
  hair.step(kFrame);
  const auto energy = [&] { return test::mechanicalEnergy(hair.mesh, params, hair.context, hair.state); };
  const double free = energy();
  const int tip = tipOf(hair, 6);
  hair.pins = {{tip, hair.state.positions[tip] + Vec3(0.06, 0.05, 0.02), Vec3::Zero(), 20}};
  hair.step(kFrame);
  double before = energy();
  EXPECT_GT(before, free + 0.01);
  for (int k = 0; k < 240; ++k) {
    hair.step(kFrame);
    const double now = energy();
    EXPECT_LT(now, before + 1e-9 * std::abs(before - free) + 1e-12);
    before = now;
  }
}

// Flung by a pin that whips about, hair stays bounded: the energy limit knows of the pin's work and of no more.
TEST(Pin, AWhippingTargetKeepsTheHairBounded) {
  for (const double stiffness : {50.0, 1e5, double{INFINITY}}) {
    Hair hair(test::combedShape(patch()), usualHair());
    const int tip = tipOf(hair, 6);
    const Vec3 rest = hair.state.positions[tip];
    for (int k = 0; k < 120; ++k) {
      const Vec3 target = rest + 0.15 * Vec3(std::sin(3.0 * k), std::abs(std::sin(1.7 * k)), 0);
      const Vec3 last = hair.pins.empty() ? target : hair.pins[0].target;
      hair.pins = {{tip, target, (target - last) / kFrame, stiffness}};
      EXPECT_EQ(hair.step(kFrame).recoveries, 0);
      for (int i = 0; i < hair.mesh.vertexCount(); ++i) {
        const Vec3& root = hair.roots[hair.mesh.column_of[i]];
        EXPECT_LT((hair.state.positions[i] - root).norm(), 3 * hair.mesh.hair_length);
      }
    }
    hair.pins.clear();
    for (int k = 0; k < 900; ++k) hair.step(kFrame);
    const sim::HairState rest_state = sim::restState(hair.mesh, Eigen::Isometry3d::Identity());
    EXPECT_LT(test::largestDistance(hair.state.positions, rest_state.positions), 0.01 * hair.mesh.hair_length)
        << stiffness;
  }
}

}  // namespace pin_test
