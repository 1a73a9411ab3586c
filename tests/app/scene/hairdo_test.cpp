// Hairdos that the program comes with go onto the figure at hand, and away again.
#include "app/scene/hairdo.h"

#include <gtest/gtest.h>

#include "app/files/data_path.h"
#include "app/scene/demo.h"
#include "tests/app/scene/small_scene.h"

namespace hairdo_test {

using app::Ask;

TEST(Hairdo, EachIsTheHairOfItsSceneOnTheFigureAtHand) {
  for (const std::string_view name : app::kHairdoNames) {
    const app::CharacterSpec worn =
        app::loadScene(app::dataPath("assets/scenes/" + std::string(name) + ".json")).characters.front();
    app::CharacterSpec spec;
    spec.motion = "walk.bvh";
    spec.hair = "mine.obj";
    spec.resolution = app::Resolution::kHigh;
    app::chooseStyle(std::string(name), spec);
    EXPECT_EQ(spec.style, worn.style) << name;
    EXPECT_TRUE(spec.look == worn.look) << name;
    EXPECT_EQ(spec.ties.size(), worn.ties.size()) << name;
    EXPECT_EQ(spec.hair, "") << name;
    EXPECT_EQ(spec.motion, "walk.bvh") << name;
    EXPECT_EQ(spec.resolution, app::Resolution::kHigh) << name;
  }
}

TEST(Hairdo, IsPutOnAndUndoneInTheWindow) {
  app::Demo demo = app::openScene(test::smallScene("idle_turns.bvh"), 1.5);
  const app::CharacterSpec before = demo.actors[0].spec;
  const auto did = [&](const app::Request& request) {
    demo.requests = {request, {Ask::kEndGesture, "", ""}};
    app::advanceFrame(demo, 0, {});
    return demo.message;
  };
  did({Ask::kStyle, "curly", ""});
  ASSERT_FALSE(demo.message_is_fault) << demo.message;
  EXPECT_GT(demo.actors[0].spec.look.hair.curl_radius, 0.005f);
  did({Ask::kStyle, "plaits", ""});
  ASSERT_FALSE(demo.message_is_fault) << demo.message;
  EXPECT_EQ(demo.actors[0].spec.ties.size(), 2u);
  did({Ask::kUndo, "", "", 2});
  EXPECT_TRUE(demo.actors[0].spec.look == before.look);
  EXPECT_EQ(demo.actors[0].spec.style, before.style);
  EXPECT_TRUE(demo.actors[0].spec.ties.empty());
  EXPECT_NE(did({Ask::kStyle, "curley", ""}).find("did you mean 'curly'?"), std::string::npos) << demo.message;
}

}  // namespace hairdo_test
