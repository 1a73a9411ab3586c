// A saved state goes on to the bit, in pictures too; one that cannot be used is refused in one message.
#include "app/scene/demo_state.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "app/files/data_path.h"
#include "app/files/output_file.h"
#include "app/files/recording.h"
#include "tests/run_program.h"

namespace demo_state_test {

using test::readAll;

app::CharacterSpec character(const std::string& clip, app::Style style, app::Resolution resolution) {
  app::CharacterSpec spec;
  spec.motion = app::dataPath("assets/clips/" + clip);
  spec.style = style;
  spec.resolution = resolution;
  return spec;
}

// One near by, pinned; one so far that it is coarse and takes long steps; one behind the camera.
app::Scene crowdScene() {
  app::Scene scene;
  scene.name = "crowd";
  scene.characters.push_back(character("dance.bvh", app::Style::kShoulder, app::Resolution::kMedium));
  scene.characters[0].pins.push_back(app::pinFromText(R"({"column": 3, "to": "scalp"})"));
  scene.characters.push_back(character("walk.bvh", app::Style::kLong, app::Resolution::kMedium));
  scene.characters[1].position = app::Vec3(1.5, 0, -12);
  scene.characters.push_back(character("walk.bvh", app::Style::kShort, app::Resolution::kLow));
  scene.characters[2].position = app::Vec3(0, 0, 40);
  scene.playback.settle = 0.1;
  return scene;
}

// Hair that falls asleep over a head that stands still.
app::Scene sleepingScene() {
  app::Scene scene;
  scene.characters.push_back(character("walk.bvh", app::Style::kShort, app::Resolution::kLow));
  scene.playback.speed = 0;
  return scene;
}

app::Demo opened(const app::Scene& scene) {
  app::Demo demo = app::openScene(scene, 1.5);
  demo.governor.counted = true;
  return demo;
}

void run(int from, int frames, app::Demo& demo) {
  for (int frame = from; frame < from + frames; ++frame) app::advanceFrame(demo, 0.001 * (1 + frame * 37 % 43), {});
}

// Runs `before` frames, saves, and holds `after` more against as many of a demo opened anew from the file.
void expectToGoOn(const std::string& name, const app::Scene& scene, int before, int after) {
  const std::string file = test::freshFolder(name) + "/run.state";
  app::Demo demo = opened(scene);
  run(0, before, demo);
  app::writeFile(file, app::demoStateBytes(demo));
  app::Demo other = opened(scene);
  run(0, 3, other);  // whatever it did before
  app::loadDemoState(file, false, other);
  EXPECT_TRUE(app::demoStateBytes(other) == app::demoStateBytes(demo));
  for (int frame = before; frame < before + after; ++frame) {
    run(frame, 1, demo);
    run(frame, 1, other);
    ASSERT_TRUE(app::demoStateBytes(other) == app::demoStateBytes(demo)) << name << ", frame " << frame;
    for (std::size_t k = 0; k < demo.actors.size(); ++k) {
      ASSERT_EQ(other.actors[k].shown_positions, demo.actors[k].shown_positions) << name << ", frame " << frame;
      ASSERT_EQ(other.actors[k].joint_matrices, demo.actors[k].joint_matrices) << name << ", frame " << frame;
    }
  }
}

TEST(DemoState, GoesOnToTheBitWithACoarseAnUnseenAndAPinnedFigure) {
  app::Demo demo = opened(crowdScene());
  run(0, 12, demo);
  ASSERT_TRUE(demo.actors[1].coarse.active);
  ASSERT_GT(demo.actors[1].detail.step_span, 1);
  ASSERT_TRUE(demo.actors[2].unseen);
  ASSERT_FALSE(demo.actors[0].pinned.empty());
  expectToGoOn("state_crowd", crowdScene(), 12, 12);
  expectToGoOn("state_crowd_later", crowdScene(), 13, 5);
}

TEST(DemoState, GoesOnToTheBitAsleepAndAboutToSleep) {
  app::Demo demo = opened(sleepingScene());
  int asleep = 0;
  for (; asleep < 400 && !demo.actors[0].sleep.asleep; ++asleep) run(asleep, 1, demo);
  ASSERT_LT(asleep, 400) << "it does not fall asleep";
  expectToGoOn("state_asleep", sleepingScene(), asleep + 3, 5);
  expectToGoOn("state_drowsy", sleepingScene(), asleep - 4, 8);
}

TEST(DemoState, GoesOnToTheBitUnderABudget) {
  app::Scene scene = sleepingScene();
  scene.playback.speed = 1;
  scene.playback.budget_ms = 0.02;
  app::Demo demo = opened(scene);
  run(0, 60, demo);
  ASSERT_GT(demo.governor.changes, 0);
  expectToGoOn("state_budget", scene, 60, 60);
}

TEST(DemoState, ASceneAtHandKeepsItsSettings) {
  const std::string file = test::freshFolder("state_settings") + "/run.state";
  app::Demo demo = opened(sleepingScene());
  run(0, 5, demo);
  app::writeFile(file, app::demoStateBytes(demo));
  app::Scene scene = sleepingScene();
  scene.sim.gravity = 3;
  scene.playback.speed = 2;
  app::Demo other = opened(scene);
  app::loadDemoState(file, false, other);
  EXPECT_EQ(other.scene.sim.gravity, 3);
  EXPECT_EQ(other.actors[0].playback.speed, 2);
  EXPECT_EQ(other.frames, 5);
  EXPECT_EQ(app::stateHash(other), app::stateHash(demo));
}

// The program itself: frames, saved, and the rest in a process of its own.
TEST(DemoState, TheProgramsPicturesGoOnToTheBit) {
  const std::string folder = test::freshFolder("state_program");
  const std::vector<std::string> scene{"--headless", "--size",       "480x360", "--framing", "head",
                                       "--strands",  "400",          "--style", "short",     "--motion",
                                       "dance.bvh",  "--resolution", "low"};
  const auto run_scene = [&](std::vector<std::string> more) {
    more.insert(more.begin(), scene.begin(), scene.end());
    return test::runProgram(more);
  };
  const test::Outcome whole =
      run_scene({"--frames", "6", "--out", folder + "/whole", "--save-state", folder + "/mid", "--save-state-at", "4"});
  if (whole.exit_code == 3) GTEST_SKIP() << "no OpenGL context";
  ASSERT_EQ(whole.exit_code, 0) << whole.err;
  const test::Outcome first = run_scene({"--frames", "4", "--out", folder + "/part", "--save-state", folder + "/a"});
  ASSERT_EQ(first.exit_code, 0) << first.err;
  EXPECT_TRUE(readAll(folder + "/a") == readAll(folder + "/mid")) << "saved in the middle or at the end";
  const test::Outcome rest = run_scene({"--frames", "2", "--out", folder + "/part", "--load-state", folder + "/a"});
  ASSERT_EQ(rest.exit_code, 0) << rest.err;
  EXPECT_NE(rest.out.find("from frame_0004.png"), std::string::npos) << rest.out;
  for (const char* frame : {"/frame_0003.png", "/frame_0004.png", "/frame_0005.png"}) {
    ASSERT_FALSE(readAll(folder + "/whole" + frame).empty()) << frame;
    EXPECT_TRUE(readAll(folder + "/part" + frame) == readAll(folder + "/whole" + frame)) << frame;
  }
  EXPECT_TRUE(readAll(folder + "/whole/frame_0004.png") != readAll(folder + "/whole/frame_0005.png"));
}

// One message with file, fault and mend; the demo stays as it was.
TEST(DemoState, WhatCannotBeUsedIsRefusedAndChangesNothing) {
  const std::string folder = test::freshFolder("state_bad"), file = folder + "/bad.state";
  app::Demo demo = opened(sleepingScene());
  run(0, 4, demo);
  const std::string good = app::demoStateBytes(demo);
  app::Scene two = sleepingScene(), long_hair = sleepingScene();
  two.characters.push_back(two.characters[0]);
  long_hair.characters[0].style = app::Style::kLong;
  app::Demo pair = opened(two), other = opened(long_hair);
  std::string changed = good, future = good;
  changed[changed.size() / 2] ^= 1;
  future.replace(0, future.find('\n'), "hairmesh-state 999");
  struct Case {
    std::string bytes;
    app::Demo* demo;
    const char* fault;
  };
  const Case cases[] = {{good.substr(0, good.size() / 2), &demo, "were saved"},
                        {good.substr(0, 20), &demo, "were saved"},
                        {good.substr(0, 9), &demo, "is no saved state"},
                        {good + "x", &demo, "were saved"},
                        {changed, &demo, "has been changed"},
                        {future, &demo, "is a state of version 999, not"},
                        {"{\"characters\": []}", &demo, "is no saved state"},
                        {good, &pair, "has 1 characters where the scene has 2"},
                        {good, &other, "short low where the scene has walk.bvh, clip"}};
  for (const Case& one : cases) {
    app::writeFile(file, one.bytes);
    const std::string before = app::demoStateBytes(*one.demo);
    try {
      app::loadDemoState(file, false, *one.demo);
      ADD_FAILURE() << "loaded: " << one.fault;
    } catch (const app::InputError& fault) {
      const std::string words = fault.what();
      EXPECT_TRUE(words.starts_with(file)) << words;
      EXPECT_NE(words.find(one.fault), std::string::npos) << words;
      EXPECT_NE(words.find("; "), std::string::npos) << words << " says no mend";
    }
    EXPECT_TRUE(app::demoStateBytes(*one.demo) == before) << one.fault;
  }
}

TEST(DemoState, TheProgramRefusesWithExitCodeFour) {
  const std::string folder = test::freshFolder("state_refused"), file = folder + "/run.state";
  const std::vector<std::string> scene{"--no-images", "--frames", "2", "--style", "short", "--resolution", "low"};
  const auto run_scene = [&](std::vector<std::string> more) {
    more.insert(more.begin(), scene.begin(), scene.end());
    return test::runProgram(more);
  };
  ASSERT_EQ(run_scene({"--save-state", file}).exit_code, 0);
  EXPECT_EQ(run_scene({"--load-state", file}).exit_code, 0);
  const test::Outcome other = run_scene({"--load-state", file, "--style", "long"});
  EXPECT_EQ(other.exit_code, 4);
  EXPECT_EQ(std::count(other.err.begin(), other.err.end(), '\n'), 1) << other.err;
  EXPECT_EQ(run_scene({"--load-state", folder + "/none.state"}).exit_code, 4);
  EXPECT_EQ(run_scene({"--save-state-at", "9", "--save-state", file}).exit_code, 2);
  EXPECT_EQ(run_scene({"--load-state", file, "--record", folder + "/x"}).exit_code, 2);
  EXPECT_EQ(run_scene({"--save-state", folder + "/no/such/folder"}).exit_code, 1);
  EXPECT_EQ(test::runProgram({file}).exit_code, 2);
}

}  // namespace demo_state_test
