// What a step leaves out: solves that have nothing to do, kinds of force without stiffness, factors that would not
// change, colliders out of reach, parts of the hair that sleep.
#include <gtest/gtest.h>
#include <time.h>

#include <fstream>

#include "app/files/data_path.h"
#include "app/files/hair_file.h"
#include "app/scene/demo.h"
#include "app/scene/detail/sleep.h"
#include "sim/forces/kernels.h"
#include "tests/sim_probes.h"
#include "tests/test_meshes.h"

namespace skips_step_test {

using sim::Vec3;
using test::Hair;

constexpr double kFrame = 1.0 / 60;
constexpr int kMaxRounds = 12;  // of times that are compared: the first that holds ends them

// Least of `times` runs, so that what else the machine does counts little.
template <class Work>
double cpuSeconds(int times, const Work& work) {
  double least = INFINITY;
  for (int k = 0; k < times; ++k) {
    timespec start{}, end{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &start);
    work();
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &end);
    least = std::min(least, static_cast<double>(end.tv_sec - start.tv_sec) +
                                1e-9 * static_cast<double>(end.tv_nsec - start.tv_nsec));
  }
  return least;
}

test::PatchOptions coat() {
  test::PatchOptions o;
  o.nx = 6, o.nz = 4, o.layers = 9, o.length = 0.25, o.mixed = true;
  return o;
}

sim::SimParams everyday() {
  sim::SimParams params = test::tautHair();
  const sim::SimParams defaults;
  params.solver = sim::Solver::kDefault;
  params.precision = defaults.precision;
  params.tolerance = 1e-2, params.acceleration_tolerance = 0.01, params.displacement_tolerance = 1e-6;
  return params;
}

TEST(SkipCount, ASolveThatStartsWithinToleranceTakesNoIteration) {
  Hair hair(test::combedShape(coat()), everyday());
  int iterations = 0;
  for (int n = 0; n < 30; ++n) iterations += hair.step(kFrame).solver_iterations;
  EXPECT_EQ(iterations, 0);
  for (Vec3& root : hair.roots) root.x() += 0.01;
  EXPECT_GT(hair.step(kFrame).solver_iterations, 0);
}

TEST(SkipCount, UnchangedParametersNeverBalanceAnew) {
  const sim::SimParams params = everyday();
  double first = INFINITY, later = INFINITY;
  for (int round = 0; round < kMaxRounds && later >= 0.5 * first; ++round) {
    Hair hair(test::combedShape(coat()), params);
    first = std::min(first, cpuSeconds(1, [&] { hair.step(kFrame); }));
    later = std::min(later, cpuSeconds(5, [&] { hair.step(kFrame); }));
  }
  std::printf("a first step %.0f us, a later one %.0f\n", 1e6 * first, 1e6 * later);
  EXPECT_LT(later, 0.5 * first) << "a first step makes the balance of gravity, a later one does not";
}

// The counter of it, at once and in slices: steps that keep all, of steps.
TEST(SkipCount, StepsThatKeepTheBalanceAreCounted) {
  for (const bool gradually : {false, true}) {
    Hair hair(test::combedShape(coat()), everyday());
    hair.params.sag_free = true;
    hair.context.refreshGradually(gradually);
    const auto kept = [&] {
      const sim::SkipCount count = hair.step(kFrame).refreshes;
      EXPECT_EQ(count.of, 1);
      return count.skipped == 1;
    };
    EXPECT_FALSE(kept());
    for (int n = 0; n < 3; ++n) EXPECT_TRUE(kept());
    hair.params.friction *= 2;
    EXPECT_TRUE(kept()) << "the balance does not follow from it";
    hair.params.bend *= 1.5;
    int refreshing = 0;
    while (refreshing < 200 && !kept()) ++refreshing;
    EXPECT_TRUE(gradually ? refreshing > 5 && refreshing < 200 : refreshing == 1) << refreshing << " steps";
    for (int n = 0; n < 3; ++n) EXPECT_TRUE(kept());
  }
}

template <class T>
struct Evaluated {
  std::vector<T> force, matrix;
  T energy = 0;
  bool operator==(const Evaluated&) const = default;
};

TEST(SkipCount, KindsOfForceWithoutStiffnessAreNotAssembled) {
  using T = float;
  const sim::HairMesh mesh = sim::buildHairMesh(test::combedShape(coat()));
  const sim::BlockPattern pattern = sim::systemPattern(mesh);
  const sim::ColumnLayout layout(mesh);
  const sim::ColumnPattern column_pattern(mesh, layout);
  test::Random random(3);
  std::vector<Vec3> bent = mesh.shape.positions;
  for (Vec3& x : bent) x += random.vector(0.003);
  sim::ColumnField<T> x(layout), force(layout);
  x.pack(layout, std::span<const sim::V3<T>>(test::plain<T>(bent)));
  sim::ColumnMatrix<T> matrix(layout, column_pattern);
  const auto run = [&](const sim::ColumnModel<T>& model) {
    force.setZero();
    matrix.setZero();
    sim::ColumnEvaluation<T> out;
    out.force = &force;
    out.matrix = &matrix;
    out.matrix_scale = out.tension_scale = 1;
    return sim::evaluate<T>(model, layout, x, out);
  };
  const auto evaluated = [&](const sim::ColumnModel<T>& model) {
    Evaluated<T> result;
    result.energy = run(model);
    std::vector<sim::V3<T>> forces(bent.size());
    force.unpack(layout, forces);
    for (const sim::V3<T>& f : forces) result.force.insert(result.force.end(), {f.x, f.y, f.z});
    result.matrix.assign(matrix.values.begin(), matrix.values.end());
    return result;
  };
  const auto modelOf = [&](const sim::SimParams& params) {
    sim::ColumnModel<T> model(mesh, layout, column_pattern);
    model.setElements(mesh, layout, test::makeForceModel(mesh, pattern, params));
    return model;
  };
  sim::SimParams full = test::tautHair();
  full.sag_free = false;
  sim::SimParams least = full;
  for (double sim::SimParams::*kind :
       {&sim::SimParams::stretch_edge, &sim::SimParams::shear, &sim::SimParams::bend, &sim::SimParams::volume}) {
    sim::SimParams params = full;
    params.*kind = least.*kind = 0;
    const sim::ColumnModel<T> model = modelOf(params);
    sim::ColumnModel<T> all = model;
    all.has_vertical = all.has_horizontal = all.has_shear = all.has_bend = true;
    EXPECT_EQ(evaluated(all), evaluated(model));
  }
  const sim::ColumnModel<T> full_model = modelOf(full), least_model = modelOf(least);
  double dear = INFINITY, cheap = INFINITY;
  for (int round = 0; round < kMaxRounds && cheap >= 0.6 * dear; ++round) {
    dear = std::min(dear, cpuSeconds(25, [&] { run(full_model); }));
    cheap = std::min(cheap, cpuSeconds(25, [&] { run(least_model); }));
  }
  EXPECT_LT(cheap, 0.6 * dear);
}

TEST(SkipCount, AStepCountsTheKindsWithoutStiffness) {
  sim::SimParams full = test::tautHair();
  full.sag_free = false;
  sim::SimParams least = full;
  least.stretch_edge = least.shear = least.bend = least.volume = 0;
  // Nothing is pinned; stretch along the hair stays.
  for (const auto& [params, left_out] : {std::pair{full, 1}, {least, 5}, {test::looseParticles(), 6}}) {
    Hair hair(test::combedShape(coat()), params);
    const sim::SkipCount kinds = hair.step(kFrame).force_kinds;
    EXPECT_EQ(kinds.skipped, left_out);
    EXPECT_EQ(kinds.of, sim::ForceKinds::kCount);
  }
}

TEST(SkipCount, CollidersOutOfReachChangeNoBitAndCostNothing) {
  Hair without(test::combedShape(coat()), everyday()), with(test::combedShape(coat()), everyday());
  for (Hair* hair : {&without, &with})
    hair->bodies.push_back({Vec3(0.05, -0.3, 0), Eigen::Quaterniond::Identity(), Vec3(0.08, 0.08, 0.08)});
  for (int k = 0; k < 40; ++k)
    with.bodies.push_back({Vec3(2 + k, 0, 0), Eigen::Quaterniond::Identity(), Vec3(0.5, 0.4, 0.3)});
  double least[2] = {INFINITY, INFINITY};
  sim::SkipCount counted[2];
  bool looked = false;
  for (int n = 0; n < 60 || (n < 60 * kMaxRounds && least[1] >= 1.1 * least[0]); ++n) {
    for (Hair* hair : {&without, &with}) {
      if (n < 10) {
        for (Vec3& root : hair->roots) root.y() -= 0.003;
      }
      double& seconds = least[hair == &with];
      sim::SkipCount& tests = counted[hair == &with];
      seconds = std::min(seconds, cpuSeconds(1, [&] { tests = hair->step(kFrame).collider_tests; }));
    }
    // All tests with the forty are left out; those with the one are not.
    ASSERT_EQ(counted[1].of, 41 * counted[0].of);
    ASSERT_EQ(counted[1].skipped, counted[0].skipped + 40 * counted[0].of);
    looked = looked || counted[0].skipped < counted[0].of;
    ASSERT_EQ(test::largestDistance(without.state.positions, with.state.positions), 0);
  }
  EXPECT_TRUE(looked);
  EXPECT_FALSE(with.state.contacts.empty());
  EXPECT_LT(least[1], 1.1 * least[0]) << "forty bodies";
}

}  // namespace skips_step_test
