// Steps without contacts: free flight, drag, momentum, order of convergence, rest, determinism, state faults.
#include "sim/step.h"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>

#include "sim/forces/model.h"
#include "tests/block_product.h"
#include "tests/sim_probes.h"
#include "tests/test_meshes.h"

namespace step_test {

using sim::Integrator;
using sim::Solver;
using sim::Vec3;
using test::Hair;

constexpr double kFrame = 1.0 / 60;
constexpr Integrator kIntegrators[] = {Integrator::kLinearizedEuler, Integrator::kBdf2};
const char* nameOf(Integrator integrator) {
  constexpr const char* kNames[] = {"linearized Euler", "BDF2"};
  return kNames[static_cast<int>(integrator)];
}

test::PatchOptions oneBundle(int layers = 6) {
  test::PatchOptions o;
  o.nx = o.nz = 1, o.layers = layers;
  return o;
}

TEST(Step, FreeFallFollowsImplicitEulersParabola) {
  {
    sim::SimParams params = test::looseParticles();
    Hair hair(test::patchShape(oneBundle()), params);
    const auto start = hair.state.positions;
    const double dt = kFrame;
    for (int n = 1; n <= 12; ++n) {
      hair.step(dt);
      // v_n = -n g h and x_n = x_0 - g h^2 n (n + 1) / 2: the parabola and a first-order error of g h t / 2.
      const double t = n * dt, fall = -9.81 * dt * dt * n * (n + 1) / 2;
      for (int i = 0; i < hair.mesh.vertexCount(); ++i) {
        const bool root = hair.mesh.isRoot(i);
        const Vec3 expected = start[i] + Vec3(0, root ? 0 : fall, 0);
        EXPECT_LT((hair.state.positions[i] - expected).norm(), 1e-12);
        EXPECT_LT((hair.state.velocities[i] - Vec3(0, root ? 0 : -9.81 * t, 0)).norm(), 1e-12);
      }
      EXPECT_NEAR(fall + 9.81 * t * t / 2, -9.81 * dt * t / 2, 1e-15);
    }
  }
}

TEST(Step, FreeFallErrorHasEachIntegratorsOrder) {
  for (const Integrator integrator : kIntegrators) {
    std::vector<double> steps, errors;
    for (int count = 8; count <= 64; count *= 2) {
      sim::SimParams params = test::looseParticles();
      params.integrator = integrator;
      Hair hair(test::patchShape(oneBundle()), params);
      const int tip = hair.mesh.vertexCount() - 1;
      const double end = 0.2, dt = end / count, start = hair.state.positions[tip].y();
      for (int n = 0; n < count; ++n) hair.step(dt);
      steps.push_back(dt);
      errors.push_back(std::abs(hair.state.positions[tip].y() - start + 9.81 * end * end / 2));
    }
    const double order = test::observedOrder(steps, errors);
    std::printf("%-16s free fall error %.1e m at h = %.4f, order %.2f\n", nameOf(integrator), errors.back(),
                steps.back(), order);
    EXPECT_NEAR(order, integrator == Integrator::kBdf2 ? 2 : 1, 0.15);
  }
}

TEST(Step, AirDragTakesItsShareAndTheWindGivesIt) {
  sim::SimParams params = test::looseParticles();
  params.gravity = 0;
  params.air_drag = 3;
  params.wind_x = 0.4, params.wind_z = -0.2;
  Hair hair(test::patchShape(oneBundle()), params);
  const Vec3 wind(0.4, 0, -0.2);
  Vec3 expected(-0.3, 0.5, 0.1);
  for (Vec3& v : hair.state.velocities) v = expected;
  for (int n = 0; n < 20; ++n) {
    hair.step(kFrame);
    expected = (expected + kFrame * 3 * wind) / (1 + kFrame * 3);
    for (int i = 0; i < hair.mesh.vertexCount(); ++i) {
      if (hair.mesh.isRoot(i)) continue;
      EXPECT_LT((hair.state.velocities[i] - expected).norm(), 1e-10);
    }
  }
  // In the end the hair flies with the wind, whatever the step.
  for (Vec3& v : hair.state.velocities) v = Vec3(0, 0.1, 0);
  hair.params.air_drag = 50;
  for (int n = 0; n < 20; ++n) hair.step(0.05);
  EXPECT_LT((hair.state.velocities.back() - wind).norm(), 1e-9);
}

TEST(Step, FallThroughAirEndsAtTheTerminalVelocity) {
  sim::SimParams params = test::looseParticles();
  params.air_drag = 40;
  Hair hair(test::patchShape(oneBundle()), params);
  for (int n = 0; n < 60; ++n) hair.step(kFrame);
  EXPECT_NEAR(hair.state.velocities.back().y(), -9.81 / 40, 1e-9);
}

// The state about which an integrator takes its forces for a step from `before` to `after`, and the change of velocity
// over which it extrapolates them: the paper's step the start, BDF2's first step one Newton step from the old
// velocities.
struct ForcePoint {
  std::vector<sim::V3<double>> x, v, change;
  double damping;
};

ForcePoint forcePoint(const Hair& hair, const sim::HairState& before) {
  const std::size_t n = before.positions.size();
  const auto after = test::plain<double>(hair.state.velocities);
  const std::vector<sim::V3<double>> zero(n, {0, 0, 0});
  switch (hair.params.integrator) {
    case Integrator::kLinearizedEuler:
      return {test::plain<double>(before.positions), zero, after, 0};
    default: {
      ForcePoint point{zero, zero, zero, hair.params.damping};
      for (std::size_t i = 0; i < n; ++i) {
        const bool root = hair.mesh.isRoot(static_cast<int>(i));
        const Vec3 guess = root ? hair.state.velocities[i] : before.velocities[i];
        point.x[i] = test::plain<double>(Vec3(before.positions[i] + kFrame * guess));
        point.v[i] = test::plain<double>(guess);
        point.change[i] = after[i] - point.v[i];
      }
      return point;
    }
  }
}

// Newton's third law at the scalp: without gravity and air the free hair's momentum changes by what the roots give it,
// and by nothing else. The roots' part is evaluated apart.
TEST(Step, MomentumChangesByTheRootsPullAlone) {
  for (const Integrator integrator : kIntegrators) {
    sim::SimParams params = test::tautHair();
    params.gravity = params.air_drag = 0;
    params.integrator = integrator;
    params.tolerance = 1e-12, params.acceleration_tolerance = params.displacement_tolerance = 0;
    Hair hair(test::combedShape({}), params);
    test::Random random(3);
    for (int i = 0; i < hair.mesh.vertexCount(); ++i) {
      if (hair.mesh.isRoot(i)) continue;
      hair.state.positions[i] += random.vector(0.001);
      hair.state.velocities[i] = random.vector(0.1);
    }
    for (Vec3& root : hair.roots) root += Vec3(0.002, 0.001, -0.001);
    const sim::HairState before = hair.state;
    ASSERT_EQ(hair.step(kFrame).recoveries, 0);
    const ForcePoint at = forcePoint(hair, before);
    const auto pattern = sim::systemPattern(hair.mesh);
    std::vector<sim::V3<double>> force(at.x.size(), {0, 0, 0}), implicit(at.x.size(), {0, 0, 0});
    sim::BlockMatrix<double> matrix(&pattern);
    matrix.setZero();
    sim::Evaluation<double> out;
    out.force = force;
    out.velocities = at.v;
    out.damping = at.damping;
    out.matrix = &matrix;
    out.matrix_scale = kFrame + params.damping;
    out.tension_scale = kFrame;
    sim::evaluate<double>(test::makeForceModel(hair.mesh, pattern, params), at.x, out);
    sim::multiply<double>(matrix, at.change, implicit);
    Vec3 gained = Vec3::Zero(), pull = Vec3::Zero();
    double scale = 0;
    for (int i = 0; i < hair.mesh.vertexCount(); ++i) {
      if (hair.mesh.isRoot(i)) {
        pull -= kFrame * test::eigen(force[i] - implicit[i]);
        continue;
      }
      const Vec3 momentum =
          params.density * hair.mesh.vertex_volume[i] * (hair.state.velocities[i] - before.velocities[i]);
      gained += momentum;
      scale += momentum.norm();
    }
    EXPECT_GT(pull.norm(), 1e-3 * scale) << "the roots do pull";
    EXPECT_LT((gained - pull).norm(), 1e-7 * scale) << nameOf(integrator);
  }
}

TEST(Step, RigidFlightKeepsShapeAndMomentum) {
  for (const Integrator integrator : kIntegrators) {
    sim::SimParams params = test::tautHair();
    params.gravity = params.air_drag = 0;
    params.integrator = integrator;
    Hair hair(test::combedShape({}), params);
    const Vec3 velocity(1.5, -0.7, 2);
    for (Vec3& v : hair.state.velocities) v = velocity;
    const auto start = hair.state.positions;
    for (int n = 1; n <= 60; ++n) {
      for (Vec3& root : hair.roots) root += kFrame * velocity;
      hair.step(kFrame);
    }
    std::vector<Vec3> expected = start;
    for (Vec3& p : expected) p += 60 * kFrame * velocity;
    EXPECT_LT(test::largestDistance(hair.state.positions, expected), 1e-9) << nameOf(integrator);
    EXPECT_LT((hair.state.velocities.back() - velocity).norm(), 1e-8);
  }
}

TEST(Step, StaysAtRestWithoutGravityAndUnderGravityWhenSagFree) {
  for (const Integrator integrator : kIntegrators) {
    for (const bool gravity : {false, true}) {
      sim::SimParams params = test::tautHair();
      params.integrator = integrator;
      params.sag_free = gravity;
      params.gravity = gravity ? 9.81 : 0;
      test::PatchOptions o;
      o.mixed = o.uneven = true;
      Hair hair(test::combedShape(o), params);
      const auto start = hair.state.positions;
      for (int n = 0; n < 120; ++n) hair.step(kFrame);
      EXPECT_LT(test::largestDistance(hair.state.positions, start), 1e-7 * hair.mesh.hair_length)
          << nameOf(integrator) << (gravity ? " under gravity" : "");
    }
  }
  // And with gravity but slack rest lengths it does sag: the law above is not empty.
  sim::SimParams params = test::tautHair();
  params.sag_free = false;
  Hair hair(test::combedShape({}), params);
  const auto start = hair.state.positions;
  for (int n = 0; n < 120; ++n) hair.step(kFrame);
  EXPECT_GT(test::largestDistance(hair.state.positions, start), 1e-4);
}

// A bundle hung aslant and let go, soft enough to be resolved: how far from a fine-step reference it is after a while.
std::vector<Vec3> swing(Integrator integrator, int count) {
  sim::SimParams params = test::tautHair();
  params.integrator = integrator;
  params.stretch_along = 2e4, params.stretch_across = params.stretch_edge = 2e3, params.shear = 500;
  params.volume = 1e3, params.bend = 0.02;
  params.damping = 0.004, params.air_drag = 1;
  Hair hair(test::patchShape(oneBundle(5)), params);
  const Eigen::AngleAxisd slant(0.5, Vec3(1, 0, 0.3).normalized());
  for (int i = 0; i < hair.mesh.vertexCount(); ++i) {
    const Vec3 root = hair.roots[hair.mesh.column_of[i]];
    hair.state.positions[i] = root + slant * (hair.state.positions[i] - root);
  }
  for (int n = 0; n < count; ++n) hair.step(0.4 / count);
  return hair.state.positions;
}

TEST(Step, ASwingingBundleApproachesTheFineReferenceWithEachIntegratorsOrder) {
  const std::vector<Vec3> reference = swing(Integrator::kBdf2, 3200);
  for (const Integrator integrator : kIntegrators) {
    std::vector<double> steps, errors;
    for (const int count : {50, 100, 200, 400}) {
      steps.push_back(0.4 / count);
      errors.push_back(test::largestDistance(swing(integrator, count), reference));
      EXPECT_TRUE(errors.size() == 1 || errors.back() < errors[errors.size() - 2]) << "halving the step helps";
    }
    const double order = test::observedOrder(steps, errors);
    std::printf("%-16s error %.1e m at h = %.4f s, %.1e m at h = %.4f s, order %.2f\n", nameOf(integrator), errors[0],
                steps[0], errors.back(), steps.back(), order);
    EXPECT_LT(errors[0], 0.1 * 0.2) << "of the hair's length, at half a frame";
    EXPECT_GT(order, integrator == Integrator::kBdf2 ? 1.7 : 0.8);
    EXPECT_LT(order, integrator == Integrator::kBdf2 ? 2.3 : 1.3);
  }
}

bool sameBits(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(Vec3)) == 0;
}

TEST(Step, SameInputsGiveTheSameBits) {
  for (const sim::Precision precision : {sim::Precision::kFloat, sim::Precision::kDouble}) {
    for (const Solver solver : {Solver::kPaper, Solver::kDefault}) {
      sim::SimParams params = test::tautHair();
      params.precision = precision;
      params.solver = solver;
      params.tolerance = 1e-4;
      params.max_iterations = 200;
      Hair one(test::combedShape({}), params), other(test::combedShape({}), params);
      test::shake(one, 20);
      test::shake(other, 20);
      EXPECT_TRUE(sameBits(one.state.positions, other.state.positions));
      EXPECT_TRUE(sameBits(one.state.velocities, other.state.velocities));
      EXPECT_GT(one.state.contacts.size() + other.state.contacts.size(), 0u) << "contacts took part";
    }
  }
}

TEST(Step, SolversAndPrecisionsAgreeOnTheMotion) {
  Hair reference(test::combedShape({}), test::tautHair());
  test::shake(reference, 20);
  for (const Solver solver : {Solver::kPaper, Solver::kDefault}) {
    sim::SimParams params = test::tautHair();
    params.solver = solver;
    Hair hair(test::combedShape({}), params);
    test::shake(hair, 20);
    EXPECT_LT(test::largestDistance(hair.state.positions, reference.state.positions), 1e-4 * hair.mesh.hair_length)
        << "solver " << static_cast<int>(solver);
  }
  sim::SimParams params = test::tautHair();
  params.precision = sim::Precision::kFloat;
  params.tolerance = 1e-5;
  Hair hair(test::combedShape({}), params);
  test::shake(hair, 20);
  EXPECT_LT(test::largestDistance(hair.state.positions, reference.state.positions), 2e-2 * hair.mesh.hair_length)
      << "contacts may be made a step apart";
}

TEST(Step, TurnsAndShiftsWithTheWorld) {
  // Gravity is vertical: any turn about y and any shift must carry a motion into the same motion there.
  const Eigen::Isometry3d place = Eigen::Translation3d(3, 1, -2) * Eigen::AngleAxisd(2.1, Vec3::UnitY());
  Hair here(test::combedShape({}), test::tautHair()), there(test::combedShape({}), test::tautHair());
  sim::carryAlong(Eigen::Isometry3d::Identity(), place, there.state);
  const auto rest = here.roots;
  for (int n = 1; n <= 30; ++n) {
    const Eigen::AngleAxisd turn(0.4 * std::sin(0.2 * n), Vec3(1, 2, 0).normalized());
    for (std::size_t c = 0; c < rest.size(); ++c) {
      here.roots[c] = turn * rest[c];
      there.roots[c] = place * here.roots[c];
    }
    here.step(kFrame);
    there.step(kFrame);
  }
  sim::HairState back = there.state;
  sim::carryAlong(place, Eigen::Isometry3d::Identity(), back);
  EXPECT_LT(test::largestDistance(back.positions, here.state.positions), 1e-7);
  EXPECT_LT(test::largestDistance(back.velocities, here.state.velocities), 1e-5);
}

TEST(Step, NeverLeavesAValueThatIsNotFiniteAndCountsTheRecovery) {
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 1e30}) {
    for (const bool in_velocity : {false, true}) {
      sim::SimParams params = test::tautHair();
      params.tolerance = 1e-4;
      Hair hair(test::combedShape({}), params);
      test::shake(hair, 10);
      (in_velocity ? hair.state.velocities : hair.state.positions)[12].y() = bad;
      int recoveries = 0;
      for (int n = 0; n < 3; ++n) {
        recoveries += hair.step(kFrame).recoveries;
        for (const Vec3& p : hair.state.positions) ASSERT_TRUE(p.allFinite()) << bad;
        for (const Vec3& v : hair.state.velocities) ASSERT_TRUE(v.allFinite()) << bad;
      }
      EXPECT_GE(recoveries, 1);
      for (int n = 0; n < 100; ++n) hair.step(kFrame);
      EXPECT_EQ(hair.step(kFrame).recoveries, 0) << "it recovers for good";
    }
  }
}

}  // namespace step_test
