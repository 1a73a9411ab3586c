// The table of skips, its simulation and character part: what each may change, and that each has its proof.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>

#include "app/files/data_path.h"
#include "app/options.h"
#include "app/scene/detail/level_of_detail.h"
#include "app/scene/detail/skips.h"
#include "app/ui/redraw_throttle.h"

namespace skips_sim_test {

using app::Demo;
using app::SkipSet;

SkipSet only(std::initializer_list<app::SkipId> ids) {
  SkipSet skips;
  skips.on.fill(false);
  for (const app::SkipId id : ids) skips.on[id] = true;
  return skips;
}

app::CharacterSpec spec(const std::string& motion, app::Resolution resolution, app::Style style = app::Style::kShort) {
  app::CharacterSpec character;
  character.motion = app::dataPath("assets/clips/" + motion);
  character.style = style;
  character.resolution = resolution;
  return character;
}

// One character seen by a camera `distance` m in front of it.
Demo demoAt(double distance, const app::CharacterSpec& character, const SkipSet& skips) {
  app::Scene scene;
  scene.name = "test";
  scene.characters.push_back(character);
  scene.camera.eye = app::Vec3(0, 1.6, distance);
  scene.camera.target = app::Vec3(0, 1.5, 0);
  scene.camera.follow = false;
  scene.playback.settle = 0.2;
  scene.skips = skips;
  return app::openScene(std::move(scene), 1.5);
}

void run(Demo& demo, int frames) {
  for (int frame = 0; frame < frames; ++frame) app::advanceFrame(demo, 1.0 / 60, {});
}

double farthest(const std::vector<float>& a, const std::vector<float>& b) {
  double most = 0;
  for (std::size_t i = 0; i + 2 < std::min(a.size(), b.size()); i += 3)
    most = std::max<double>(most, std::hypot(a[i] - b[i], a[i + 1] - b[i + 1], a[i + 2] - b[i + 2]));
  return a.size() == b.size() ? most : 1e9;
}

double mean(const std::vector<float>& a, const std::vector<float>& b) {
  double sum = 0;
  for (std::size_t i = 0; i + 2 < std::min(a.size(), b.size()); i += 3)
    sum += std::hypot(a[i] - b[i], a[i + 1] - b[i + 1], a[i + 2] - b[i + 2]);
  return 3 * sum / static_cast<double>(a.size());
}

// Whether "file: Suite.Test" names a test that exists.
bool exists(const std::string& proof) {
  const std::size_t colon = proof.find(": ");
  if (colon == std::string::npos) return false;
  std::ifstream file(std::string(HAIRMESH_SOURCE_DIR) + "/" + proof.substr(0, colon));
  std::stringstream text;
  text << file.rdbuf();
  const std::string test = proof.substr(colon + 2);
  const std::string name = test.substr(0, test.find('.')) + ", " + test.substr(test.find('.') + 1) + ")";
  return text.str().find(name) != std::string::npos;
}

TEST(SkipTable, EveryEntryHasItsProof) {
  for (const app::Skip& skip : app::skipTable()) {
    EXPECT_EQ(&app::skipTable()[skip.id], &skip) << skip.name;
    EXPECT_EQ(app::findSkip(skip.name), &skip);
    EXPECT_EQ(skip.exact, std::string(skip.bound).empty()) << skip.name << ": an approximate skip states its bound";
    EXPECT_TRUE(exists(skip.proof)) << skip.name << ": " << skip.proof;
  }
  for (const app::BuiltInSkip& skip : app::builtInSkips()) {
    EXPECT_EQ(&app::builtInSkips()[skip.id], &skip) << skip.name;
    EXPECT_TRUE(exists(skip.proof)) << skip.proof;
  }
  EXPECT_FALSE(exists("tests/sim/skips_sim_test.cpp: Exact.NoSuchTest"));
}

TEST(SkipTable, StandsInItsDocument) {
  std::ifstream file(std::string(HAIRMESH_SOURCE_DIR) + "/docs/data/skips.md");
  std::stringstream text;
  text << file.rdbuf();
  EXPECT_NE(text.str().find(app::skipTableText()), std::string::npos)
      << "put what hairmesh --skips prints between the marks of docs/data/skips.md";
}

TEST(SkipTable, SwitchesAreSetByNameAndRefuseNonsense) {
  SkipSet skips;
  EXPECT_EQ(app::setSkip("all=off", skips), "");
  EXPECT_EQ(skips, only({}));
  EXPECT_EQ(app::setSkip("sleep=on", skips), "");
  EXPECT_EQ(skips, only({app::kSkipSleep}));
  for (const char* wrong : {"", "sleep", "sleep=", "sleep=maybe", "nap=on", "=on", "sleep=on=on"}) {
    EXPECT_NE(app::setSkip(wrong, skips), "") << wrong;
    EXPECT_EQ(skips, only({app::kSkipSleep})) << wrong;
  }
  app::Options options;
  options.skips = {"all=off", "view=on"};
  EXPECT_EQ(app::sceneFromOptions(options).skips, only({app::kSkipView}));
  options.skips = {"nap=on"};
  EXPECT_THROW(app::sceneFromOptions(options), app::UsageError);
}

TEST(SkipTable, ARequestTurnsASkip) {
  Demo demo = demoAt(1, spec("idle_turns.bvh", app::Resolution::kLow), SkipSet{});
  demo.requests.push_back({app::Ask::kSkip, "sleep", "", 0});
  run(demo, 1);
  EXPECT_FALSE(demo.scene.skips[app::kSkipSleep]);
  EXPECT_TRUE(demo.scene.skips[app::kSkipUnseen]);
}

// Hair that swings out over a figure that stands still: it falls asleep, and what it would have done afterwards stays
// below the bound.
TEST(Sleep, ComesWhenNothingThatShowsIsLeft) {
  struct Case {
    app::Style style;
    const char* preset;
  };
  for (const Case& one : {Case{app::Style::kShort, ""}, Case{app::Style::kShoulder, ""}, Case{app::Style::kLong, ""},
                          Case{app::Style::kShoulder, "soft"}}) {
    const app::CharacterSpec character = spec("idle_turns.bvh", app::Resolution::kLow, one.style);
    Demo sleeping = demoAt(1, character, only({app::kSkipSleep})), awake = demoAt(1, character, only({}));
    for (Demo* demo : {&sleeping, &awake}) {
      if (*one.preset)
        demo->requests.push_back(
            {app::Ask::kPresetFile, "", app::dataPath(std::string("assets/presets/") + one.preset + ".json")});
      run(*demo, 30);
      demo->requests.push_back({app::Ask::kPauseMotion, "", "", 1});
    }
    int asleep = -1;
    double worst = 0;
    // On for a good while after it sleeps.
    for (int frame = 0; frame < (asleep < 0 ? 3000 : asleep + 600); ++frame) {
      run(sleeping, 1);
      run(awake, 1);
      if (asleep < 0 && sleeping.actors[0].sleep.asleep) asleep = frame;
      const double off = farthest(sleeping.actors[0].shown_positions, awake.actors[0].shown_positions);
      ASSERT_TRUE(asleep >= 0 || off == 0) << frame;
      worst = std::max(worst, off);
    }
    std::printf("%s %s: asleep after %.1f s, then off by %.3f mm\n", std::string(app::styleName(one.style)).c_str(),
                one.preset, asleep / 60.0, 1e3 * worst);
    ASSERT_GE(asleep, 60) << "never within two windows";
    EXPECT_LE(worst, sim::kSleepError);
    EXPECT_EQ(sleeping.stats.skipped[app::kSkipSleep].skipped, 1);
    EXPECT_GT(sleeping.stats.skipped[app::kSkipSleep].seconds, 0);
  }
}

// Two quiet windows in a row: one that is not quiet between them begins the count anew.
TEST(Sleep, ComesAfterTwoQuietWindowsInARowOnly) {
  sim::HairState hair;
  hair.positions.assign(3, sim::Vec3::Zero());
  sim::SleepState sleep;
  const sim::SimParams params;
  constexpr double kStep = 1.0 / 60;
  const int window = static_cast<int>(std::ceil(sim::kQuietWindow / kStep)) + 1;
  const auto stay = [&](int steps) {
    bool slept = false;
    for (int n = 0; n < steps; ++n) slept = sim::maySleep(params, {}, kStep, hair, sleep) || slept;
    return slept;
  };
  for (int round = 0; round < 3; ++round) {
    EXPECT_FALSE(stay(window + 3)) << "one quiet window";
    hair.positions[1].x() += 3 * sim::kQuietPath;
    EXPECT_FALSE(stay(1));
  }
  EXPECT_FALSE(stay(window));
  EXPECT_TRUE(stay(window));
}

// The head stands still, and a fist comes up to the hair from aside.
TEST(Sleep, WakesBeforeABodyTouchesIt) {
  constexpr double kSpeed = 0.5;  // m/s
  Demo demo = demoAt(1, spec("idle_turns.bvh", app::Resolution::kLow, app::Style::kLong),
                     only({app::kSkipSleep, app::kSkipPose}));
  app::Actor& actor = demo.actors[0];
  demo.requests.push_back({app::Ask::kPauseMotion, "", "", 1});
  run(demo, 3);
  // The figure is not posed again, so that this one stays among its ellipsoids.
  sim::Ellipsoid fist;
  fist.radii = sim::Vec3::Constant(0.05);
  fist.center = sim::Vec3(2, 1, 0);
  actor.ellipsoids.push_back(fist);
  for (int frame = 0; frame < 3000 && !actor.sleep.asleep; ++frame) run(demo, 1);
  ASSERT_TRUE(actor.sleep.asleep);
  const std::vector<sim::Vec3> before = actor.hair.positions;
  const sim::Vec3 leftmost =
      *std::max_element(before.begin(), before.end(), [](const auto& a, const auto& b) { return a.x() < b.x(); });
  double moved = 0;
  for (int frame = 1; frame <= 20; ++frame) {
    sim::Ellipsoid& moving = actor.ellipsoids.back();
    moving.velocity = sim::Vec3(-kSpeed, 0, 0);
    moving.center = leftmost + sim::Vec3(0.17 - kSpeed * frame / 60, 0, 0);
    run(demo, 1);
    ASSERT_FALSE(actor.sleep.asleep) << frame;
    for (const sim::Vec3& p : actor.hair.positions) ASSERT_GT(sim::closestPoint(moving, p).distance, -2e-3) << frame;
  }
  for (std::size_t v = 0; v < before.size(); ++v) moved = std::max(moved, (actor.hair.positions[v] - before[v]).norm());
  EXPECT_GT(moved, 5e-3) << "it was not touched";
}

TEST(Sleep, WakesWithoutAPopByWhateverMovesHair) {
  Demo demo = demoAt(1, spec("idle_turns.bvh", app::Resolution::kLow), only({app::kSkipSleep}));
  const auto fallAsleep = [&] {
    demo.requests.push_back({app::Ask::kPauseMotion, "", "", 1});
    for (int frame = 0; frame < 1500 && !demo.actors[0].sleep.asleep; ++frame) run(demo, 1);
    ASSERT_TRUE(demo.actors[0].sleep.asleep);
  };
  // What is asked for moves the hair, in the first frame by no more than `most` m.
  const auto wakes = [&](const app::Request& request, double most) {
    fallAsleep();
    const std::vector<float> before = demo.actors[0].shown_positions;
    demo.requests.push_back(request);
    run(demo, 1);
    EXPECT_FALSE(demo.actors[0].sleep.asleep) << request.name;
    EXPECT_LE(farthest(before, demo.actors[0].shown_positions), most) << request.name;
    run(demo, 20);
    EXPECT_GT(farthest(before, demo.actors[0].shown_positions), 1e-4) << request.name;
  };
  wakes({app::Ask::kPauseMotion, "motion", "", 0}, 5e-3);
  wakes({app::Ask::kSetParam, "wind_x", "8", 0}, 5e-3);
  wakes({app::Ask::kSetParam, "sag_free", "off", 0}, 5e-3);
  wakes({app::Ask::kCollapse, "collapse", "", 0}, 1);
}

TEST(Exact, PosesAndBonesChangeNoBit) {
  const app::CharacterSpec character = spec("head_shake.bvh", app::Resolution::kLow);
  Demo with = demoAt(1, character, only({app::kSkipPose, app::kSkipBones})), without = demoAt(1, character, only({}));
  long poses = 0;
  for (int frame = 0; frame < 90; ++frame) {
    for (Demo* demo : {&with, &without}) {
      if (frame == 20) demo->requests.push_back({app::Ask::kPauseMotion, "", "", 1});
      if (frame == 40) demo->requests.push_back({app::Ask::kPauseMotion, "", "", 0});
      if (frame == 60) demo->requests.push_back({app::Ask::kPause, "", "", 1});
      if (frame == 70) demo->requests.push_back({app::Ask::kPause, "", "", 0});
      run(*demo, 1);
    }
    const app::Actor &a = with.actors[0], &b = without.actors[0];
    ASSERT_EQ(a.shown_positions, b.shown_positions) << frame;
    ASSERT_EQ(a.position_revision, b.position_revision) << frame;
    for (std::size_t j = 0; j < a.joint_matrices.size(); ++j) {
      ASSERT_TRUE(!a.body->moving_joints[j] || a.joint_matrices[j] == b.joint_matrices[j]) << frame << " joint " << j;
    }
    poses += with.stats.skipped[app::kSkipPose].skipped;
  }
  EXPECT_GE(poses, 18) << "the held clip is not posed again";
}

TEST(Unseen, NothingOfWhatIsShownChanges) {
  // The second character stands behind the camera with the light in its face: neither it nor its shadow is seen.
  const auto scene = [](const SkipSet& skips) {
    app::Scene made;
    made.characters = {spec("idle_turns.bvh", app::Resolution::kLow), spec("dance.bvh", app::Resolution::kLow)};
    made.characters[1].position = app::Vec3(0, 0, 14);
    made.camera.eye = app::Vec3(0, 1.6, 1.5);
    made.camera.target = app::Vec3(0, 1.5, 0);
    made.camera.follow = false;
    made.look.light.to_light = {0.2f, 0.9f, -0.4f};
    made.playback.settle = 0.1;
    made.skips = skips;
    return app::openScene(std::move(made), 1.5);
  };
  Demo with = scene(only({app::kSkipUnseen})), without = scene(only({}));
  for (int frame = 0; frame < 20; ++frame) {
    run(with, 1);
    run(without, 1);
    ASSERT_EQ(with.actors[0].shown_positions, without.actors[0].shown_positions) << frame;
    EXPECT_EQ(with.stats.skipped[app::kSkipUnseen].skipped, 1);
  }
  EXPECT_FALSE(with.actors[1].detail.seen);
  // Turned round, it is there at once, in its place of the clip, with its hair about its head.
  with.camera.yaw += 3.14159265;
  run(with, 1);
  EXPECT_TRUE(with.actors[1].detail.seen);
  EXPECT_EQ(with.stats.skipped[app::kSkipUnseen].skipped, 0);
  EXPECT_NEAR(with.actors[1].playback.time, without.actors[1].playback.time + 1.0 / 60, 1e-9);
  run(without, 1);
  EXPECT_LT(mean(with.actors[1].shown_positions, without.actors[1].shown_positions), 0.05);
}

// Of the crowd scene, with the figures as they move when all are simulated: no joint and no hair of those that would be
// left out lies in the picture, nor does the shadow on the ground of any.
TEST(Unseen, WhoIsLeftOutIsNotInThePicture) {
  app::Scene made = app::loadScene(app::dataPath("assets/scenes/crowd.json"));
  made.characters.resize(40);
  made.playback.settle = 0;
  made.skips = only({app::kSkipFarSteps, app::kSkipFarMesh});
  Demo demo = app::openScene(std::move(made), 16.0 / 9);
  const render::LightInput& light = demo.scene.look.light;
  const app::Vec3 to_light = app::Vec3(light.to_light[0], light.to_light[1], light.to_light[2]).normalized();
  long left_out = 0;
  for (int frame = 0; frame < 60; ++frame) {
    run(demo, 1);
    const render::CameraInput camera = app::frameInput(demo, 1280, 720).camera;
    const app::Vec3 eye(camera.eye[0], camera.eye[1], camera.eye[2]);
    const app::Vec3 ahead = (app::Vec3(camera.target[0], camera.target[1], camera.target[2]) - eye).normalized();
    const app::Vec3 right = ahead.cross(app::Vec3::UnitY()).normalized(), up = right.cross(ahead);
    const double y = std::tan(0.5 * camera.fov_y), x = y * 16 / 9;
    const auto inPicture = [&](const app::Vec3& p) {
      const double depth = ahead.dot(p - eye);
      return depth > 0 && std::abs(right.dot(p - eye)) <= x * depth && std::abs(up.dot(p - eye)) <= y * depth;
    };
    for (std::size_t a = 0; a < demo.actors.size(); ++a) {
      const app::Actor& actor = demo.actors[a];
      if (app::mayBeSeen(demo, actor)) continue;
      ++left_out;
      const auto check = [&](const app::Vec3& p) {
        EXPECT_FALSE(inPicture(p)) << "character " << a << ", frame " << frame;
        EXPECT_FALSE(inPicture(p - std::max(p.y(), 0.0) / to_light.y() * to_light)) << "shadow of " << a;
      };
      for (const app::Rigid& joint : actor.shown_pose.world) check(joint.translation());
      for (std::size_t v = 0; v + 2 < actor.shown_positions.size(); v += 3)
        check(app::Vec3(actor.shown_positions[v], actor.shown_positions[v + 1], actor.shown_positions[v + 2]));
    }
  }
  EXPECT_GE(left_out, 60) << "nobody stands outside";
}

// Mean over the vertices, the worst frame, in pixels of a picture 720 high: with each skip alone from where it begins
// to leave something out, and with both further away.
TEST(Far, StaysWithinItsPixels) {
  constexpr double kBound = 3;  // the table's
  constexpr int kFrames = 90;
  struct Case {
    double distance;  // m; 0: where the character becomes small enough
    SkipSet skips;
    const char* name;
  };
  const SkipSet steps = only({app::kSkipFarSteps}), mesh = only({app::kSkipFarMesh}),
                all = only({app::kSkipFarSteps, app::kSkipFarMesh});
  for (const app::Style style : {app::Style::kShort, app::Style::kShoulder, app::Style::kLong}) {
    const app::CharacterSpec character = spec("walk.bvh", app::Resolution::kMedium, style);
    Demo without = demoAt(2, character, only({}));
    // Where the character is that small.
    const auto distanceAt = [&](double pixels) {
      while (app::projectedSize(without, without.actors[0]) >= pixels) without.camera.distance += 0.05;
      return without.camera.distance;
    };
    const double begin_steps = distanceAt(505);
    // And its hair.
    const double length = without.actors[0].haircut->mesh.hair_length,
                 whole = length + 2 * without.actors[0].body->character.scalp.head_height;
    const double begin = distanceAt(std::min(405.0, 145 * whole / length)), begin_minimal = distanceAt(235);
    std::vector<std::vector<float>> truth;
    for (int frame = 0; frame < kFrames; ++frame) {
      run(without, 1);
      truth.push_back(without.actors[0].shown_positions);
    }
    std::vector<Case> cases{
        {begin_steps, steps, "far-steps"}, {begin_minimal, mesh, "far-mesh"}, {begin_minimal, all, "all"}};
    for (const double distance : {begin, 3.2, 4.0, 6.0}) {
      if (distance < begin || (distance > begin && distance < begin + 0.1)) continue;  // nothing, or nothing new
      cases.push_back({distance, steps, "far-steps"});
      cases.push_back({distance, mesh, "far-mesh"});
    }
    for (const double distance : {begin, 9.0, 14.0, 30.0}) cases.push_back({distance, all, "all"});
    for (const Case& one : cases) {
      Demo with = demoAt(one.distance, character, one.skips);
      double worst = 0;
      for (int frame = 0; frame < kFrames; ++frame) {
        run(with, 1);
        worst = std::max(worst, mean(with.actors[0].shown_positions, truth[static_cast<std::size_t>(frame)]));
      }
      const double metre = 720 / (2 * std::tan(0.25) * one.distance);  // pixels
      EXPECT_LE(worst * metre, kBound) << app::styleName(style) << ", " << one.name << ", " << one.distance
                                       << " m away, off by " << 1e3 * worst << " mm";
      EXPECT_TRUE(with.actors[0].coarse.active || with.actors[0].detail.step_span > 1) << one.distance;
      const bool minimal = with.actors[0].detail.coarse == app::Resolution::kMinimal;
      EXPECT_EQ(minimal, one.skips[app::kSkipFarMesh] && one.distance >= begin_minimal) << one.distance;
      std::printf("%s, %s at %.2f m: %.2f mm, %.3f pixels, span %d\n", std::string(app::styleName(style)).c_str(),
                  one.name, one.distance, 1e3 * worst, worst * metre, with.actors[0].detail.step_span);
    }
  }
}

// A camera that backs away and returns: from frame to frame the shown hair moves by no more than it does without, but
// for a pixel that nobody sees.
TEST(Far, ChangesOverWithoutAJump) {
  app::CharacterSpec character = spec("walk.bvh", app::Resolution::kMedium, app::Style::kShoulder);
  Demo with = demoAt(1.8, character, only({app::kSkipFarSteps, app::kSkipFarMesh}));
  Demo without = demoAt(1.8, character, only({}));
  std::vector<float> before = with.actors[0].shown_positions, before_without = without.actors[0].shown_positions;
  double fastest_without = 0;  // m a frame
  int changes = 0;
  std::optional<app::Resolution> coarse;
  for (int frame = 0; frame < 158; ++frame) {  // the last step of eight frames ends too
    const double t = frame < 75 ? frame / 75.0 : std::max(150 - frame, 0) / 75.0;
    with.camera.distance = without.camera.distance = 1.8 + 38 * t;
    run(with, 1);
    run(without, 1);
    const double metre = 720 / (2 * std::tan(0.25) * with.camera.distance);  // pixels
    fastest_without = std::max(fastest_without, farthest(before_without, without.actors[0].shown_positions));
    const double moved = farthest(before, with.actors[0].shown_positions);
    EXPECT_TRUE(frame <= 1 || (moved - 1.25 * fastest_without) * metre <= 1) << frame;
    changes += coarse != with.actors[0].detail.coarse;
    coarse = with.actors[0].detail.coarse;
    before = with.actors[0].shown_positions;
    before_without = without.actors[0].shown_positions;
  }
  EXPECT_EQ(changes, 4);
}

TEST(Exact, TheWindowWaitsOnlyWhenNothingMoves) {
  Demo demo = demoAt(1, spec("idle_turns.bvh", app::Resolution::kLow), SkipSet{});
  run(demo, 1);
  demo.stats.draw.skip_counts.frame = {1, 1};
  EXPECT_FALSE(app::nothingMoves(demo)) << "the clip plays";
  demo.paused = true;
  EXPECT_TRUE(app::nothingMoves(demo));
  demo.stats.draw.skip_counts.frame = {0, 1};
  EXPECT_FALSE(app::nothingMoves(demo)) << "the picture changed";
  demo.stats.draw.skip_counts.frame = {1, 1};
  demo.requests.push_back({app::Ask::kPause, "", "", 0});
  EXPECT_FALSE(app::nothingMoves(demo)) << "somebody asked for something";
  demo.requests.clear();
  demo.scene.skips.on[app::kSkipEvents] = false;
  EXPECT_FALSE(app::nothingMoves(demo));
}

// Of an idle window, as its loop asks: panels settle, frames become rare, then none is drawn until an event.
TEST(Exact, AnIdleWindowDrawsNoFrames) {
  app::RedrawThrottle backoff;
  int frames = 0, rare = 0;
  app::Wait wait = app::Wait::kNone;
  while (frames < 1000 && (wait = backoff.next(true, false)) != app::Wait::kEvent) {
    ++frames;
    rare += wait == app::Wait::kShort;
    EXPECT_EQ(backoff.waited(), wait == app::Wait::kShort);
  }
  EXPECT_LE(frames, 30);
  EXPECT_LE(rare * app::kShortWait, 1.0);
  EXPECT_EQ(backoff.next(true, false), app::Wait::kEvent) << "it goes on waiting";
  EXPECT_EQ(backoff.next(true, true), app::Wait::kShort) << "a caret blinks";
  backoff.disturb();
  EXPECT_EQ(backoff.next(true, false), app::Wait::kNone) << "somebody did something";
  for (int frame = 0; frame < 100; ++frame) EXPECT_EQ(backoff.next(false, false), app::Wait::kNone);
}

}  // namespace skips_sim_test
