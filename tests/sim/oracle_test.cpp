// The simulator's step against the oracle's: the same motion, the same contacts, to the solves' tolerance.
#include <gtest/gtest.h>

#include <cstdio>

#include "app/files/data_path.h"
#include "app/scene/actor.h"
#include "tests/oracle/plain_step.h"
#include "tests/test_meshes.h"

namespace oracle_test {

using sim::Solver;

constexpr double kFrame = 1.0 / 60;

sim::SimParams exactParams(bool collide) {
  sim::SimParams params;
  params.integrator = sim::Integrator::kLinearizedEuler;
  params.precision = sim::Precision::kDouble;
  params.tolerance = 1e-10;
  params.acceleration_tolerance = 1e-12;
  params.displacement_tolerance = 0;
  params.max_iterations = 5000;
  params.collide = collide;
  return params;
}

// `start`: s into the clip.
app::Actor actorOf(const char* motion, double start, app::AssetCache& asset_cache) {
  app::CharacterSpec spec;
  spec.motion = app::findFile(motion, "", "clips");
  spec.clip_offset = start;
  spec.style = app::Style::kLong;
  spec.resolution = app::Resolution::kLow;
  return app::makeActor(spec, {}, asset_cache);
}

struct Comparison {
  double position = 0, velocity = 0;  // m, m/s: largest difference
  bool same_contacts = true;
  int contacts = 0, corrected = 0;  // most in a frame; in all
  double depth = 0;                 // m, deepest that a correction began at
};

void compareStates(const sim::HairState& a, const sim::HairState& b, Comparison& worst) {
  worst.position = std::max(worst.position, test::largestDistance(a.positions, b.positions));
  worst.velocity = std::max(worst.velocity, test::largestDistance(a.velocities, b.velocities));
  worst.contacts = std::max(worst.contacts, static_cast<int>(a.contacts.size()));
  worst.same_contacts = worst.same_contacts && a.contacts.size() == b.contacts.size();
}

// Steps both from the simulator's state, so that one step is compared at a time.
Comparison compare(const sim::SimParams& params, app::Actor& actor, int frames) {
  const sim::HairMesh& mesh = actor.haircut->mesh;
  oracle::PlainContext plain(mesh);
  Comparison worst;
  for (int frame = 1; frame <= frames; ++frame) {
    app::moveActor(kFrame, actor);
    sim::HairState other = actor.hair;
    const sim::StepInput input{actor.roots, actor.ellipsoids, frame * kFrame};
    const sim::StepReport report = app::simulateActor(params, kFrame, input.time, actor);
    oracle::plainAdvance(mesh, params, input, kFrame, plain, other);
    EXPECT_TRUE(report.converged);
    EXPECT_EQ(report.recoveries, 0);
    worst.corrected += report.corrected;
    worst.depth = std::max(worst.depth, report.max_penetration);
    compareStates(actor.hair, other, worst);
  }
  return worst;
}

TEST(Oracle, HeadShakeIsThatOfThePlainImplementation) {
  app::AssetCache asset_cache;
  app::Actor actor = actorOf("head_shake.bvh", 1, asset_cache);
  const sim::HairMesh& mesh = actor.haircut->mesh;
  const Solver solvers[] = {Solver::kDefault, Solver::kPaper};
  std::vector<sim::StepContext> contexts;
  for (std::size_t k = 0; k < std::size(solvers); ++k) contexts.emplace_back(mesh);
  std::vector<sim::HairState> states(std::size(solvers), actor.hair);
  oracle::PlainContext plain(mesh);
  sim::HairState other = actor.hair;
  const std::vector<sim::Vec3> start = actor.hair.positions;
  sim::SimParams params = exactParams(false);
  Comparison worst[std::size(solvers)];
  for (int frame = 1; frame <= 16; ++frame) {
    app::moveActor(kFrame, actor);
    const sim::StepInput input{actor.roots, actor.ellipsoids, frame * kFrame};
    oracle::plainAdvance(mesh, params, input, kFrame, plain, other);
    for (std::size_t k = 0; k < std::size(solvers); ++k) {
      params.solver = solvers[k];
      EXPECT_TRUE(sim::advance(mesh, params, input, kFrame, contexts[k], states[k]).converged);
      compareStates(states[k], other, worst[k]);
    }
  }
  EXPECT_GT(test::largestDistance(start, other.positions), 0.1);
  for (std::size_t k = 0; k < std::size(solvers); ++k) {
    std::printf("%s: positions differ by %.1e m, velocities by %.1e m/s\n",
                sim::findParam("solver")->choices[static_cast<int>(solvers[k])], worst[k].position, worst[k].velocity);
    EXPECT_LT(worst[k].position, 2e-8);
    EXPECT_LT(worst[k].velocity, 1e-6);
  }
}

TEST(Oracle, EveryStepWithContactsIsThatOfThePlainImplementation) {
  for (const bool minimize : {false, true}) {
    app::AssetCache asset_cache;
    app::Actor actor = actorOf("walk.bvh", 0, asset_cache);
    sim::SimParams params = exactParams(true);
    params.minimize_deformation = minimize;
    const Comparison worst = compare(params, actor, 30);
    std::printf(
        "minimization %s: %d contacts, %d corrected, %.1f mm deep; positions differ by %.1e m, velocities by %.1e "
        "m/s\n",
        minimize ? "on" : "off", worst.contacts, worst.corrected, 1e3 * worst.depth, worst.position, worst.velocity);
    EXPECT_TRUE(worst.same_contacts);
    EXPECT_GT(worst.contacts, 2);
    EXPECT_GT(worst.corrected, 4);
    // The plain minimization stops at a thousandth of the corrections, which are as long as vertices are deep and
    // the offset more; ours is exact. What it moves in a step becomes velocity.
    const double left = 1e-3 * (worst.depth + params.contact_offset);
    EXPECT_LT(worst.position, minimize ? left : 2e-8);
    EXPECT_LT(worst.velocity, minimize ? left / kFrame : 1e-6);
  }
}

TEST(Oracle, MakesNoDifferenceBetweenSameInputs) {
  app::AssetCache asset_cache;
  app::Actor actor = actorOf("walk.bvh", 0, asset_cache);
  const sim::HairMesh& mesh = actor.haircut->mesh;
  oracle::PlainContext one(mesh), two(mesh);
  sim::HairState a = actor.hair, b = actor.hair;
  for (int frame = 1; frame <= 6; ++frame) {
    app::moveActor(kFrame, actor);
    const sim::StepInput input{actor.roots, actor.ellipsoids, frame * kFrame};
    oracle::plainAdvance(mesh, {}, input, kFrame, one, a);
    oracle::plainAdvance(mesh, {}, input, kFrame, two, b);
  }
  EXPECT_EQ(test::largestDistance(a.positions, b.positions), 0);
  EXPECT_EQ(test::largestDistance(a.velocities, b.velocities), 0);
}

}  // namespace oracle_test
