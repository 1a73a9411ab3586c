// The frame's story: the clock, the requests, and runs that repeat themselves to the bit.
#include "app/scene/demo.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <numeric>
#include <string>
#include <vector>

#include "app/files/data_path.h"
#include "tests/run_program.h"

namespace demo_test {

using app::Ask;
using app::Demo;
using app::FixedClock;
using app::Request;

constexpr double kStep = 1.0 / 60;

TEST(FixedClock, AnyFrameRateTakesTheSameSteps) {
  for (const double fps : {7.0, 24.0, 25.0, 30.0, 59.94, 60.0, 75.0, 120.0, 144.0, 1000.0}) {
    FixedClock clock;
    double time = 0;
    for (int frame = 0; time < 10; ++frame) {
      const double seconds = std::min(1 / fps, 10 - time);
      app::tick(seconds, kStep, 64, clock);
      time += seconds;
    }
    EXPECT_EQ(clock.steps, 600) << fps;
    EXPECT_EQ(clock.lost, 0) << fps;
  }
}

TEST(FixedClock, UnevenFramesTakeTheSameSteps) {
  FixedClock clock;
  double time = 0;
  unsigned random = 1;
  while (time < 10) {
    random = random * 1664525u + 1013904223u;
    const double seconds = std::min(10 - time, 1e-4 + 0.09 * (random >> 8) / double(1 << 24));
    app::tick(seconds, kStep, 64, clock);
    time += seconds;
    EXPECT_GE(clock.ahead, -1e-6 * kStep);
    EXPECT_LT(clock.ahead, kStep);
  }
  EXPECT_EQ(clock.steps, 600);
}

TEST(FixedClock, AFrameShowsItsOwnMoment) {
  // The last state is at steps * kStep; the shown moment is the fraction between it and the one before.
  FixedClock clock;
  for (int frame = 1; frame <= 50; ++frame) {
    app::tick(1.0 / 144, kStep, 8, clock);
    const double shown = (static_cast<double>(clock.steps) - 1 + app::shownFraction(clock, kStep)) * kStep;
    EXPECT_NEAR(shown, frame / 144.0, 1e-7) << frame;
  }
}

TEST(FixedClock, TheCapSlowsTimeInsteadOfSpiralling) {
  FixedClock clock;
  EXPECT_EQ(app::tick(1.0, kStep, 8, clock), 8);
  EXPECT_NEAR(clock.lost, 52 * kStep, 1e-9);
  // What was given up does not come back.
  EXPECT_LE(app::tick(kStep, kStep, 8, clock), 1);
}

TEST(FixedClock, HostileSecondsDoNothingBad) {
  FixedClock clock;
  for (const double seconds : {0.0, -1.0, std::nan(""), -std::numeric_limits<double>::infinity()}) {
    EXPECT_EQ(app::tick(seconds, kStep, 8, clock), 0);
  }
  EXPECT_LE(app::tick(std::numeric_limits<double>::infinity(), kStep, 8, clock), 8);
  EXPECT_LE(app::tick(1e300, kStep, 8, clock), 8);
  EXPECT_TRUE(std::isfinite(clock.ahead) && std::isfinite(clock.lost));
}

Demo smallDemo(const std::string& motion = "head_shake.bvh") {
  app::Scene scene;
  scene.name = "test";
  app::CharacterSpec spec;
  spec.motion = app::dataPath("assets/clips/" + motion);
  spec.style = app::Style::kShort;
  spec.resolution = app::Resolution::kLow;
  scene.characters.push_back(spec);
  scene.playback.settle = 0.1;
  return app::openScene(std::move(scene), 1.5);
}

void expectFinite(const Demo& demo) {
  for (const app::Actor& actor : demo.actors) {
    for (const sim::Vec3& p : actor.hair.positions) ASSERT_TRUE(p.allFinite());
    for (const float value : actor.shown_positions) ASSERT_TRUE(std::isfinite(value));
  }
}

// Farthest that two demos' hair differs.
double difference(const Demo& a, const Demo& b) {
  double farthest = 0;
  for (std::size_t i = 0; i < a.actors[0].hair.positions.size(); ++i) {
    farthest = std::max(farthest, (a.actors[0].hair.positions[i] - b.actors[0].hair.positions[i]).norm());
  }
  return farthest;
}

TEST(Demo, HairDoesNotKnowTheFrameRate) {
  Demo reference = smallDemo();
  for (int frame = 0; frame <= 30; ++frame) app::advanceFrame(reference, frame ? 1.0 / 60 : 0, {});
  for (const double fps : {24.0, 30.0, 144.0}) {
    Demo demo = smallDemo();
    const int frames = static_cast<int>(fps / 2);
    for (int frame = 0; frame <= frames; ++frame) app::advanceFrame(demo, frame ? 1 / fps : 0, {});
    EXPECT_EQ(demo.clock.steps, reference.clock.steps) << fps;
    EXPECT_EQ(difference(demo, reference), 0) << fps;
  }
}

TEST(Demo, TheFirstFrameShowsTheStartAndTheHairMovesAfterwards) {
  Demo demo = smallDemo();
  app::advanceFrame(demo, 0, {});
  EXPECT_EQ(demo.stats.steps, 0);
  const std::vector<float> first = demo.actors[0].shown_positions;
  ASSERT_FALSE(first.empty());
  for (int frame = 0; frame < 30; ++frame) app::advanceFrame(demo, 1.0 / 60, {});
  EXPECT_NE(demo.actors[0].shown_positions, first);
  EXPECT_EQ(demo.stats.recoveries, 0);
  expectFinite(demo);
}

TEST(Demo, StillHairKeepsItsRevisions) {
  Demo demo = smallDemo();
  app::advanceFrame(demo, 1.0 / 60, {});
  demo.requests.push_back({Ask::kPause, "", "", 1});
  app::advanceFrame(demo, 1.0 / 60, {});
  const auto positions = demo.actors[0].position_revision, pose = demo.actors[0].pose_revision;
  for (int frame = 0; frame < 5; ++frame) app::advanceFrame(demo, 1.0 / 60, {});
  EXPECT_EQ(demo.actors[0].position_revision, positions);
  EXPECT_EQ(demo.actors[0].pose_revision, pose);
  EXPECT_EQ(demo.stats.steps, 0);
}

TEST(Demo, ASingleStepIsOneStep) {
  Demo demo = smallDemo();
  demo.requests.push_back({Ask::kPause, "", "", 1});
  app::advanceFrame(demo, 1.0 / 60, {});
  const long before = demo.clock.steps;
  demo.requests.push_back({Ask::kSingleStep, "", ""});
  app::advanceFrame(demo, 1.0 / 60, {});
  EXPECT_EQ(demo.stats.steps, 1);
  EXPECT_EQ(demo.clock.steps, before + 1);
}

TEST(Demo, CollapseAndResetAreWhatTheySay) {
  Demo demo = smallDemo();
  demo.requests = {{Ask::kPause, "", "", 1}, {Ask::kCollapse, "", ""}};
  app::advanceFrame(demo, 1.0 / 60, {});
  const sim::HairMeshShape& shape = demo.actors[0].haircut->mesh.shape;
  for (int c = 0; c < shape.columnCount(); ++c) {
    for (int v = shape.column_first[c]; v < shape.column_first[c + 1]; ++v) {
      EXPECT_LT((demo.actors[0].hair.positions[v] - demo.actors[0].hair.positions[shape.column_first[c]]).norm(),
                1e-12);
    }
  }
  demo.requests = {{Ask::kReset, "", ""}};
  app::advanceFrame(demo, 1.0 / 60, {});
  const Eigen::Isometry3d scalp = app::scalpToWorld(demo.actors[0].body->character, demo.actors[0].pose);
  for (int v = 0; v < shape.vertexCount(); ++v) {
    EXPECT_LT((demo.actors[0].hair.positions[v] - scalp * shape.positions[v]).norm(), 1e-9);
  }
}

TEST(Demo, ChangingTheStyleKeepsTheRest) {
  Demo demo = smallDemo();
  for (int frame = 0; frame < 20; ++frame) app::advanceFrame(demo, 1.0 / 60, {});
  demo.requests = {{Ask::kSetParam, "friction", "0.77"}, {Ask::kPause, "", "", 1}, {Ask::kStyle, "shoulder", ""}};
  const double time = demo.actors[0].playback.time;
  const int vertices = demo.actors[0].haircut->mesh.vertexCount();
  app::advanceFrame(demo, 1.0 / 60, {});
  EXPECT_NE(demo.actors[0].haircut->mesh.vertexCount(), vertices);
  EXPECT_EQ(demo.actors[0].playback.time, time);
  EXPECT_EQ(demo.scene.sim.friction, 0.77);
  EXPECT_EQ(demo.asset_cache.haircuts.size(), 1u) << "the old haircut should be gone";
  demo.requests = {{Ask::kPause, "", "", 0}};
  for (int frame = 0; frame < 10; ++frame) app::advanceFrame(demo, 1.0 / 60, {});
  expectFinite(demo);
}

// A groom's strands are drawn by what it tells of them, in place of the look that the hair before had; what was set by
// hand stays, and the style that comes back has its own.
TEST(Demo, AGroomBringsItsLookAndTakesItAway) {
  const std::string groom = test::freshFolder("demo_groom") + "/groom.hair";
  test::runProgram({"--no-images", "--frames", "1", "--style", "short", "--resolution", "low", "--strands", "60",
                    "--export", groom});
  app::Scene scene = app::loadScene(app::findFile("default.json", "", "scenes"));
  scene.playback.settle = 0;
  scene.characters[0].resolution = app::Resolution::kLow;
  Demo demo = app::openScene(scene, 1.5, false);
  const render::HairLook before = demo.actors[0].spec.look.hair;
  ASSERT_GT(before.lock, 0);
  ASSERT_GT(before.flyaways, 0);
  demo.requests = {{Ask::kSetParam, "drift", "0.001"}, {Ask::kHairFile, "", groom}};
  app::advanceFrame(demo, 1.0 / 60, {});
  ASSERT_TRUE(demo.actors[0].haircut->look) << demo.message;
  EXPECT_EQ(demo.actors[0].spec.look.hair.lock, 0);
  EXPECT_EQ(demo.actors[0].spec.look.hair.flyaways, 0);
  demo.requests = {{Ask::kStyle, "long", ""}};
  app::advanceFrame(demo, 1.0 / 60, {});
  EXPECT_EQ(demo.actors[0].spec.look.hair.lock, before.lock);
  EXPECT_FLOAT_EQ(demo.actors[0].spec.look.hair.drift, 0.001f);
}

TEST(Demo, WhatCannotBeLoadedLeavesWhatIsThere) {
  Demo demo = smallDemo();
  app::advanceFrame(demo, 1.0 / 60, {});
  const std::string folder = test::freshFolder("demo");
  std::ofstream(folder + "/broken.bvh") << "HIERARCHY\nROOT a\n{";
  std::ofstream(folder + "/broken.json") << "{";
  std::ofstream(folder + "/broken.obj") << "v 1 2";
  std::ofstream(folder + "/picture.gif") << "GIF89a";
  const app::Haircut* haircut = demo.actors[0].haircut;
  const app::LoadedBody* body = demo.actors[0].body;
  const std::vector<Request> faults{{Ask::kMotionFile, "", "missing.bvh"},
                                    {Ask::kMotionFile, "", folder + "/broken.bvh"},
                                    {Ask::kSceneFile, "", folder + "/broken.json"},
                                    {Ask::kPresetFile, "", folder + "/broken.json"},
                                    {Ask::kHairFile, "", folder + "/broken.obj"},
                                    {Ask::kOpenFile, "", folder + "/picture.gif"},
                                    {Ask::kOpenFile, "", folder},
                                    {Ask::kOpenFile, "", folder + "/broken.json"},
                                    {Ask::kStyle, "mohawk", ""},
                                    {Ask::kResolution, "8k", ""},
                                    {Ask::kClip, "no such clip", ""},
                                    {Ask::kSetParam, "friction", "nan"},
                                    {Ask::kSetParam, "nonsense", "1"},
                                    {Ask::kSavePreset, "", "/nonexistent/p.json"}};
  for (const Request& fault : faults) {
    demo.message.clear();
    demo.requests = {fault};
    app::advanceFrame(demo, 1.0 / 60, {});
    EXPECT_TRUE(demo.message_is_fault) << fault.name << fault.text;
    EXPECT_FALSE(demo.message.empty()) << fault.name << fault.text;
    EXPECT_EQ(demo.actors[0].haircut, haircut) << fault.name << fault.text;
    EXPECT_EQ(demo.actors[0].body, body) << fault.name << fault.text;
    demo.message_is_fault = false;
  }
  expectFinite(demo);
}

TEST(Demo, ScrubbingCarriesTheHairAlong) {
  Demo demo = smallDemo();
  for (int frame = 0; frame < 10; ++frame) app::advanceFrame(demo, 1.0 / 60, {});
  demo.requests = {{Ask::kPause, "", "", 1}, {Ask::kCarryAlong, "", "", 1.7}};
  app::advanceFrame(demo, 1.0 / 60, {});
  const app::Actor& actor = demo.actors[0];
  const Eigen::Isometry3d scalp = app::scalpToWorld(actor.body->character, actor.pose);
  const sim::HairMeshShape& shape = actor.haircut->mesh.shape;
  for (int c = 0; c < shape.columnCount(); ++c) {
    const int root = shape.column_first[c];
    EXPECT_LT((actor.hair.positions[root] - scalp * shape.positions[root]).norm(), 1e-6);
  }
  EXPECT_NEAR(actor.playback.time, 1.7, 1e-9);
}

TEST(Demo, EveryOwnClipPlaysWithoutRecoveries) {
  const std::vector<std::string> files = app::listAssets("clips", {".bvh"});
  ASSERT_FALSE(files.empty());
  for (const std::string& file : files) {
    Demo demo = smallDemo(app::stem(file) + ".bvh");
    int recoveries = 0;
    for (int frame = 0; frame < 90; ++frame) {
      app::advanceFrame(demo, 1.0 / 60, {});
      recoveries += demo.stats.recoveries;
    }
    EXPECT_EQ(recoveries, 0) << file;
    expectFinite(demo);
  }
}

TEST(Headless, TwoProcessesDrawTheSameBytes) {
  const std::string a = test::freshFolder("headless_a"), b = test::freshFolder("headless_b");
  for (const std::string& folder : {a, b}) {
    const test::Outcome outcome = test::runProgram({"--headless", "--frames", "3", "--size", "160x120", "--strands",
                                                    "600", "--style", "short", "--resolution", "low", "--out", folder});
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  }
  for (const char* name : {"/frame_0000.png", "/frame_0001.png", "/frame_0002.png"}) {
    const std::string bytes = test::readAll(a + name);
    EXPECT_GT(bytes.size(), 500u);
    EXPECT_TRUE(bytes == test::readAll(b + name)) << name;
  }
  EXPECT_FALSE(std::filesystem::exists(a + "/frame_0003.png"));
}

TEST(Headless, ARunWithoutPicturesNeedsNoGraphicsAndReportsEveryFrame) {
  const std::string folder = test::freshFolder("no_images");
  // With no driver to be found at all, a context could not be made.
  const test::Outcome outcome = test::runProgram(
      {"--no-images", "--frames", "20", "--style", "short", "--resolution", "low", "--report", folder + "/report.json"},
      "__EGL_VENDOR_LIBRARY_DIRS=/nonexistent LIBGL_DRIVERS_PATH=/nonexistent");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const nlohmann::json report = nlohmann::json::parse(test::readAll(folder + "/report.json"));
  ASSERT_EQ(report["frames"].size(), 20u);
  EXPECT_EQ(report["renderer"], "");
  EXPECT_EQ(report["summary"]["counts"]["recoveries"], 0);
  for (std::size_t k = 0; k < 20; ++k) {
    const auto& frame = report["frames"][k];
    EXPECT_EQ(frame["frame"], k);
    EXPECT_NEAR(frame["seconds"].get<double>(), k / 60.0, 1e-12);
    EXPECT_EQ(frame["counts"]["steps"], k == 0 ? 0 : 1);
  }
  std::vector<double> whole;
  for (const auto& frame : report["frames"]) whole.push_back(frame["milliseconds"]["frame"]);
  std::sort(whole.begin(), whole.end());
  const auto& milliseconds = report["summary"]["milliseconds"]["frame"];
  EXPECT_DOUBLE_EQ(milliseconds["max"], whole.back());
  EXPECT_DOUBLE_EQ(milliseconds["median"], whole[10]);
  EXPECT_NEAR(milliseconds["mean"], std::accumulate(whole.begin(), whole.end(), 0.0) / 20, 1e-9 * whole.back());
  EXPECT_GT(report["frames"][5]["counts"]["solver_iterations"].get<int>(), 0);
  EXPECT_FALSE(report["characters"][0]["notes"].empty());
  const auto& summary = report["summary"];
  EXPECT_TRUE(summary["skipped"]["sleep"]["saved_milliseconds"].is_number());
  EXPECT_TRUE(summary["skipped"]["pose"]["saved_milliseconds"].is_null()) << "what cannot be told is not claimed as 0";
  EXPECT_EQ(summary["always_skipped"]["no-picture"]["skipped"], 20);
  EXPECT_EQ(summary["always_skipped"]["paused"]["skipped"], 0);
  EXPECT_EQ(summary["always_skipped"]["no-contact"]["of"], 19);
  EXPECT_EQ(summary["always_skipped"]["no-new-balance"]["skipped"], 19);
  EXPECT_EQ(summary["always_skipped"]["no-new-balance"]["of"], 19);
  EXPECT_EQ(summary["always_skipped"]["no-stiffness"]["of"], 6 * 19);
  const auto& reach = summary["always_skipped"]["out-of-reach"];
  EXPECT_GT(reach["skipped"].get<long>(), reach["of"].get<long>() / 2);
  EXPECT_LT(reach["skipped"].get<long>(), reach["of"].get<long>());
  EXPECT_TRUE(report["frames"][5]["always_skipped"].contains("out-of-reach"));
  // Times stand with times, counts with counts.
  for (const auto& item : report["frames"][5]["milliseconds"]["stages"].items())
    EXPECT_GE(item.value().get<double>(), 0) << item.key();
  for (const auto& item : report["frames"][5]["counts"].items()) EXPECT_TRUE(item.value().is_number()) << item.key();
}

}  // namespace demo_test
