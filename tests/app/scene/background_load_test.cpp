// Scenes and styles loaded beside the frames: what is shown goes on, what cannot be loaded changes nothing.
#include "app/scene/background_load.h"

#include <gtest/gtest.h>

#include <fstream>

#include "app/files/data_path.h"
#include "app/scene/demo.h"
#include "tests/run_program.h"

namespace background_load_test {

using app::Ask;
using app::Demo;

Demo walking() {
  app::Scene scene = app::loadScene(app::dataPath("assets/scenes/walk.json"));
  scene.characters.resize(1);
  scene.characters[0].style = app::Style::kShort;
  scene.characters[0].resolution = app::Resolution::kLow;
  Demo demo = app::openScene(std::move(scene), 1);
  demo.loading.on = true;
  return demo;
}

void frames(int count, Demo& demo) {
  for (int f = 0; f < count; ++f) app::advanceFrame(demo, 1.0 / 60, {});
}

TEST(BackgroundLoad, TheOldHairGoesOnUntilTheNewStyleIsThere) {
  Demo demo = walking();
  frames(5, demo);
  const std::uint64_t old = demo.actors[0].id;
  demo.requests.push_back({Ask::kStyle, "shoulder", ""});
  frames(1, demo);
  ASSERT_TRUE(demo.loading.running.valid());
  EXPECT_EQ(demo.actors[0].id, old);
  EXPECT_EQ(demo.stats.steps, 1) << "the simulation goes on";
  const double time = demo.actors[0].playback.time;
  demo.loading.running.wait();
  frames(1, demo);
  EXPECT_NE(demo.actors[0].id, old);
  EXPECT_EQ(demo.actors[0].spec.style, app::Style::kShoulder);
  EXPECT_NEAR(demo.actors[0].playback.time, time + 1.0 / 60, 1e-9) << "in step with the clip";
  EXPECT_EQ(demo.asset_cache.haircuts.size(), 1u);
  EXPECT_EQ(demo.asset_cache.bodies.size(), 1u);
  int recoveries = 0;
  for (int f = 0; f < 60; ++f) {
    frames(1, demo);
    recoveries += demo.stats.recoveries;
  }
  EXPECT_EQ(recoveries, 0);
  EXPECT_FALSE(demo.message_is_fault);
}

// Until nothing is being loaded any more.
void wait(Demo& demo) {
  for (int k = 0; k < 10 && demo.loading.running.valid(); ++k) {
    demo.loading.running.wait();
    frames(1, demo);
  }
  ASSERT_FALSE(demo.loading.running.valid());
}

TEST(BackgroundLoad, WhatIsAskedForMeanwhileComesInOrderAndOfSeveralChoicesTheLast) {
  Demo demo = walking();
  demo.requests = {{Ask::kStyle, "shoulder", ""}, {Ask::kStyle, "bob", ""}, {Ask::kStyle, "long", ""}};
  frames(1, demo);
  const app::Request* coming = app::comingRequest(Ask::kStyle, demo);
  EXPECT_EQ(coming ? coming->name : "", "long") << "of those that wait the last";
  EXPECT_EQ(app::comingRequest(Ask::kTie, demo), nullptr);
  demo.requests = {{Ask::kResolution, "medium", ""}};
  frames(1, demo);
  ASSERT_TRUE(demo.loading.running.valid());
  EXPECT_EQ(demo.loading.held.size(), 2u) << "the bob is not loaded";
  EXPECT_NE(app::loadingNote(demo).find("then"), std::string::npos);
  wait(demo);
  EXPECT_EQ(app::comingRequest(Ask::kStyle, demo), nullptr) << "it has come";
  EXPECT_EQ(demo.actors[0].spec.style, app::Style::kLong) << "kept by what was asked for after it";
  EXPECT_EQ(demo.actors[0].spec.resolution, app::Resolution::kMedium);
  EXPECT_EQ(demo.edits.done, 3u);
  demo.requests = {{Ask::kUndo, "", "", 1}};
  frames(1, demo);
  EXPECT_EQ(demo.actors[0].spec.style, app::Style::kLong);
  EXPECT_EQ(demo.actors[0].spec.resolution, app::Resolution::kLow);
}

TEST(BackgroundLoad, WhatIsSavedMeanwhileHasWhatWasAskedForBefore) {
  Demo demo = walking();
  const std::string file = test::freshFolder("background_saved") + "/kept.json";
  demo.requests = {{Ask::kStyle, "shoulder", ""}, {Ask::kResolution, "medium", ""}, {Ask::kSaveScene, "", file}};
  frames(1, demo);
  EXPECT_FALSE(std::ifstream(file).good()) << "not of the old hair";
  wait(demo);
  ASSERT_TRUE(std::ifstream(file).good()) << demo.message;
  const app::Scene saved = app::loadScene(file);
  EXPECT_EQ(saved.characters[0].style, app::Style::kShoulder);
  EXPECT_EQ(saved.characters[0].resolution, app::Resolution::kMedium);
  EXPECT_FALSE(app::isUnsaved(demo.edits));
}

TEST(BackgroundLoad, AStrokeOrLookMeanwhileIsThereAfterwards) {
  Demo plain = walking(), demo = walking();
  demo.requests = {{Ask::kStyle, "shoulder", ""},
                   {Ask::kMesh, "add-layer", "2"},
                   {Ask::kSetParam, "clump", "0.93"},
                   {Ask::kEndGesture, "", ""}};
  frames(1, demo);
  EXPECT_EQ(demo.loading.held.size(), 2u);
  EXPECT_NEAR(demo.actors[0].spec.look.hair.clump, 0.93f, 1e-6f) << "a slider acts at once";
  wait(demo);
  EXPECT_NEAR(demo.actors[0].spec.look.hair.clump, 0.93f, 1e-6f);
  plain.requests = {{Ask::kStyle, "shoulder", ""}};
  frames(1, plain);
  wait(plain);
  EXPECT_FALSE(demo.message_is_fault) << demo.message;
  EXPECT_GT(demo.actors[0].haircut->mesh.vertexCount(), plain.actors[0].haircut->mesh.vertexCount());
}

TEST(BackgroundLoad, WhatWaitsIsUndoneFirst) {
  Demo demo = walking();
  demo.requests = {{Ask::kStyle, "shoulder", ""}, {Ask::kResolution, "medium", ""}};
  frames(1, demo);
  EXPECT_EQ(app::heldEdits(demo.loading), 1);
  demo.requests = {{Ask::kUndo, "", "", 1}};
  frames(1, demo);
  EXPECT_EQ(app::heldEdits(demo.loading), 0);
  wait(demo);
  EXPECT_EQ(demo.actors[0].spec.style, app::Style::kShoulder);
  EXPECT_EQ(demo.actors[0].spec.resolution, app::Resolution::kLow);

  demo.requests = {{Ask::kStyle, "long", ""}, {Ask::kResolution, "medium", ""}, {Ask::kUndo, "", "", 2}};
  frames(1, demo);
  wait(demo);
  EXPECT_EQ(demo.actors[0].spec.style, app::Style::kShoulder) << "what was being loaded is not used";
  EXPECT_EQ(demo.actors[0].spec.resolution, app::Resolution::kLow);
  EXPECT_EQ(demo.edits.done, 1u);
}

TEST(BackgroundLoad, ASceneTakesThePlaceOfTheOther) {
  Demo demo = walking();
  demo.debug = {};
  demo.requests.push_back({Ask::kSceneFile, "", app::dataPath("assets/scenes/head_shake.json")});
  frames(1, demo);
  const std::string before = demo.scene.name;
  demo.loading.running.wait();
  frames(2, demo);
  EXPECT_NE(demo.scene.name, before);
  EXPECT_TRUE(demo.loading.on);
  EXPECT_FALSE(demo.message_is_fault);
}

TEST(BackgroundLoad, TheEllipsoidsActUntilTheSignedDistancesAreThere) {
  app::Scene scene = app::loadScene(app::dataPath("assets/scenes/walk.json"));
  scene.characters.resize(1);
  scene.characters[0].style = app::Style::kShort;
  scene.characters[0].resolution = app::Resolution::kLow;
  scene.sim.collider = sim::ColliderKind::kSdf;
  Demo demo = app::openScene(std::move(scene), 1, true);
  app::LoadedBody& body = *demo.actors[0].body;
  EXPECT_FALSE(body.has_parts) << "the window does not wait for them";
  EXPECT_TRUE(demo.actors[0].parts.empty());
  ASSERT_TRUE(body.parts_coming.valid());
  body.parts_coming.wait();
  int recoveries = 0;
  for (int f = 0; f < 30; ++f) {
    frames(1, demo);
    EXPECT_EQ(demo.stats.steps, 1) << "the simulation goes on";
    recoveries += demo.stats.recoveries;
  }
  EXPECT_TRUE(body.has_parts);
  EXPECT_FALSE(body.parts_coming.valid());
  EXPECT_GT(demo.actors[0].parts.size(), 5u);
  EXPECT_EQ(recoveries, 0);
  EXPECT_FALSE(demo.message_is_fault);

  // Asked for by a slider, and by a headless run, which waits so that its frames repeat.
  for (const bool beside : {true, false}) {
    body.has_parts = false;
    body.parts.clear();
    demo.loading.on = beside;
    frames(1, demo);
    EXPECT_EQ(body.parts_coming.valid(), beside);
    EXPECT_EQ(demo.actors[0].parts.empty(), beside);
    if (!beside) continue;
    body.parts_coming.wait();
    frames(1, demo);
    EXPECT_TRUE(body.has_parts);
  }
}

TEST(BackgroundLoad, AFaultIsToldAndChangesNothing) {
  Demo demo = walking();
  const std::string file = test::freshFolder("background") + "/broken.bvh";
  std::ofstream(file) << "HIERARCHY\nROOT a\n{";
  const std::uint64_t old = demo.actors[0].id;
  demo.requests.push_back({Ask::kMotionFile, "", file});
  frames(1, demo);
  if (demo.loading.running.valid()) demo.loading.running.wait();
  frames(2, demo);
  EXPECT_TRUE(demo.message_is_fault);
  EXPECT_NE(demo.message.find("broken.bvh"), std::string::npos) << demo.message;
  EXPECT_EQ(demo.actors[0].id, old);
  EXPECT_FALSE(demo.loading.running.valid());
  EXPECT_TRUE(demo.edits.steps.empty()) << "there is nothing to undo";
}

TEST(BackgroundLoad, AFaultTakesItsOwnStepOutOfTheHistory) {
  Demo demo = walking();
  const std::string file = test::freshFolder("background_step") + "/broken.bvh";
  std::ofstream(file) << "HIERARCHY\nROOT a\n{";
  demo.requests = {{Ask::kSetParam, "density", "70"}, {Ask::kEndGesture, "", ""}, {Ask::kMotionFile, "", file}};
  frames(1, demo);
  demo.requests = {{Ask::kSetParam, "friction", "0.4"}};
  frames(1, demo);
  if (demo.loading.running.valid()) demo.loading.running.wait();
  frames(2, demo);
  ASSERT_TRUE(demo.message_is_fault);
  ASSERT_EQ(demo.edits.steps.size(), 2u);
  EXPECT_EQ(demo.edits.done, 2u);
  EXPECT_EQ(demo.edits.steps[0].request.name, "density");
  EXPECT_EQ(demo.edits.steps[1].request.name, "friction");
  demo.requests = {{Ask::kUndo, "", "", 2}};
  frames(1, demo);
  EXPECT_EQ(demo.scene.sim.density, sim::SimParams{}.density);
}

// What cannot be loaded has not taken away what could be done again.
TEST(BackgroundLoad, AFaultLeavesWhatWasUndoneToBeDoneAgain) {
  Demo demo = walking();
  demo.requests = {{Ask::kSetParam, "density", "70"}, {Ask::kUndo, "", "", 1}};
  frames(1, demo);
  demo.requests = {{Ask::kTie, "", R"([{"at": [0, 0, 0]}])"}};
  frames(1, demo);
  if (demo.loading.running.valid()) demo.loading.running.wait();
  frames(2, demo);
  ASSERT_TRUE(demo.message_is_fault) << "no tie is held in the middle of the head";
  ASSERT_EQ(demo.edits.steps.size(), 1u);
  EXPECT_EQ(demo.edits.done, 0u);
  demo.requests = {{Ask::kRedo, "", "", 1}};
  frames(1, demo);
  EXPECT_EQ(demo.scene.sim.density, 70);
}

}  // namespace background_load_test
