// In and out points, baking and clearing of the timeline.
#include <gtest/gtest.h>

#include "app/files/recording.h"
#include "app/scene/demo.h"
#include "app/scene/edit/groom_brush.h"
#include "app/scene/edit/paint_brush.h"
#include "tests/app/scene/small_scene.h"

namespace timeline_range_test {

using app::Ask;

app::Demo moving() {
  app::Demo demo = app::openScene(test::smallScene("head_shake.bvh"), 1.5);
  demo.timeline.on = true;
  return demo;
}

void play(int frames, app::Demo& demo) {
  for (int frame = 0; frame < frames; ++frame) app::advanceFrame(demo, 1.0 / 60, {});
}

void ask(Ask what, double value, app::Demo& demo) {
  demo.requests = {{what, "", "", value}};
  app::advanceFrame(demo, 0, {});
}

TEST(TimelineRange, PlayingGoesRoundBetweenInAndOutInTheSameBits) {
  app::Demo demo = moving();
  play(11, demo);
  ask(Ask::kMarkIn, 1, demo);
  const long in = demo.timeline.in;
  play(18, demo);
  ask(Ask::kMarkOut, 1, demo);
  const long out = demo.timeline.out;
  ASSERT_GT(out, in);
  std::string first, second;
  for (int k = 0; k < 200 && second.empty(); ++k) {
    play(1, demo);
    EXPECT_LE(demo.timeline.now, out);
    EXPECT_GE(demo.timeline.now, in);
    if (demo.timeline.now == out - 2) (first.empty() ? first : second) = app::stateHash(demo);
  }
  EXPECT_FALSE(first.empty());
  EXPECT_EQ(first, second);
  ask(Ask::kMarkOut, 0, demo);
  play(40, demo);
  EXPECT_GT(demo.timeline.now, out) << "it still goes back";
}

// Any frame can be gone to, and it is the one that was seen: to the bit, and so is what follows.
TEST(TimelineRange, EveryFrameIsGoneBackToInTheSameBits) {
  app::Demo demo = moving();
  play(20, demo);
  std::vector<std::string> seen;
  std::vector<double> shown;
  for (int k = 0; k < 12; ++k) {
    const double seconds = k % 4 == 3 ? 1.0 / 30 : 1.0 / 60;
    app::advanceFrame(demo, seconds, {});
    seen.push_back(app::stateHash(demo)), shown.push_back(demo.shown_time);
  }
  const long last = demo.timeline.now;
  demo.paused = true;
  for (const int back : {1, 4, 2, 11, 7, 0}) {
    ask(Ask::kRewind, static_cast<double>(last - back), demo);
    ASSERT_FALSE(demo.message_is_fault) << demo.message;
    EXPECT_EQ(demo.timeline.now, last - back);
    EXPECT_EQ(app::stateHash(demo), seen[seen.size() - 1 - static_cast<std::size_t>(back)]) << back;
    EXPECT_NEAR(demo.shown_time, shown[shown.size() - 1 - static_cast<std::size_t>(back)], 1e-12) << back;
  }
  ask(Ask::kRewind, static_cast<double>(last - 4), demo);
  demo.paused = false;
  for (int k = 8; k < 12; ++k) app::advanceFrame(demo, k % 4 == 3 ? 1.0 / 30 : 1.0 / 60, {});
  EXPECT_EQ(app::stateHash(demo), seen.back());
}

TEST(TimelineRange, BakingFillsTheTimelineAndStandsAtItsStart) {
  app::Demo demo = moving();
  play(6, demo);
  const long before = demo.timeline.now;
  ask(Ask::kBake, 1, demo);
  for (int k = 0; k < 60 && !demo.paused; ++k) play(1, demo);
  EXPECT_TRUE(demo.paused);
  EXPECT_LE(demo.timeline.now, before + 1);
  EXPECT_GE(demo.timeline.frames.back().frame, before + 50);
  ask(Ask::kClearBake, 0, demo);
  EXPECT_TRUE(demo.timeline.frames.empty());
  EXPECT_LT(demo.timeline.in, 0);
}

TEST(TimelineRange, BakingBeginsWithThePresentMomentWhereNothingIsKept) {
  app::Demo demo = moving();
  play(7, demo);
  ask(Ask::kPause, 1, demo);
  ask(Ask::kClearBake, 0, demo);
  const long here = demo.timeline.now;
  const std::string before = app::stateHash(demo);
  ask(Ask::kBake, 1, demo);
  EXPECT_FALSE(demo.message_is_fault) << demo.message;
  for (int k = 0; k < 60 && !demo.paused; ++k) play(1, demo);
  EXPECT_EQ(demo.timeline.now, here);
  EXPECT_EQ(app::stateHash(demo), before);
  EXPECT_GE(demo.timeline.frames.back().frame, here + 57);
}

TEST(TimelineRange, TheShownTimeIsWhatWasSimulated) {
  app::Demo demo = moving();
  demo.actors[0].playback.speed = 1;
  const double step = demo.scene.sim.time_step;
  const double clip = demo.actors[0].playback.time;
  for (int k = 0; k < 3; ++k) app::advanceFrame(demo, 1, {});
  EXPECT_NEAR(demo.shown_time, 3 * demo.scene.sim.max_steps_per_frame * step, 1e-9) << "frames of a second each";
  EXPECT_NEAR(demo.shown_time, demo.actors[0].playback.time - clip, step + 1e-9);
  for (int k = 0; k < 4; ++k) ask(Ask::kSingleStep, 0, demo);
  EXPECT_NEAR(demo.shown_time, (3 * demo.scene.sim.max_steps_per_frame + 4) * step, 1e-9);
  EXPECT_NEAR(demo.shown_time, demo.actors[0].playback.time - clip, 1e-9);
}

// Frames go on while a person looks at a paused picture, time does not.
TEST(TimelineRange, WhilePausedThePlaceStandsAndPlayingOnReplacesWhatFollowed) {
  app::Demo demo = moving();
  play(60, demo);
  demo.paused = true;
  play(40, demo);
  EXPECT_EQ(app::timelinePlace(demo), 60);
  ask(Ask::kRewind, 21, demo);
  const double then = demo.shown_time;
  play(100, demo);
  EXPECT_EQ(app::timelinePlace(demo), 21);
  demo.paused = false;
  play(12, demo);
  long first = 0, last = 0;
  ASSERT_TRUE(app::timelineSpan(demo.timeline, first, last));
  EXPECT_EQ(last, 33);
  EXPECT_EQ(app::timelinePlace(demo), 33);
  EXPECT_NEAR(demo.shown_time, then + 12.0 / 60, 1e-9);
}

TEST(TimelineRange, PointsStayInOrderAndLoopsAreMarked) {
  app::Demo demo = moving();
  play(10, demo);
  ask(Ask::kMarkOut, 1, demo);
  const long out = demo.timeline.out;
  ask(Ask::kMarkIn, 1, demo);
  EXPECT_TRUE(demo.message_is_fault);
  EXPECT_LT(demo.timeline.in, 0);
  EXPECT_EQ(demo.timeline.out, out);
  ask(Ask::kMarkOut, 0, demo);
  const int round = static_cast<int>(demo.actors[0].playedClip().duration() * 60);
  play(round, demo);
  int loops = 0;
  for (const app::TimelineFrame& frame : demo.timeline.frames) loops += frame.loop;
  EXPECT_EQ(loops, 1);
}

// The hair about one of its vertices made longer.
void growHair(app::Demo& demo) {
  app::BrushSample sample{app::BrushTool::kGrow, app::seenFromScalp(demo.actors[0]).back()};
  sample.radius = 0.1;
  demo.requests = {{Ask::kBrush, "grow", app::brushText(sample)}};
  app::advanceFrame(demo, 0, {});
  ASSERT_FALSE(demo.message_is_fault) << demo.message;
}

TEST(TimelineRange, AnEditLeavesWhatWasBeforeItToLookAtAndToGoOnFrom) {
  app::Demo demo = moving();
  play(21, demo);
  const std::vector<app::Vec3> then = demo.actors[0].hair.positions;
  play(39, demo);
  long first = 0, last = 0;
  demo.paused = true;
  ask(Ask::kRewind, 42, demo);
  growHair(demo), growHair(demo);
  const std::vector<app::Vec3> shape = demo.actors[0].haircut->mesh.shape.positions;
  ASSERT_TRUE(app::timelineSpan(demo.timeline, first, last));
  EXPECT_EQ(first, 3);
  EXPECT_EQ(last, 39) << "what was simulated after the edit's moment is of other hair";
  ask(Ask::kRewind, 21, demo);
  EXPECT_FALSE(demo.message_is_fault) << demo.message;
  EXPECT_EQ(app::timelinePlace(demo), 21);
  EXPECT_EQ(demo.actors[0].hair.positions, then) << "the hair as it was";
  EXPECT_EQ(demo.actors[0].haircut->mesh.shape.positions, shape) << "the edit stays";
  demo.paused = false;
  demo.requests = {{Ask::kSetParam, "gravity", "3"}};
  play(30, demo);
  EXPECT_EQ(demo.stats.recoveries, 0);
  ASSERT_TRUE(app::timelineSpan(demo.timeline, first, last));
  EXPECT_EQ(first, 3);
  EXPECT_EQ(last, 51);
  std::size_t bytes = 0;
  for (const app::TimelineFrame& frame : demo.timeline.frames) bytes += frame.state.size();
  EXPECT_GE(demo.timeline.bytes, bytes);
  EXPECT_LE(demo.timeline.bytes, bytes + 2 * shape.size() * sizeof(app::Vec3));
}

// What is painted moves no hair, or changes its rest shape: neither the stroke nor its undo takes what was before away.
TEST(TimelineRange, PaintAndItsUndoLeaveWhatWasKept) {
  for (const std::string field : {"color", "curl", "density", "length", "stiffness", "mass"}) {
    app::Demo demo = moving();
    play(30, demo);
    demo.paused = true;
    app::advanceFrame(demo, 0, {});
    const std::string before = app::editHash(demo);
    const std::vector<app::Vec3> shape = demo.actors[0].haircut->mesh.shape.positions;
    app::PaintSample sample{field, app::Vec3(0.05, 0.17, 0), 0.08, 0.8, 1, true, 0.3};
    demo.requests = {{Ask::kPaint, field, app::paintText(sample)}};
    app::advanceFrame(demo, 0, {});
    ASSERT_EQ(demo.edits.done, 1u) << field << ": " << demo.message;
    const std::string painted = app::editHash(demo);
    EXPECT_NE(painted, before) << field;
    for (const auto& [what, hash] : {std::pair(Ask::kUndo, before), std::pair(Ask::kRedo, painted)}) {
      ask(what, 1, demo);
      EXPECT_EQ(app::editHash(demo), hash) << field << ": " << demo.message;
      long first = 0, last = 0;
      ASSERT_TRUE(app::timelineSpan(demo.timeline, first, last)) << field;
      EXPECT_EQ(first, 3) << field;
      EXPECT_GE(last, 27) << field;
      EXPECT_FALSE(demo.timeline.anew) << field;
    }
    ask(Ask::kUndo, 1, demo);
    EXPECT_EQ(demo.actors[0].haircut->mesh.shape.positions, shape) << field;
    EXPECT_FALSE(app::reshapedByHand(*demo.actors[0].haircut)) << field;
  }
}

// Hair that has moved on since a stroke that moves none stays where it is when that is undone.
TEST(TimelineRange, UndoneColorLeavesTheHairWhereItIs) {
  app::Demo demo = moving();
  play(6, demo);
  app::PaintSample sample{"color", app::Vec3(0.05, 0.17, 0), 0.08, 0.8, 1, true};
  demo.requests = {{Ask::kPaint, "color", app::paintText(sample)}};
  play(12, demo);
  const std::string there = app::stateHash(demo);
  ask(Ask::kUndo, 1, demo);
  EXPECT_EQ(demo.message, "undone: Paint color");
  EXPECT_EQ(app::stateHash(demo), there);
}

TEST(TimelineRange, AnotherMeshBeginsTheTimelineAnewAndItIsSaid) {
  app::Demo demo = moving();
  play(30, demo);
  demo.paused = true;
  demo.requests = {{Ask::kMesh, "add-layer", "1"}};
  app::advanceFrame(demo, 0, {});
  EXPECT_TRUE(demo.timeline.frames.empty());
  EXPECT_TRUE(demo.timeline.anew);
  demo.paused = false;
  play(static_cast<int>(app::kAnewMoments * app::kTimelineEvery) + 3, demo);
  EXPECT_FALSE(demo.timeline.anew);
}

}  // namespace timeline_range_test
