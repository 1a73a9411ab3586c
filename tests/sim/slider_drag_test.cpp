// A dragged slider never stalls a frame: what is derived from the material at a cost follows in slices, and ends where
// an immediate refresh would.
#include <gtest/gtest.h>
#include <time.h>

#include <algorithm>
#include <cstring>
#include <functional>

#include "app/files/data_path.h"
#include "app/scene/actor.h"
#include "sim/forces/rest_balance.h"
#include "sim/sim_params.h"
#include "tests/sim_probes.h"
#include "tests/test_meshes.h"

namespace slider_drag_test {

using sim::SimParams;
using sim::Vec3;

constexpr double kFrame = 1.0 / 60;
constexpr int kEnough = 200;  // steps in which every refresh is over

double cpuSeconds() {
  timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

const char* const kSliders[] = {"density", "stretch_along", "stretch_across", "stretch_edge", "shear",
                                "bend",    "volume",        "damping",        "air_drag",     "gravity"};

void scale(const char* name, double factor, SimParams& params) {
  const sim::ParamField& field = *sim::findParam(name);
  field.set(params, std::clamp(field.get(params) * factor, field.minimum, field.maximum));
}

test::PatchOptions patch() {
  test::PatchOptions o;
  o.nx = 4, o.nz = 3, o.layers = 7, o.mixed = true;
  return o;
}

bool sameBits(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(Vec3)) == 0;
}

// Steps with the roots shaken, the parameters set by `turn` before each.
void run(test::Hair& hair, int steps, const std::function<void(int, SimParams&)>& turn) {
  const std::vector<Vec3> rest = hair.roots;
  for (int k = 0; k < steps; ++k) {
    turn(k, hair.params);
    for (std::size_t c = 0; c < rest.size(); ++c)
      hair.roots[c] = rest[c] + Vec3(0.01 * std::sin(0.3 * (k + 1)) * std::exp(-0.01 * k), 0, 0);
    hair.step(kFrame);
  }
  hair.roots = rest;
}

void dragAll(int k, SimParams& params) {
  if (k >= 20) return;
  for (const char* name : kSliders) scale(name, k % 2 ? 1.06 : 1.02, params);
}

// Elastic force at rest plus weight over the weight, largest over free vertices.
double imbalance(const sim::HairMesh& mesh, const sim::ForceModel<double>& model, const SimParams& params) {
  std::vector<sim::V3<double>> force(mesh.vertexCount(), {0, 0, 0});
  sim::Evaluation<double> out;
  out.force = force;
  sim::evaluate<double>(model, test::plain<double>(mesh.shape.positions), out);
  double most = 0;
  for (int i = 0; i < mesh.vertexCount(); ++i) {
    if (mesh.isRoot(i)) continue;
    const double weight = params.density * mesh.vertex_volume[i] * params.gravity;
    most = std::max(most, (test::eigen(force[i]) - Vec3(0, weight, 0)).norm() / weight);
  }
  return most;
}

TEST(SliderDrag, GravityStaysBalancedWhileStiffnessAndWeightChange) {
  const sim::HairMesh mesh = sim::buildHairMesh(test::combedShape(patch()));
  const sim::BlockPattern pattern = sim::systemPattern(mesh);
  SimParams params;
  params.stretch_along = 1e6;
  sim::Material material(mesh, pattern);
  material.set(params);
  ASSERT_LT(imbalance(mesh, material.model, params), 1e-6);
  for (const char* name : {"density", "gravity", "stretch_along", "stretch_across", "shear", "bend", "volume"}) {
    for (const double factor : {0.7, 2.0}) {
      scale(name, factor, params);
      material.follow(params);
      EXPECT_LT(imbalance(mesh, material.model, params), 1e-6) << name << " times " << factor;
    }
  }
}

TEST(SliderDrag, TheBalanceEndsAsTheOneMadeAtOnce) {
  const sim::HairMesh mesh = sim::buildHairMesh(test::combedShape(patch()));
  const sim::BlockPattern pattern = sim::systemPattern(mesh);
  SimParams params;
  sim::Material material(mesh, pattern);
  material.set(params);
  for (int k = 0; k < 12; ++k) {
    scale("stretch_along", 1.3, params);
    scale("bend", 0.9, params);
    material.follow(params);
    material.work();
  }
  EXPECT_TRUE(material.outdated());
  int steps = 0;
  while (material.outdated() && steps < kEnough) material.work(), ++steps;
  EXPECT_LT(steps, kEnough);
  const sim::ForceModel<double> at_once = test::makeForceModel(mesh, pattern, params);
  material.model.forEach([&]<class Kind>(const sim::Elements<Kind, double>& elements) {
    EXPECT_EQ(elements.shift, at_once.of<Kind>().shift) << Kind::kName;
    EXPECT_EQ(elements.stiffness, at_once.of<Kind>().stiffness) << Kind::kName;
  });
}

// Hair that takes another's place starts from how far gravity would draw that one.
TEST(SliderDrag, ABalanceGoesOnFromWhereAnotherEnded) {
  const sim::HairMesh mesh = sim::buildHairMesh(test::combedShape(patch()));
  const sim::BlockPattern pattern = sim::systemPattern(mesh);
  const SimParams params;
  sim::Material first(mesh, pattern), same(mesh, pattern), far(mesh, pattern), none(mesh, pattern);
  first.set(params);
  ASSERT_EQ(first.sag().size(), static_cast<std::size_t>(mesh.vertexCount()));
  same.startFrom(first.sag());
  ASSERT_TRUE(same.start(params));
  EXPECT_FALSE(same.outdated()) << "nothing is left to solve";
  first.model.forEach([&]<class Kind>(const sim::Elements<Kind, double>& elements) {
    EXPECT_EQ(elements.shift, same.model.of<Kind>().shift) << Kind::kName;
  });
  far.startFrom(std::vector<sim::V3<double>>(first.sag().size()));
  ASSERT_TRUE(far.start(params));
  EXPECT_TRUE(far.outdated()) << "the step has done so much of it";
  int steps = 0;
  while (far.outdated() && steps < kEnough) far.work(), ++steps;
  EXPECT_LT(steps, kEnough);
  EXPECT_LT(imbalance(mesh, far.model, params), 1e-6);
  EXPECT_FALSE(none.start(params));
}

TEST(SliderDrag, WithoutABalanceTheMotionIsThatOfAnImmediateRefresh) {
  SimParams params = test::tautHair();
  params.sag_free = false;
  test::Hair gradual(test::combedShape(patch()), params), immediate(test::combedShape(patch()), params);
  gradual.context.refreshGradually(true);
  for (test::Hair* hair : {&gradual, &immediate}) run(*hair, 60, dragAll);
  EXPECT_LT(test::largestDistance(gradual.state.positions, immediate.state.positions), 1e-6 * 0.2);
}

TEST(SliderDrag, TheHairComesToRestWhereAnImmediateRefreshLetsIt) {
  SimParams params = test::tautHair();
  params.air_drag = 4;
  test::Hair gradual(test::combedShape(patch()), params), immediate(test::combedShape(patch()), params);
  gradual.context.refreshGradually(true);
  for (test::Hair* hair : {&gradual, &immediate}) {
    run(*hair, 60, dragAll);
    for (int k = 0; k < 600; ++k) hair->step(kFrame);
  }
  EXPECT_LT(test::largestDistance(gradual.state.positions, immediate.state.positions), 1e-5 * 0.2);
}

TEST(SliderDrag, RunsRepeatToTheBit) {
  const SimParams params;
  test::Hair one(test::combedShape(patch()), params), two(test::combedShape(patch()), params);
  for (test::Hair* hair : {&one, &two}) {
    hair->context.refreshGradually(true);
    run(*hair, 80, dragAll);
  }
  EXPECT_TRUE(sameBits(one.state.positions, two.state.positions));
}

TEST(SliderDrag, AThousandfoldStiffnessStillConverges) {
  test::Hair hair(test::combedShape(patch()), SimParams{});
  hair.context.refreshGradually(true);
  run(hair, 20, [](int, SimParams&) {});
  const auto start = hair.state.positions;
  for (const double factor : {1e3, 1e-3}) {
    for (const char* name : {"stretch_along", "stretch_across", "shear", "bend"}) scale(name, factor, hair.params);
    for (int k = 0; k < 60; ++k) {
      const sim::StepReport report = hair.step(kFrame);
      EXPECT_TRUE(report.converged) << factor << " step " << k;
      EXPECT_EQ(report.recoveries, 0);
    }
  }
  EXPECT_LT(test::largestDistance(start, hair.state.positions), 0.02);
}

constexpr int kUndisturbed = 16, kFramesEach = 8;

// The large mesh at rest, put back there before each run.
struct LargeHair {
  app::AssetCache asset_cache;
  app::Actor actor;
  SimParams standard;
  sim::HairState start;
  app::Playback playback;

  LargeHair() {
    app::CharacterSpec spec;
    spec.motion = app::findFile("head_shake.bvh", "", "clips");
    spec.style = app::Style::kLong;
    spec.resolution = app::Resolution::kHigh;
    actor = app::makeActor(spec, {}, asset_cache);
    standard.collide = false;
    app::settleActor(standard, 0.2, actor);
    start = actor.hair;
    playback = actor.playback;
  }
  std::vector<double> dragTimes(double drag);
};

// CPU seconds of each frame while every slider in turn is dragged to `drag` times its value and back.
std::vector<double> LargeHair::dragTimes(double drag) {
  actor.context = std::make_unique<sim::StepContext>(actor.haircut->mesh);
  actor.context->refreshGradually(true);
  actor.playback = playback;
  app::placeActor(actor, true);
  actor.hair = start;
  SimParams params = standard;
  params.max_iterations = 400;  // what the drag costs is to be seen
  std::vector<double> times;
  const auto frame = [&] {
    app::moveActor(kFrame, actor);
    const double begun = cpuSeconds();
    const sim::StepReport report =
        app::simulateActor(params, kFrame, static_cast<double>(times.size()) * kFrame, actor);
    times.push_back(cpuSeconds() - begun);
    EXPECT_TRUE(report.converged);
    EXPECT_EQ(report.recoveries, 0);
  };
  for (int k = 0; k <= kUndisturbed; ++k) frame();  // the first builds the factor
  for (const char* name : kSliders) {
    for (int k = 0; k < kFramesEach; ++k) {
      scale(name, k < kFramesEach / 2 ? drag : 1 / drag, params);
      frame();
    }
  }
  for (int k = 0; k < kUndisturbed; ++k) frame();
  times.erase(times.begin(), times.begin() + kUndisturbed + 1);
  return times;
}

// Every slider dragged up and down in turn while the head is shaken, against the same frames without a drag. No
// contacts: they come and go, and make frames of three times the median by themselves. A frame's time is the least of
// its runs: its own work is the same, other work on the machine is not. Runs end when the bound holds, after two at
// least.
TEST(SliderDrag, NoFrameStallsOnTheLargeMesh) {
  constexpr double kMultiple = 2;  // of the worst frame without a drag; an immediate refresh takes 10 times as long
  constexpr int kMaxRepeats = 6;
  LargeHair hair;
  std::vector<double> least[2];
  double median = 0, usual_worst = 0, worst = 0, ratio = INFINITY;
  for (int repeat = 0; repeat < 2 || (repeat < kMaxRepeats && ratio >= kMultiple); ++repeat) {
    for (const bool drag : {false, true}) {
      const std::vector<double> times = hair.dragTimes(drag ? 1.2 : 1);
      if (repeat == 0) least[drag] = times;
      for (std::size_t k = 0; k < times.size(); ++k) least[drag][k] = std::min(least[drag][k], times[k]);
    }
    std::vector<double> calm = least[0];
    std::nth_element(calm.begin(), calm.begin() + calm.size() / 2, calm.end());
    median = calm[calm.size() / 2];
    usual_worst = *std::max_element(calm.begin(), calm.end());
    worst = *std::max_element(least[1].begin(), least[1].end());
    ratio = worst / usual_worst;
  }
  std::printf(
      "%d vertices: median %.2f ms and worst %.2f ms without a drag; worst frame of the drags %.2f ms: %.2f times\n",
      hair.actor.haircut->mesh.vertexCount(), 1e3 * median, 1e3 * usual_worst, 1e3 * worst, ratio);
  EXPECT_LT(ratio, kMultiple);
}

}  // namespace slider_drag_test
