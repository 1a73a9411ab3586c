// A scene saved from the window brings back what was on the screen.
#include "app/scene/present_scene.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "app/files/data_path.h"
#include "app/files/hair_file.h"
#include "app/files/output_file.h"
#include "tests/run_program.h"

namespace present_scene_test {

using app::Ask;

app::Demo smallDemo() {
  app::Scene scene;
  app::CharacterSpec spec;
  spec.motion = app::dataPath("assets/clips/idle_turns.bvh");
  spec.style = app::Style::kShort;
  spec.resolution = app::Resolution::kLow;
  scene.characters = {spec};
  scene.playback.settle = 0;
  return app::openScene(std::move(scene), 1.5);
}

TEST(PresentScene, SavedAndOpenedItIsTheSame) {
  app::Demo demo = smallDemo();
  demo.requests = {
      {Ask::kSetParam, "density", "90"}, {Ask::kSetParam, "beta_m", "0.41"}, {Ask::kSetParam, "key", "1,0.5,0.25"},
      {Ask::kSpeed, "", "", 3},          {Ask::kMotionFile, "", "walk.bvh"}, {Ask::kLoop, "in-place", ""},
      {Ask::kView, "back", ""},          {Ask::kBudget, "", "", 2},          {Ask::kDrawBudget, "", "", 40}};
  app::advanceFrame(demo, 0, {});
  ASSERT_FALSE(demo.message_is_fault) << demo.message;
  app::orbit(40, 25, 720, demo.camera);
  app::zoom(3, demo.camera);
  const std::string file = test::freshFolder("present_scene") + "/mine.json";
  demo.requests = {{Ask::kSaveScene, "", file}};
  app::advanceFrame(demo, 0, {});
  ASSERT_FALSE(demo.message_is_fault) << demo.message;
  EXPECT_EQ(demo.scene.name, "mine");

  const app::Demo opened = app::openScene(app::loadScene(file), 1.5);
  EXPECT_EQ(opened.scene.sim.density, 90);
  EXPECT_EQ(opened.scene.playback.speed, 3);
  EXPECT_EQ(opened.scene.playback.budget_ms, 2);
  EXPECT_EQ(opened.scene.playback.draw_budget_ms, 40);
  EXPECT_EQ(opened.draw_governor.budget, 0.04);
  EXPECT_EQ(opened.actors[0].spec.loop, app::LoopKind::kInPlace);
  EXPECT_TRUE(opened.actors[0].spec.motion.ends_with("walk.bvh"));
  EXPECT_EQ(app::writeScene(app::movable(app::presentScene(opened))).size(),
            app::writeScene(app::movable(app::presentScene(demo))).size());
  EXPECT_NEAR((opened.camera.target - demo.camera.target).norm(), 0, 1e-12);
  EXPECT_NEAR(opened.camera.distance, demo.camera.distance, 1e-9);
  EXPECT_NEAR(opened.camera.yaw, demo.camera.yaw, 1e-9);
  EXPECT_NEAR(opened.camera.pitch, demo.camera.pitch, 1e-9);
}

// Three kept views, the second one's place empty, go with the scene; one without any leaves those of the window.
TEST(PresentScene, KeptViewsAreSavedWithIt) {
  app::Demo demo = smallDemo();
  const auto ask = [&](const app::Request& request) {
    demo.requests = {request};
    app::advanceFrame(demo, 0, {});
    ASSERT_FALSE(demo.message_is_fault) << demo.message;
  };
  for (const int place : {0, 2, 3}) {
    ask({Ask::kView, place == 0 ? "front" : place == 2 ? "side" : "back", ""});
    ask({Ask::kLens, "", "", 0.3 + 0.1 * place});
    ask({Ask::kKeepView, "", "", static_cast<double>(place)});
  }
  const auto kept = demo.bookmarks;
  const std::string folder = test::freshFolder("kept_views");
  ask({Ask::kSaveScene, "", folder + "/mine.json"});
  const app::Demo opened = app::openScene(app::loadScene(folder + "/mine.json"), 1.5);
  EXPECT_FALSE(opened.bookmarks[1]);
  for (const int place : {0, 2, 3}) {
    ASSERT_TRUE(opened.bookmarks[place]) << place;
    EXPECT_NEAR((opened.bookmarks[place]->target - kept[place]->target).norm(), 0, 1e-12);
    EXPECT_NEAR(opened.bookmarks[place]->distance, kept[place]->distance, 1e-9);
    EXPECT_NEAR(opened.bookmarks[place]->yaw, kept[place]->yaw, 1e-9);
    EXPECT_NEAR(opened.bookmarks[place]->fov, 0.3 + 0.1 * place, 1e-12);
  }
  ask({Ask::kSceneFile, "", app::dataPath("assets/scenes/head_shake.json")});
  EXPECT_TRUE(demo.bookmarks[2]) << "a scene without views takes none away";
  ask({Ask::kKeepView, "", "", 1});
  ask({Ask::kSceneFile, "", folder + "/mine.json"});
  EXPECT_FALSE(demo.bookmarks[1]) << "a scene with views has its own";
}

TEST(PresentScene, FilesOfTheProgramAreNamedBare) {
  app::Scene scene;
  app::CharacterSpec spec;
  spec.motion = app::dataPath("assets/clips/walk.bvh");
  spec.hair = "some/where.obj";
  scene.characters = {spec};
  const app::Scene moved = app::movable(scene);
  EXPECT_EQ(moved.characters[0].motion, "walk.bvh");
  EXPECT_TRUE(std::filesystem::path(moved.characters[0].hair).is_absolute());
  EXPECT_EQ(moved.characters[0].parts, "");
}

TEST(PresentScene, FilesBesideTheSceneAreMovedWithIt) {
  const std::string folder = test::freshFolder("present_scene_beside"), other = folder + "/elsewhere";
  app::Demo demo = smallDemo();
  demo.actors[0].spec.hair = folder + "/own.obj";
  app::writeFile(folder + "/own.obj", app::writeHairMesh(demo.actors[0].haircut->mesh.shape));
  demo.requests = {{Ask::kSaveScene, "", folder + "/mine.json"}};
  app::advanceFrame(demo, 0, {});
  ASSERT_FALSE(demo.message_is_fault) << demo.message;
  std::filesystem::create_directories(other);
  for (const char* name : {"/mine.json", "/own.obj"}) std::filesystem::rename(folder + name, other + name);
  const app::Scene scene = app::loadScene(other + "/mine.json");
  EXPECT_EQ(scene.characters[0].hair, other + "/own.obj");
  app::openScene(scene, 1.5);
}

}  // namespace present_scene_test
