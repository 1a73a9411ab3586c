// The deadline of a frame's simulation: held by counted work, whatever the motion; what is left out is told.
#include "app/scene/detail/deadline.h"

#include <gtest/gtest.h>

#include "app/files/data_path.h"
#include "app/scene/demo.h"

namespace deadline_test {

constexpr double kFrame = 1.0 / 60, kUnit = app::Deadline{}.seconds_per_unit;

app::Demo openJump(double deadline_ms, double speed) {
  app::Scene scene = app::loadScene(app::dataPath("assets/scenes/walk.json"));
  scene.characters.resize(1);
  scene.characters[0].motion = app::findFile("jump_spin.bvh", "", "clips");
  scene.characters[0].style = app::Style::kLong;
  scene.characters[0].resolution = app::Resolution::kLow;
  scene.playback.deadline_ms = deadline_ms;
  scene.playback.speed = speed;
  app::Demo demo = app::openScene(std::move(scene), 1);
  demo.deadline.counted = true;
  return demo;
}

struct Played {
  double dearest = 0;  // s, of a frame by counted work
  double lost = 0;     // s
  int solves_cut = 0, corrections_cut = 0;
  bool finite = true;
};

Played play(app::Demo& demo, int frames) {
  Played played;
  for (int f = 0; f < frames; ++f) {
    app::advanceFrame(demo, kFrame, {});
    played.dearest = std::max(played.dearest, kUnit * demo.stats.work_units);
    played.solves_cut += demo.stats.solves_cut;
    played.corrections_cut += demo.stats.corrections_cut;
    for (const sim::Vec3& p : demo.actors[0].hair.positions) played.finite = played.finite && p.allFinite();
  }
  played.lost = demo.clock.lost;
  return played;
}

TEST(Deadline, IsOffByDefaultAndThenLeavesNothingOut) {
  app::Demo demo = openJump(0, 10);
  const Played played = play(demo, 120);
  EXPECT_EQ(played.solves_cut, 0);
  EXPECT_EQ(played.lost, 0);
}

TEST(Deadline, HoldsEveryFrameOfAFastJumpAndSaysWhatItLeftOut) {
  app::Demo free = openJump(0, 10);
  const double dearest = play(free, 240).dearest, deadline = 0.4 * dearest;
  app::Demo demo = openJump(1e3 * deadline, 10);
  const Played played = play(demo, 240);
  std::printf("dearest frame %.3f ms, with a deadline of %.3f: %.3f; %d solves, %d corrections cut, %.0f ms lost\n",
              1e3 * dearest, 1e3 * deadline, 1e3 * played.dearest, played.solves_cut, played.corrections_cut,
              1e3 * played.lost);
  EXPECT_TRUE(played.finite);
  EXPECT_LT(played.dearest, 1.75 * deadline);  // that nothing is inside the body comes first
  EXPECT_GT(played.solves_cut + played.corrections_cut, 0);
}

TEST(Deadline, LeavesStepsOutWhereAFrameCannotAffordThem) {
  app::Demo demo = openJump(0, 1);
  demo.scene.sim.time_step = 1.0 / 480;
  demo.requests.push_back({app::Ask::kDeadline, "", "", 0});
  const double usual = play(demo, 30).dearest;
  demo.requests.push_back({app::Ask::kDeadline, "", "", 1e3 * 0.25 * usual});
  const double before = demo.clock.lost;
  const Played played = play(demo, 60);
  EXPECT_GT(played.lost - before, 0.2);
  EXPECT_GT(demo.stats.steps, 0) << "motion slows down, it does not stop";
}

TEST(Deadline, IsSharedByTheHairsOfAFrameAndByItsSteps) {
  app::Deadline deadline;
  EXPECT_EQ(app::affordableSteps(7, deadline), 7);
  EXPECT_EQ(app::workOfStep(100, 1000, deadline), INFINITY);
  deadline.seconds = 1000 * deadline.seconds_per_unit;
  EXPECT_EQ(app::affordableSteps(7, deadline), 7) << "not known yet what a step takes";
  const double learned = deadline.seconds_per_unit;
  app::observeWork(2, 500, 1, deadline);
  EXPECT_GT(deadline.seconds_per_unit, learned) << "this machine is slow";
  deadline.counted = true, deadline.seconds_per_unit = 1e-6, deadline.seconds = 1e-3;
  app::observeWork(2, 500, 1, deadline);
  EXPECT_EQ(deadline.seconds_per_unit, 1e-6);
  EXPECT_EQ(app::affordableSteps(7, deadline), 4);
  EXPECT_EQ(app::affordableSteps(3, deadline), 3);
  EXPECT_DOUBLE_EQ(app::workOfStep(100, 400, deadline), 250);
  deadline.left = -5;
  EXPECT_EQ(app::workOfStep(100, 400, deadline), 0);
  deadline.seconds = 1e-9;
  EXPECT_EQ(app::affordableSteps(3, deadline), 1) << "one at least";
}

}  // namespace deadline_test
