// Strokes on moving hair: the hair follows, stays, is undone, and a recorded take of it replays to the bit.
#include "app/scene/edit/groom_brush.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "app/files/data_path.h"
#include "app/files/errors.h"
#include "app/files/recording.h"
#include "app/scene/demo.h"
#include "app/scene/detail/level_of_detail.h"
#include "app/scene/edit/cut_stroke.h"
#include "app/scene/edit/picking.h"
#include "tests/run_program.h"

namespace groom_brush_test {

using app::Ask;

app::Scene sceneOf(app::Resolution resolution, const char* clip) {
  app::Scene scene;
  app::CharacterSpec spec;
  spec.motion = app::dataPath(std::string("assets/clips/") + clip);
  spec.style = app::Style::kLong;
  spec.resolution = resolution;
  scene.characters = {spec};
  scene.playback.settle = 0.3;
  return scene;
}

// The tip of the column that hangs farthest in front, scalp frame, as it is now.
sim::Vec3 frontTip(const app::Demo& demo, int& vertex) {
  const app::Actor& actor = demo.actors[0];
  const sim::HairMesh& mesh = actor.haircut->mesh;
  const app::Rigid to_scalp = app::scalpToWorld(actor.body->character, actor.pose).inverse();
  sim::Vec3 best(0, 0, -1);
  for (int c = 0; c < mesh.columnCount(); ++c) {
    const int tip = mesh.shape.column_first[static_cast<std::size_t>(c) + 1] - 1;
    const sim::Vec3 p = to_scalp * actor.hair.positions[static_cast<std::size_t>(tip)];
    if (p.z() > best.z()) best = p, vertex = tip;
  }
  return best;
}

app::Request sampleAt(app::BrushTool tool, const sim::Vec3& at, const sim::Vec3& along) {
  app::BrushSample sample;
  sample.tool = tool;
  sample.at = at, sample.along = along;
  sample.radius = 0.08, sample.strength = 0.6;
  return {Ask::kBrush, std::string(app::kBrushNames[static_cast<std::size_t>(tool)]), app::brushText(sample)};
}

// At one place, until all that it reaches is as short as it may be.
TEST(GroomBrush, CuttingAgainAndAgainIsNoFault) {
  app::Demo demo = app::openScene(sceneOf(app::Resolution::kMedium, "idle_turns.bvh"), 1.5);
  app::advanceFrame(demo, 0, {});
  int tip = -1;
  frontTip(demo, tip);
  const double before = demo.actors[0].haircut->mesh.total_volume;
  for (int n = 0; n < 60; ++n) {
    const app::Actor& actor = demo.actors[0];
    const sim::Vec3 at = app::scalpToWorld(actor.body->character, actor.pose).inverse() *
                         actor.hair.positions[static_cast<std::size_t>(tip)];
    demo.requests = {sampleAt(app::BrushTool::kCut, at, {0.01, 0, 0})};
    app::advanceFrame(demo, 1.0 / 60, {});
    ASSERT_FALSE(demo.message_is_fault) << n << ": " << demo.message;
  }
  EXPECT_LT(demo.actors[0].haircut->mesh.total_volume, 0.999 * before);
}

TEST(GroomBrush, ASampleReadsBackToTheSameBits) {
  app::BrushSample sample;
  sample.at = {0.1, -1.0 / 3, 2e-17};
  sample.along = {1e-3, 0, -7.7};
  sample.radius = 0.0123456789, sample.strength = 1.0 / 7, sample.falloff = 2.5, sample.mirror = true;
  const app::BrushSample back = app::parseBrush("puff", app::brushText(sample));
  EXPECT_EQ(app::brushText(back), app::brushText(sample));
  EXPECT_EQ(back.at, sample.at);
  EXPECT_EQ(back.tool, app::BrushTool::kPuff);
  for (const char* text : {"", "1 2 3", "0 0 0 0 0 0 9 1 1 0", "0 0 0 0 0 0 0.1 nan 1 0", "0 0 0 0 0 0 0.1 1 1 0 5"})
    EXPECT_THROW(app::parseBrush("comb", text), app::InputError) << text;
  EXPECT_THROW(app::parseBrush("saw", app::brushText(sample)), app::InputError);
}

TEST(GroomBrush, HairThatMovesTakesTheEditOnAndKeepsIt) {
  app::Demo demo = app::openScene(sceneOf(app::Resolution::kLow, "idle_turns.bvh"), 1.5);
  for (int frame = 0; frame < 10; ++frame) app::advanceFrame(demo, 1.0 / 60, {});
  const double length = demo.actors[0].haircut->mesh.hair_length;
  int tip = 0;
  for (int frame = 0; frame < 20; ++frame) {
    const sim::Vec3 at = frontTip(demo, tip);
    demo.requests = {sampleAt(app::BrushTool::kCut, at + sim::Vec3(0, 0.06, 0), sim::Vec3::Zero())};
    app::advanceFrame(demo, 1.0 / 60, {});
    ASSERT_FALSE(demo.message_is_fault) << demo.message;
  }
  const app::Actor& actor = demo.actors[0];
  EXPECT_TRUE(actor.haircut->edited);
  EXPECT_EQ(demo.edits.steps.size(), 1u) << "one drag is one step";
  const auto lengthOf = [&](const std::vector<sim::Vec3>& x) {
    const sim::HairMesh& mesh = actor.haircut->mesh;
    const int c = mesh.column_of[static_cast<std::size_t>(tip)];
    double sum = 0;
    for (int v = mesh.shape.column_first[static_cast<std::size_t>(c)] + 1; v <= tip; ++v)
      sum += (x[static_cast<std::size_t>(v)] - x[static_cast<std::size_t>(v) - 1]).norm();
    return sum;
  };
  const double cut = lengthOf(actor.haircut->mesh.shape.positions);
  EXPECT_LT(cut, 0.9 * length);
  int recoveries = 0;
  for (int frame = 0; frame < 60; ++frame) {
    app::advanceFrame(demo, 1.0 / 60, {});
    recoveries += demo.stats.recoveries;
  }
  EXPECT_EQ(recoveries, 0);
  EXPECT_NEAR(lengthOf(actor.hair.positions), cut, 0.03 * length) << "the hair has not followed";
  demo.requests = {{Ask::kUndo, "", "", 1}};
  app::advanceFrame(demo, 0, {});
  EXPECT_EQ(demo.actors[0].haircut->mesh.hair_length, length);
}

TEST(GroomBrush, WhilePausedAnEditIsSeenInTheNextFrame) {
  app::Demo demo = app::openScene(sceneOf(app::Resolution::kLow, "idle_turns.bvh"), 1.5);
  for (int frame = 0; frame < 30; ++frame) app::advanceFrame(demo, 1.0 / 60, {});
  demo.paused = true;
  app::advanceFrame(demo, 1.0 / 60, {});
  const app::Actor& actor = demo.actors[0];
  const std::vector<sim::Vec3> hair = actor.hair.positions, shape = actor.haircut->mesh.shape.positions;
  const std::vector<float> shown = actor.shown_positions;
  int tip = 0;
  demo.requests = {sampleAt(app::BrushTool::kPuff, frontTip(demo, tip), sim::Vec3::Zero())};
  app::advanceFrame(demo, 1.0 / 60, {});
  ASSERT_NE(actor.haircut->mesh.shape.positions, shape);
  EXPECT_NE(actor.shown_positions, shown);
  for (std::size_t v = 0; v < hair.size(); ++v)
    EXPECT_NEAR((actor.hair.positions[v] - hair[v]).norm(), (actor.haircut->mesh.shape.positions[v] - shape[v]).norm(),
                1e-9);
  demo.requests = {{Ask::kUndo, "", "", 1}};
  app::advanceFrame(demo, 0, {});
  EXPECT_EQ(demo.actors[0].hair.positions, hair);
  EXPECT_EQ(demo.actors[0].shown_positions, shown);
}

// Two seconds after the last stroke gravity is balanced in the new shape: what hangs still has not drooped. Of shares
// of the hair's length: the mean of all vertices, and the worst one, which of hair that grew stands out from the head.
TEST(GroomBrush, TwoSecondsAfterAnEditNothingHasDrooped) {
  for (const app::BrushTool tool : {app::BrushTool::kComb, app::BrushTool::kCut, app::BrushTool::kGrow,
                                    app::BrushTool::kSmooth, app::BrushTool::kPuff, app::BrushTool::kPinch,
                                    app::BrushTool::kSpread, app::BrushTool::kPush, app::BrushTool::kTwist}) {
    app::Scene scene = sceneOf(app::Resolution::kMedium, "idle_turns.bvh");
    scene.sim.collide = false;
    app::Demo demo = app::openScene(std::move(scene), 1.5);
    demo.actors[0].playback.paused = true;
    for (int frame = 0; frame < 60; ++frame) app::advanceFrame(demo, 1.0 / 60, {});
    int tip = 0;
    for (int frame = 0; frame < 20; ++frame) {
      const sim::Vec3 at = frontTip(demo, tip);
      demo.requests = {sampleAt(tool, at + sim::Vec3(0, 0.1, 0), sim::Vec3(0.003, 0.001, 0.004))};
      if (frame == 19) demo.requests.push_back({Ask::kEndGesture, "", ""});
      app::advanceFrame(demo, 1.0 / 60, {});
    }
    for (int frame = 0; frame < 120; ++frame) app::advanceFrame(demo, 1.0 / 60, {});
    const app::Actor& actor = demo.actors[0];
    const app::Rigid head = app::scalpToWorld(actor.body->character, actor.pose);
    double most = 0, sum = 0;
    for (std::size_t v = 0; v < actor.hair.positions.size(); ++v) {
      const double off = (actor.hair.positions[v] - head * actor.haircut->mesh.shape.positions[v]).norm();
      most = std::max(most, off), sum += off;
    }
    const double length = actor.haircut->mesh.hair_length;
    std::printf("%s: mean %.2f %%, worst %.2f %%\n", app::kBrushNames[static_cast<std::size_t>(tool)].data(),
                100 * sum / static_cast<double>(actor.hair.positions.size()) / length, 100 * most / length);
    EXPECT_LT(sum / static_cast<double>(actor.hair.positions.size()), 0.003 * length) << static_cast<int>(tool);
    EXPECT_LT(most, 0.01 * length) << static_cast<int>(tool);
  }
}

// A stroke round the head, hair by hair as a hand makes it: every column then ends at the ring, however long its
// neighbours were when their turn came.
TEST(GroomBrush, ACutAllRoundTheHeadArrivesAtTheRing) {
  constexpr double kRing = -0.02;  // m, scalp frame: at the chin
  app::Demo demo = app::openScene(sceneOf(app::Resolution::kMedium, "idle_turns.bvh"), 1.5);
  demo.actors[0].playback.paused = true;
  for (int frame = 0; frame < 20; ++frame) app::advanceFrame(demo, 1.0 / 60, {});
  const auto lowest = [&] {
    const sim::HairMesh& mesh = demo.actors[0].haircut->mesh;
    double low = 1;
    for (int c = 0; c < mesh.columnCount(); ++c)
      low = std::min(
          low, mesh.shape.positions[static_cast<std::size_t>(mesh.shape.column_first[std::size_t(c) + 1] - 1)].y());
    return low;
  };
  ASSERT_LT(lowest(), kRing - 0.15);
  for (int round = 0; round < 2; ++round) {
    for (int k = 0; k < 60; ++k) {
      const double turn = 1 + 4.283 * k / 59;
      const sim::Vec3 away(std::sin(turn), 0, std::cos(turn));
      const std::vector<sim::Vec3> seen = app::seenFromScalp(demo.actors[0]);
      double farthest = 0;
      sim::Vec3 at;
      for (const sim::Vec3& p : seen) {
        const sim::Vec3 flat(p.x(), 0, p.z());
        const double out = flat.dot(away);
        if (std::abs(p.y() - kRing) < 0.02 && (flat - out * away).norm() < 0.03 && out > farthest)
          farthest = out, at = p;
      }
      if (farthest == 0) continue;
      demo.requests = {sampleAt(app::BrushTool::kCut, at, sim::Vec3::Zero())};
      app::advanceFrame(demo, 1.0 / 60, {});
    }
    demo.requests = {{Ask::kEndGesture, "", ""}};
    app::advanceFrame(demo, 1.0 / 60, {});
    app::finishCuts(demo);
    ASSERT_FALSE(demo.message_is_fault) << demo.message;
  }
  EXPECT_GT(lowest(), kRing - 0.03);
  for (const sim::CornerTet& tet : demo.actors[0].haircut->mesh.tets) EXPECT_GT(tet.rest_volume, 0);
}

// A cut that has ended is worked on over some frames, in a paused window too. What is asked for meanwhile finds it
// finished, with the same hair; undo takes back the whole of it.
TEST(GroomBrush, ACutIsFinishedOverTheFramesAfterItsStroke) {
  const auto cutOpen = [] {
    app::Demo demo = app::openScene(sceneOf(app::Resolution::kMedium, "idle_turns.bvh"), 1.5);
    demo.paused = true;
    app::advanceFrame(demo, 1.0 / 60, {});
    int tip = 0;
    for (int k = 0; k < 3; ++k) {
      const sim::Vec3 at = frontTip(demo, tip) + sim::Vec3(0, 0.15, 0);
      demo.requests = {sampleAt(app::BrushTool::kCut, at, sim::Vec3::Zero())};
      app::advanceFrame(demo, 1.0 / 60, {});
    }
    demo.requests = {{Ask::kEndGesture, "", ""}};
    app::advanceFrame(demo, 1.0 / 60, {});
    return demo;
  };
  const auto shape = [](const app::Demo& demo) { return demo.actors[0].haircut->mesh.shape.positions; };
  app::Demo demo = cutOpen();
  const std::vector<sim::Vec3> given_way = shape(demo);
  int frames = 0;
  for (; app::cutsAreComing(demo) && frames < 200; ++frames) {
    EXPECT_EQ(shape(demo), given_way);
    EXPECT_FALSE(app::nothingMoves(demo));
    app::advanceFrame(demo, 1.0 / 60, {});
  }
  EXPECT_GE(frames, 2);
  EXPECT_LE(frames, 40);
  const std::vector<sim::Vec3> cut = shape(demo);
  EXPECT_NE(cut, given_way);

  app::Demo hasty = cutOpen();
  hasty.requests = {{Ask::kSetParam, "density", "70"}};
  app::advanceFrame(hasty, 0, {});
  EXPECT_EQ(shape(hasty), cut);
  app::Demo undone = cutOpen();
  const std::size_t steps = undone.edits.steps.size();
  undone.requests = {{Ask::kUndo, "", "", 1}};
  app::advanceFrame(undone, 0, {});
  EXPECT_EQ(undone.edits.done + 1, steps);
  EXPECT_NE(shape(undone), given_way);
  undone.requests = {{Ask::kRedo, "", "", 1}};
  app::advanceFrame(undone, 0, {});
  EXPECT_EQ(shape(undone), cut);
}

TEST(GroomBrush, HairThatIsMadeAnewSaysThatStrokesAreGoneAndUndoBringsThemBack) {
  app::Demo demo = app::openScene(sceneOf(app::Resolution::kLow, "idle_turns.bvh"), 1.5);
  const auto ask = [&](const app::Request& request) {
    demo.message.clear();
    demo.requests = {request, {Ask::kEndGesture, "", ""}};
    app::advanceFrame(demo, 0, {});
    EXPECT_FALSE(demo.message_is_fault) << demo.message;
    return demo.message;
  };
  const app::Request style{Ask::kStyle, "shoulder", ""};
  EXPECT_EQ(ask(style).find("brushes"), std::string::npos) << "nothing is gone";
  int tip = 0;
  const sim::Vec3 at = frontTip(demo, tip);
  ask(sampleAt(app::BrushTool::kCut, at + sim::Vec3(0, 0.06, 0), sim::Vec3::Zero()));
  app::finishCuts(demo);
  const std::vector<sim::Vec3> cut = demo.actors[0].haircut->mesh.shape.positions;
  ASSERT_TRUE(demo.actors[0].haircut->edited);
  EXPECT_NE(ask(style).find("what brushes made of the hair is gone"), std::string::npos) << demo.message;
  EXPECT_NE(demo.actors[0].haircut->mesh.shape.positions, cut);
  ask({Ask::kUndo, "", "", 1});
  EXPECT_EQ(demo.actors[0].haircut->mesh.shape.positions, cut);
}

TEST(GroomBrush, WhatMovesNothingSaysSoAndIsNoStep) {
  app::Demo demo = app::openScene(sceneOf(app::Resolution::kLow, "idle_turns.bvh"), 1.5);
  int tip = 0;
  const sim::Vec3 at = frontTip(demo, tip);
  for (int k = 0; k < 12; ++k) {
    demo.requests = {sampleAt(app::BrushTool::kFreeze, at, sim::Vec3::Zero())};
    app::advanceFrame(demo, 0, {});
  }
  demo.requests = {{Ask::kEndGesture, "", ""}};
  app::advanceFrame(demo, 0, {});
  const std::size_t steps = demo.edits.steps.size();
  app::BrushSample narrow;
  narrow.tool = app::BrushTool::kPuff, narrow.at = at, narrow.radius = 0.01, narrow.strength = 1;
  demo.requests = {{Ask::kBrush, "puff", app::brushText(narrow)}};
  app::advanceFrame(demo, 0, {});
  EXPECT_TRUE(demo.message_is_fault);
  EXPECT_NE(demo.message.find("moves nothing"), std::string::npos) << demo.message;
  EXPECT_EQ(demo.edits.steps.size(), steps);
}

TEST(GroomBrush, AStrokeThatSlidesOffTheHairIsNoFault) {
  app::Demo demo = app::openScene(sceneOf(app::Resolution::kLow, "idle_turns.bvh"), 1.5);
  int tip = 0;
  demo.requests = {sampleAt(app::BrushTool::kComb, frontTip(demo, tip), {0.01, 0, 0})};
  app::advanceFrame(demo, 0, {});
  demo.requests = {sampleAt(app::BrushTool::kComb, {3, 3, 3}, {0.01, 0, 0})};
  app::advanceFrame(demo, 0, {});
  EXPECT_FALSE(demo.message_is_fault) << demo.message;
  EXPECT_EQ(demo.edits.steps.size(), 1u);
  demo.requests = {{app::Ask::kEndGesture, "", ""}, sampleAt(app::BrushTool::kComb, {3, 3, 3}, {0.01, 0, 0})};
  app::advanceFrame(demo, 0, {});
  EXPECT_TRUE(demo.message_is_fault) << "a stroke that never touched hair";
}

TEST(GroomBrush, OffTheHairItSaysSoAndChangesNothing) {
  app::Demo demo = app::openScene(sceneOf(app::Resolution::kLow, "idle_turns.bvh"), 1.5);
  const std::string before = app::editHash(demo);
  demo.requests = {sampleAt(app::BrushTool::kCut, {3, 3, 3}, sim::Vec3::Zero())};
  app::advanceFrame(demo, 0, {});
  EXPECT_TRUE(demo.message_is_fault);
  EXPECT_NE(demo.message.find("reaches no hair"), std::string::npos) << demo.message;
  EXPECT_EQ(app::editHash(demo), before);
  EXPECT_FALSE(demo.actors[0].haircut->edited);
  EXPECT_TRUE(demo.edits.steps.empty());
  // A stroke that works takes the message away.
  int tip = 0;
  demo.requests = {sampleAt(app::BrushTool::kComb, frontTip(demo, tip), {0.01, 0, 0})};
  app::advanceFrame(demo, 0, {});
  EXPECT_TRUE(demo.actors[0].haircut->edited);
  EXPECT_EQ(demo.message, "");
}

// Freezing changes no shape; what is frozen other brushes leave, until it is thawed or undone.
TEST(GroomBrush, FrozenHairStaysUntilItIsThawed) {
  app::Demo demo = app::openScene(sceneOf(app::Resolution::kLow, "idle_turns.bvh"), 1.5);
  int tip = 0;
  const sim::Vec3 at = frontTip(demo, tip);
  const std::vector<sim::Vec3> before = demo.actors[0].haircut->mesh.shape.positions;
  const auto stroke = [&](app::BrushTool tool) {
    app::BrushSample sample;
    sample.tool = tool;
    sample.at = at, sample.along = {0.01, 0, 0.01};
    sample.radius = 0.3, sample.strength = 1, sample.falloff = 0;
    demo.requests = {
        {Ask::kBrush, std::string(app::kBrushNames[static_cast<std::size_t>(tool)]), app::brushText(sample)},
        {Ask::kEndGesture, "", ""}};
    app::advanceFrame(demo, 0, {});
    return demo.actors[0].haircut->mesh.shape.positions[static_cast<std::size_t>(tip)];
  };
  const sim::Vec3 start = before[static_cast<std::size_t>(tip)];
  EXPECT_EQ(stroke(app::BrushTool::kFreeze), start);
  EXPECT_EQ(stroke(app::BrushTool::kComb), start);
  EXPECT_NE(demo.message.find("moves nothing"), std::string::npos) << demo.message;
  EXPECT_EQ(demo.edits.steps.size(), 1u);
  stroke(app::BrushTool::kThaw);
  EXPECT_TRUE(demo.actors[0].haircut->frozen.empty());
  EXPECT_NE(stroke(app::BrushTool::kComb), start);
  demo.requests = {{Ask::kUndo, "", "", 2}};
  app::advanceFrame(demo, 0, {});
  EXPECT_FALSE(demo.actors[0].haircut->frozen.empty()) << "the thaw is undone as well";
  EXPECT_EQ(demo.actors[0].haircut->mesh.shape.positions, before);
}

// One of three who wear a haircut is brushed: the others keep theirs.
TEST(GroomBrush, OthersOfTheSameHaircutKeepTheirs) {
  app::Scene scene = sceneOf(app::Resolution::kLow, "idle_turns.bvh");
  scene.characters.push_back(scene.characters[0]);
  scene.characters[1].position = {1, 0, 0};
  app::Demo demo = app::openScene(std::move(scene), 1.5);
  ASSERT_EQ(demo.actors[0].haircut, demo.actors[1].haircut);
  const std::vector<sim::Vec3> before = demo.actors[0].haircut->mesh.shape.positions;
  int tip = 0;
  const sim::Vec3 at = frontTip(demo, tip);
  demo.requests = {sampleAt(app::BrushTool::kCut, at, sim::Vec3::Zero())};
  for (int frame = 0; frame < 5; ++frame) app::advanceFrame(demo, 1.0 / 60, {});
  EXPECT_TRUE(demo.actors[0].haircut->edited);
  EXPECT_FALSE(demo.actors[1].haircut->edited);
  EXPECT_NE(demo.actors[0].haircut->mesh.shape.positions, before);
  EXPECT_EQ(demo.actors[1].haircut->mesh.shape.positions, before);
}

TEST(GroomBrush, ARecordedTakeReplaysToTheBit) {
  const std::string file = test::freshFolder("groom_brush") + "/take.hmr";
  app::Options options;
  options.record = file;
  app::Scene scene = sceneOf(app::Resolution::kLow, "walk.bvh");
  app::Tape tape(options, scene);
  app::Demo demo = app::openScene(scene, tape.aspect());
  int tip = 0;
  for (int frame = 0; frame < 40; ++frame) {
    const sim::Vec3 at = frontTip(demo, tip);
    const auto tool = static_cast<app::BrushTool>(frame / 3 % 11);
    if (frame % 3 != 2 && frame < 30) demo.requests = {sampleAt(tool, at, {0.004, 0, 0.002})};
    if (frame == 33) demo.requests = {{Ask::kUndo, "", "", 2}};
    app::advanceFrame(demo, tape.turn(frame, 1.0 / 60, demo), {});
  }
  const std::string recorded = app::stateHash(demo);
  EXPECT_TRUE(demo.actors[0].haircut->edited);
  tape.end(demo);
  app::Options again;
  again.replay = file;
  app::Scene other;
  app::Tape replay(again, other);
  app::Demo copy = app::openScene(other, replay.aspect());
  for (int frame = 0; frame < replay.frames(); ++frame) app::advanceFrame(copy, replay.turn(frame, 0, copy), {});
  EXPECT_EQ(app::stateHash(copy), recorded);
  EXPECT_FALSE(replay.end(copy).differs);
}

TEST(Picking, ARayThroughAPixelMeetsWhatIsSeenThere) {
  app::Demo demo = app::openScene(sceneOf(app::Resolution::kLow, "idle_turns.bvh"), 1.5);
  const app::Actor& actor = demo.actors[0];
  for (const app::ViewPlace& place : {app::ViewPlace{}, app::ViewPlace{0.3, -0.2, 0.8}}) {
    const app::Picture picture{900, 600, place};
    int hits = 0;
    for (double x = 100; x < 900; x += 50) {
      for (double y = 50; y < 600; y += 50) {
        const std::optional<app::Vec3> hit = app::pickHair(app::rayThrough(x, y, picture, demo.camera), actor);
        if (!hit) continue;
        ++hits;
        const auto pixel = app::pixelOf(*hit, picture, demo.camera);
        ASSERT_TRUE(pixel);
        EXPECT_NEAR((*pixel)[0], x, 1e-6);
        EXPECT_NEAR((*pixel)[1], y, 1e-6);
      }
    }
    EXPECT_GT(hits, 5);
    EXPECT_FALSE(app::pickHair(app::rayThrough(2, 2, picture, demo.camera), actor));
  }
}

// From the front, through the face, lies the hair of the back of the head.
TEST(Picking, HairBehindTheHeadIsNotTaken) {
  app::Demo demo = app::openScene(sceneOf(app::Resolution::kLow, "idle_turns.bvh"), 1.5);
  const app::Actor& actor = demo.actors[0];
  const app::Rigid head = app::scalpToWorld(actor.body->character, actor.pose);
  const app::Vec3 nose = head * (actor.body->character.scalp.center + app::Vec3(0, -0.04, 0));
  const app::Vec3 front = head.linear() * app::Vec3::UnitZ();
  EXPECT_FALSE(app::pickHair({nose + front, -front}, actor));
  const std::optional<app::Vec3> back = app::pickHair({nose - front, front}, actor);
  ASSERT_TRUE(back);
  EXPECT_LT((*back - nose).dot(front), 0);
}

}  // namespace groom_brush_test
