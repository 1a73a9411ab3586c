// What pictures of presets show, without drawing them.
#include "app/scene/view/preset_picture.h"

#include <gtest/gtest.h>

#include <string>

#include "app/files/data_path.h"
#include "app/files/errors.h"
#include "app/files/tie_spec.h"
#include "render/view_math.h"
#include "tests/app/scene/small_scene.h"

namespace preset_picture_test {

using app::Demo;
using app::Vec3;

Demo longHair(const std::string& tie = "") {
  app::Scene scene = test::smallScene("walk.bvh");
  scene.characters[0].style = app::Style::kLong;
  if (!tie.empty()) scene.characters[0].ties = app::tiesFromText(tie);
  return app::openScene(std::move(scene), 1.5);
}

std::string preset(const std::string& name) {
  return app::dataPath("assets/presets/" + name + ".json");
}

TEST(PresetPicture, DependsOnHairAndSettingsAndNotOnTheMoment) {
  Demo demo = longHair();
  const app::PictureSubject before = app::pictureSubject(demo);
  for (int k = 0; k < 5; ++k) app::advanceFrame(demo, 1.0 / 60, {});
  EXPECT_EQ(app::pictureSubject(demo), before);
  const auto changes = [&](const app::Request& request) {
    const app::PictureSubject was = app::pictureSubject(demo);
    demo.requests = {request};
    app::advanceFrame(demo, 0, {});
    EXPECT_FALSE(demo.message_is_fault) << demo.message;
    EXPECT_FALSE(app::pictureSubject(demo) == was) << request.name;
  };
  changes({app::Ask::kSetParam, "bend", "0.07"});
  changes({app::Ask::kSetParam, "eumelanin", "3"});
  changes({app::Ask::kSetParam, "exposure", "2"});
  changes({app::Ask::kCurve, "width", "1,0.3"});
  changes({app::Ask::kMesh, "add-layer", "3"});
  changes({app::Ask::kStyle, "short", ""});
}

TEST(PresetPicture, APresetThatLeavesTheMotionIsShownAtRest) {
  const Demo demo = longHair();
  const app::PresetScene black = app::presetScene(preset("black"), demo);
  EXPECT_EQ(black.look.hair.eumelanin, 4);
  EXPECT_FALSE(app::swingOf(black, demo));
  const app::PresetScene wet = app::presetScene(preset("wet"), demo);
  EXPECT_EQ(wet.sim.density, 160);
  EXPECT_TRUE(app::swingOf(wet, demo));
  EXPECT_THROW(app::presetScene(preset("nowhere"), demo), app::InputError);
}

TEST(PresetPicture, TiedHairIsShownAtRest) {
  const Demo demo = longHair("back");
  EXPECT_FALSE(app::swingOf(app::presetScene(preset("wet"), demo), demo));
}

// m, mean way of the hair from where it is at rest.
double lag(const char* name, const Demo& demo) {
  const std::optional<app::Swing> swing = app::swingOf(app::presetScene(preset(name), demo), demo);
  const std::vector<Vec3> hair = app::swungHair(*swing);
  double sum = 0;
  for (std::size_t v = 0; v < hair.size(); ++v) sum += (hair[v] - swing->head * swing->mesh.shape.positions[v]).norm();
  return sum / static_cast<double>(hair.size());
}

TEST(PresetPicture, HairThatMovesMoreIsShownFartherBehind) {
  const Demo demo = longHair();
  const double sprayed = lag("sprayed", demo), natural = lag("natural", demo), wet = lag("wet", demo);
  EXPECT_GT(natural, 2 * sprayed);
  EXPECT_GT(wet, natural);
}

TEST(PresetPicture, ShowsTheHeadFromBeforeIt) {
  const Demo demo = longHair();
  app::PresetScene black = app::presetScene(preset("black"), demo);
  const render::FrameInput frame = app::presetFrame(demo, {}, 90, 90, 1, black);
  EXPECT_EQ(frame.hairs.size(), 1u);
  EXPECT_EQ(frame.hairs[0].look.eumelanin, 4);
  EXPECT_EQ(frame.hairs[0].positions.size(), demo.actors[0].haircut->rest.size());
  const Eigen::Matrix4f to_clip = render::cameraMatrix(frame.camera, 1);
  int seen = 0, of = 0;
  for (std::size_t v = 0; v + 2 < black.positions.size(); v += 3, ++of) {
    const Eigen::Vector4f clip =
        to_clip * Eigen::Vector4f(black.positions[v], black.positions[v + 1], black.positions[v + 2], 1);
    seen += std::abs(clip.x()) < clip.w() && std::abs(clip.y()) < clip.w();
  }
  EXPECT_GT(seen, of / 2);
  const app::Character& character = demo.actors[0].body->character;
  const Vec3 forward = app::scalpToWorld(character, black.pose).linear() * Vec3::UnitZ();
  EXPECT_GT(forward.z(), 0.9 * std::hypot(forward.x(), forward.z()));
}

}  // namespace preset_picture_test
