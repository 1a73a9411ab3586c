// No violent step makes energy out of nothing, gentle ones are left alone.
#include "sim/stabilization/energy_limit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <limits>
#include <utility>

#include "sim/stabilization/state_validation.h"
#include "tests/sim_probes.h"
#include "tests/test_meshes.h"

namespace energy_limit_test {

using sim::Vec3;
using test::Hair;

constexpr double kFrame = 1.0 / 60;

sim::SimParams hairWithoutBody() {
  sim::SimParams params;
  params.collide = false;
  return params;
}

double massOf(const Hair& hair) {
  double mass = 0;
  for (int i = 0; i < hair.mesh.vertexCount(); ++i) {
    if (!hair.mesh.isRoot(i)) mass += hair.params.density * hair.mesh.vertex_volume[i];
  }
  return mass;
}

// Energy above that of the rest shape where the roots are, J.
double energyAboveRest(Hair& hair, const Vec3& moved) {
  const sim::HairState rest = sim::restState(hair.mesh, Eigen::Isometry3d(Eigen::Translation3d(moved)));
  return test::mechanicalEnergy(hair.mesh, hair.params, hair.context, hair.state) -
         test::mechanicalEnergy(hair.mesh, hair.params, hair.context, rest);
}

// The largest energy, of that which being left behind is worth, after the roots were dragged along by `moved` within
// one step and stand still.
double worstAfterDrag(sim::SimParams params, const Vec3& moved, double dt) {
  Hair hair(test::combedShape(test::mixedPatch(7, 0.3)), params);
  const double worth = 0.5 * massOf(hair) * moved.squaredNorm() / (dt * dt);
  for (Vec3& root : hair.roots) root += moved;
  double worst = 0;
  for (int n = 0; n < 60; ++n) {
    const sim::StepReport report = hair.step(dt);
    EXPECT_EQ(report.recoveries, 0) << sim::faultText(report.fault_report);
    EXPECT_FALSE(report.carried);
    worst = std::max(worst, energyAboveRest(hair, moved) / worth);
  }
  return worst;
}

TEST(EnergyLimit, HairLeftBehindByItsRootsStoresNoMoreThanThatIsWorthTwiceAsFast) {
  // It may rebound at the roots' own speed just before they stop.
  const Vec3 directions[] = {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(-0.3, -0.8, 0.5)};
  for (const Vec3& direction : directions) {
    EXPECT_LT(worstAfterDrag(hairWithoutBody(), direction, kFrame), 4);
    EXPECT_LT(worstAfterDrag(hairWithoutBody(), 8 * direction, 0.1), 4);
  }
}

TEST(EnergyLimit, AndComesBack) {
  Hair hair(test::combedShape(test::mixedPatch(7, 0.3)), hairWithoutBody());
  for (Vec3& root : hair.roots) root += Vec3(2, 0, 0);
  for (int n = 0; n < 300; ++n) hair.step(kFrame);
  const sim::HairState rest = sim::restState(hair.mesh, Eigen::Isometry3d(Eigen::Translation3d(2, 0, 0)));
  EXPECT_LT(test::largestDistance(hair.state.positions, rest.positions), 0.01 * hair.mesh.hair_length);
}

// A state flung away from rest within one step, and that step.
struct Flung {
  Hair hair{test::combedShape(test::mixedPatch(7, 0.3)), hairWithoutBody()};
  sim::HairState start = hair.state;
  sim::ForceModel<double> model = test::makeForceModel(hair.mesh, sim::systemPattern(hair.mesh), hair.params);
  sim::EnergyLimit scratch{hair.mesh};

  void fling(double way) {
    test::Random random(5);
    for (int i = 0; i < hair.mesh.vertexCount(); ++i) {
      if (hair.mesh.isRoot(i)) continue;
      const Vec3 step = way * Vec3(random(-1, 1), random(-1, 1), random(-1, 1));
      hair.state.positions[i] += step;
      hair.state.velocities[i] = step / kFrame;
    }
  }
  double limit(bool restarted = false) {
    const sim::TakenStep step{hair.mesh, hair.params,  model, start.positions, start.velocities,
                              kFrame,    Vec3::Zero(), {},    restarted};
    return sim::limitEnergy(step, true, scratch, hair.state);
  }
};

TEST(EnergyLimit, AStepThatEndsTooHighIsTakenBackUntilItFits) {
  Flung flung;
  for (Vec3& v : flung.start.velocities) v = Vec3(3, 0, 0);
  flung.fling(0.5);
  flung.hair.state.previous_dt = kFrame;
  EXPECT_LT(flung.limit(), 1);
  EXPECT_EQ(flung.hair.state.previous_dt, 0) << "BDF2 goes on from a speed that is no more";
  const double bound = 0.5 * massOf(flung.hair) * 9;
  EXPECT_LE(energyAboveRest(flung.hair, Vec3::Zero()), bound * (1 + 1e-9));
  EXPECT_GT(energyAboveRest(flung.hair, Vec3::Zero()), 0.2 * bound) << "it was held back more than it need be";
}

TEST(EnergyLimit, AGentleStepIsLookedAtWhereTheHairWasStoppedBeforeIt) {
  Flung trusted, stopped;
  trusted.fling(0.002), stopped.fling(0.002);
  EXPECT_EQ(trusted.limit(), 1);
  EXPECT_EQ(trusted.scratch.energies, 0);
  EXPECT_LT(stopped.limit(true), 1);
  EXPECT_LE(energyAboveRest(stopped.hair, Vec3::Zero()), 1e-12);
}

// Hair that stands off its rest, or all but stands, and a step that shoots over it by four times as much: its first
// quarter leads down.
TEST(EnergyLimit, HairThatStandsStillIsNotHeldWhereAShorterWayLeadsDown) {
  for (const double creep : {0.0, 1e-5, 1e-3}) {
    Flung flung;
    for (int i = 0; i < flung.hair.mesh.vertexCount(); ++i) {
      if (flung.hair.mesh.isRoot(i)) continue;
      const Vec3 off(0.01 * std::sin(3 * i), 0.01 * std::cos(5 * i), 0.01 * std::sin(7 * i));
      flung.start.positions[i] += off;
      flung.start.velocities[i] = Vec3(creep, 0, 0);
      flung.hair.state.positions[i] -= 4 * off;
      flung.hair.state.velocities[i] = -5 * off / kFrame;
    }
    const sim::HairState end = std::exchange(flung.hair.state, flung.start);
    const double before = energyAboveRest(flung.hair, Vec3::Zero());
    flung.hair.state = end;
    const double kept = flung.limit(true);
    EXPECT_GT(kept, 0.02) << creep << " m/s";
    EXPECT_LT(kept, 0.5) << creep << " m/s";
    EXPECT_LT(energyAboveRest(flung.hair, Vec3::Zero()), before) << creep << " m/s";
  }
}

TEST(EnergyLimit, TheFirstStepAndThatAfterAResetAreLookedAtAndNoneAfterThem) {
  Hair hair(test::combedShape(test::mixedPatch(7, 0.3)), hairWithoutBody());
  EXPECT_GT(hair.step(kFrame).work.energies, 0);
  EXPECT_EQ(hair.step(kFrame).work.energies, 0);
  hair.state.previous_dt = 0;
  EXPECT_GT(hair.step(kFrame).work.energies, 0);
  EXPECT_EQ(hair.step(kFrame).work.energies, 0);
}

// Ways of 2 cm to 3 m, from hair that has next to no energy to hair that has nearly enough.
TEST(EnergyLimit, FindsTheWayThatFitsInFewTries) {
  int ways = 0, energies = 0, most = 0;
  for (double way = 0.02; way < 3; way *= 1.5) {
    for (double speed = 0.001; speed < 100; speed *= 3) {
      Flung flung;
      for (Vec3& v : flung.start.velocities) v = Vec3(speed, 0, 0);
      flung.fling(way);
      const double kept = flung.limit();
      if (kept == 1) continue;
      EXPECT_GT(kept, 0) << way << " m, " << speed;
      const double bound = 0.5 * massOf(flung.hair) * speed * speed;
      EXPECT_LE(energyAboveRest(flung.hair, Vec3::Zero()), bound * (1 + 1e-9) + 1e-12) << way << " m, " << speed;
      ++ways;
      energies += flung.scratch.energies - 2;  // without those of both ends
      most = std::max(most, flung.scratch.energies - 2);
    }
  }
  std::printf("%d ways shortened by %.2f tries each, at most %d\n", ways, double(energies) / ways, most);
  EXPECT_GT(ways, 50);
  EXPECT_LE(most, 5);
  EXPECT_LT(energies, 4.5 * ways);
}

// Hair with hardly a shear or volume force is folded by a wind that its stiff hinges bear: its motion is slow, and
// still its forces are not linear over a step.
TEST(EnergyLimit, LimpHairInTheWindOnlyLosesEnergyAndComesToRest) {
  sim::SimParams params = hairWithoutBody();
  params.shear = 1.35, params.volume = 8.9, params.bend = 630;
  params.wind_x = 30, params.wind_z = 18;
  test::PatchOptions patch = test::mixedPatch(7, 0.3);
  patch.nx = 6, patch.nz = 5;
  Hair hair(test::combedShape(patch), params);
  const auto energy = [&] {
    double sum = test::mechanicalEnergy(hair.mesh, params, hair.context, hair.state);
    for (int i = 0; i < hair.mesh.vertexCount(); ++i) {
      const double push = params.density * hair.mesh.vertex_volume[i] * params.air_drag;
      sum -= push * Vec3(params.wind_x, 0, params.wind_z).dot(hair.state.positions[i]);
    }
    return sum;
  };
  double before = energy(), risen = 0, fastest = 0;
  for (int n = 0; n < 1200; ++n) {
    const bool guided = hair.step(kFrame).guided > 0;  // inversion recovery does work on the hair
    const double now = energy();
    if (!guided) risen = std::max(risen, now - before);
    before = now;
    if (n < 1140) continue;
    for (const Vec3& v : hair.state.velocities) fastest = std::max(fastest, v.norm());
  }
  std::printf("energy up by at most %.2g J of %.2g in a step, fastest %.2g m/s\n", risen,
              9.81 * massOf(hair) * hair.mesh.hair_length, fastest);
  EXPECT_LT(risen, 1e-6 * 9.81 * massOf(hair) * hair.mesh.hair_length);
  EXPECT_LT(fastest, 0.01);
}

TEST(EnergyLimit, AGentleStepKeepsEveryBit) {
  Flung flung;
  flung.fling(0.01);
  const sim::HairState before = flung.hair.state;
  EXPECT_EQ(flung.limit(), 1);
  EXPECT_EQ(flung.hair.state.positions, before.positions);
  EXPECT_EQ(flung.hair.state.velocities, before.velocities);
}

// Hair pressed out of shape by a body, and the body gone from one step to the next.
TEST(EnergyLimit, HairLetGoByItsBodyMakesNoEnergyOfWhatItHeld) {
  for (const double rise : {0.1, 0.14, 0.18}) {
    sim::SimParams params;
    params.damping = 0;
    params.stretch_across *= 100;  // so stiff, it gains 4 % of the energy when let go by a linearized step
    Hair hair(test::combedShape(test::mixedPatch(7, 0.3)), params);
    // Against the tips, and on by `rise`.
    double lowest = 0;
    for (const Vec3& p : hair.state.positions) lowest = std::min(lowest, p.y());
    Vec3 center = Vec3::Zero();
    int tips = 0;
    for (const Vec3& p : hair.state.positions) {
      if (p.y() < 0.8 * lowest) center += p, ++tips;
    }
    center /= tips;
    center.z() -= 0.1;
    hair.bodies.push_back({center, Eigen::Quaterniond::Identity(), Vec3::Constant(0.05)});
    for (int n = 0; n < 120; ++n) {
      hair.bodies[0].velocity = Vec3(0, 0, n < 60 ? rise / (60 * kFrame) : 0);
      hair.bodies[0].center += kFrame * hair.bodies[0].velocity;
      hair.step(kFrame);
    }
    ASSERT_FALSE(hair.state.contacts.empty());
    const double held = energyAboveRest(hair, Vec3::Zero());
    hair.bodies.clear();
    double worst = 0;
    for (int n = 0; n < 10; ++n) {
      hair.step(kFrame);
      worst = std::max(worst, energyAboveRest(hair, Vec3::Zero()));
    }
    EXPECT_LE(worst, held * 1.001) << rise;
  }
}

TEST(EnergyLimit, AStateThatIsNotFiniteIsLeftToValidation) {
  Flung flung;
  flung.fling(0.5);
  flung.hair.state.positions[3].x() = std::numeric_limits<double>::quiet_NaN();
  const sim::HairState before = flung.hair.state;
  EXPECT_EQ(flung.limit(), 1);
  EXPECT_EQ(flung.hair.state.positions[5], before.positions[5]);
}

TEST(EnergyLimit, BeingCarriedAlongAndTurnedMakesNoEnergy) {
  Flung flung;
  const Eigen::Isometry3d move = Eigen::Translation3d(0, 3, 1) * Eigen::AngleAxisd(2, Vec3(1, 2, 0).normalized());
  for (int i = 0; i < flung.hair.mesh.vertexCount(); ++i) {
    flung.hair.state.positions[i] = move * flung.start.positions[i];
    flung.hair.state.velocities[i] = (flung.hair.state.positions[i] - flung.start.positions[i]) / kFrame;
  }
  const sim::HairState before = flung.hair.state;
  EXPECT_EQ(flung.limit(), 1);
  EXPECT_EQ(flung.hair.state.positions, before.positions);
}

}  // namespace energy_limit_test
