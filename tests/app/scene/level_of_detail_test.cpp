// From how many pixels on a figure is simulated with less care: the sizes of docs/skipping.md, measured here with the
// camera that the picture is drawn with.
#include "app/scene/detail/level_of_detail.h"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <string>

#include "app/files/data_path.h"
#include "app/files/text_file.h"
#include "render/view_math.h"

namespace level_of_detail_test {

using app::Demo;
using app::Vec3;

constexpr int kWidth = 1080, kHeight = 720;  // pixels

Demo open(app::Style style) {
  app::Scene scene;
  app::CharacterSpec character;
  character.motion = app::dataPath("assets/clips/idle_turns.bvh");
  character.style = style;
  character.resolution = app::Resolution::kMedium;
  scene.characters.push_back(character);
  scene.playback.settle = 0;
  scene.camera.follow = false;
  return app::openScene(std::move(scene), 1.0 * kWidth / kHeight);
}

double lengthOf(const Demo& demo) {
  return demo.actors[0].haircut->mesh.hair_length;
}
// m, that hair and head span at most.
double spanOf(const Demo& demo) {
  return lengthOf(demo) + 2 * demo.actors[0].body->character.scalp.head_height;
}

// Pixels between the ends of an upright stick of `length` metres, half the hair's span nearer than the head, in the
// picture.
double drawnPixels(Demo& demo, double length) {
  const render::CameraInput camera = app::frameInput(demo, kWidth, kHeight).camera;
  const Eigen::Matrix4f to_clip = render::cameraMatrix(camera, 1.0f * kWidth / kHeight);
  const app::Actor& actor = demo.actors[0];
  const Vec3 head = app::scalpToWorld(actor.body->character, actor.pose).translation() - demo.origin;
  const Vec3 near = head + Vec3(0, 0, 0.5 * spanOf(demo));
  double row[2];
  for (const int end : {0, 1}) {
    const Vec3 p = near + Vec3(0, (end - 0.5) * length, 0);
    const Eigen::Vector4f clip = to_clip * Eigen::Vector4f(float(p.x()), float(p.y()), float(p.z()), 1);
    row[end] = 0.5 * kHeight * clip.y() / clip.w();
  }
  return row[1] - row[0];
}

// Puts the camera straight before the head, where the hair spans so many pixels.
void standAt(double pixels, Demo& demo) {
  const app::Actor& actor = demo.actors[0];
  demo.camera.anchor = app::scalpToWorld(actor.body->character, actor.pose).translation();
  demo.camera.target.setZero();
  demo.camera.yaw = demo.camera.pitch = 0;
  double near = 0.2, far = 400;  // m
  for (int halving = 0; halving < 60; ++halving) {
    demo.camera.distance = 0.5 * (near + far);
    (drawnPixels(demo, spanOf(demo)) > pixels ? near : far) = demo.camera.distance;
  }
}

struct Care {
  int span;
  std::optional<app::Resolution> mesh;
};
// Afresh: nothing of an earlier size is remembered.
Care careAt(double pixels, Demo& demo) {
  standAt(pixels, demo);
  demo.actors[0].detail = {};
  app::chooseDetail(demo);
  return {demo.actors[0].detail.step_span, demo.actors[0].detail.coarse};
}

TEST(LevelOfDetail, SizesAreThoseOfThePicture) {
  for (const app::Style style : {app::Style::kShort, app::Style::kLong}) {
    Demo demo = open(style);
    for (const double pixels : {1500.0, 520.0, 100.0, 20.0}) {
      standAt(pixels, demo);
      EXPECT_NEAR(app::projectedSize(demo, demo.actors[0]), pixels, 1e-3 * pixels) << app::styleName(style);
    }
  }
}

TEST(LevelOfDetail, StepsGrowLongerAtThePagesSizes) {
  const std::string page = app::readText(app::dataPath("docs/data/skips.md"));
  EXPECT_NE(page.find("smaller than 520 pixels takes steps twice as long, below 380 four times, below 100 eight times"),
            std::string::npos);
  struct Limit {
    double pixels;
    int above, below;
  };
  Demo demo = open(app::Style::kShort);
  for (const Limit& limit : {Limit{520, 1, 2}, Limit{380, 2, 4}, Limit{100, 4, 8}}) {
    EXPECT_EQ(careAt(1.01 * limit.pixels, demo).span, limit.above) << "just over " << limit.pixels;
    EXPECT_EQ(careAt(0.99 * limit.pixels, demo).span, limit.below) << "just under " << limit.pixels;
  }
}

TEST(LevelOfDetail, HairThatIsThrownAboutTakesShortSteps) {
  Demo demo = open(app::Style::kShort);
  app::Actor& actor = demo.actors[0];
  ASSERT_EQ(careAt(99, demo).span, 8);
  // The tip of a column, and then the whole figure, which counts for nothing.
  const double share = 0.1 * lengthOf(demo);
  const auto moved = [&](double way) {
    actor.previous_positions = actor.hair.positions;
    actor.previous_positions.back().x() -= way;
    return careAt(99, demo).span;
  };
  EXPECT_EQ(moved(0.99 * share / 8), 8);
  EXPECT_EQ(moved(1.01 * share / 8), 4);
  EXPECT_EQ(moved(1.01 * share / 4), 2);
  EXPECT_EQ(moved(1.01 * share / 2), 1);
  actor.previous_positions = actor.hair.positions;
  for (Vec3& p : actor.previous_positions) p.x() -= share;
  for (app::Rigid& joint : actor.previous_pose.world) joint.pretranslate(Vec3(-share, 0, 0));
  EXPECT_EQ(careAt(99, demo).span, 8);
  // Of a step over several of the clock, the way that one of them would be.
  actor.previous_pose = actor.pose;
  actor.span = 4;
  EXPECT_EQ(moved(1.01 * share / 8), 8);
}

TEST(LevelOfDetail, MeshesGrowCoarserAtThePagesSizes) {
  const std::string page = app::readText(app::dataPath("docs/data/skips.md"));
  EXPECT_NE(
      page.find("smaller than 420 pixels, its hair shorter than 150, is simulated with its style's low resolution, "
                "below 240 with its minimal one"),
      std::string::npos);
  for (const app::Style style : {app::Style::kShort, app::Style::kLong}) {
    Demo demo = open(style);
    // Figure and hair must both be small.
    const double low = std::min(420.0, 150 * spanOf(demo) / lengthOf(demo)), minimal = std::min(240.0, low);
    EXPECT_FALSE(careAt(1.01 * low, demo).mesh) << app::styleName(style);
    if (minimal < low) {
      EXPECT_EQ(careAt(0.99 * low, demo).mesh, app::Resolution::kLow) << app::styleName(style);
      EXPECT_EQ(careAt(1.01 * minimal, demo).mesh, app::Resolution::kLow) << app::styleName(style);
    }
    EXPECT_EQ(careAt(0.99 * minimal, demo).mesh, app::Resolution::kMinimal) << app::styleName(style);
  }
}

// On the way back each switches a fifth later, so that a figure at the limit does not switch to and fro.
TEST(LevelOfDetail, TheWayBackIsAFifthFurther) {
  Demo demo = open(app::Style::kShort);
  ASSERT_EQ(careAt(500, demo).span, 2);
  standAt(1.19 * 520, demo);
  app::chooseDetail(demo);
  EXPECT_EQ(demo.actors[0].detail.step_span, 2);
  standAt(1.21 * 520, demo);
  app::chooseDetail(demo);
  EXPECT_EQ(demo.actors[0].detail.step_span, 1);
}

// A figure beside the picture is seen where the picture is shifted towards it.
TEST(LevelOfDetail, WhatAShiftBringsIntoThePictureIsSeen) {
  Demo demo = open(app::Style::kShort);
  const app::Actor& actor = demo.actors[0];
  standAt(200, demo);
  demo.scene.look.light.shadows = false;
  const double half = std::tan(0.5 * demo.camera.fov) * demo.aspect * demo.camera.distance;  // m, of the picture
  demo.camera.target.x() = 1.3 * half + 1;  // the figure, with the metre that it may take, lies left of the picture
  EXPECT_FALSE(app::mayBeSeen(demo, actor));
  demo.place.shift = 0.6;
  EXPECT_TRUE(app::mayBeSeen(demo, actor));
  demo.place.shift = -0.6;
  EXPECT_FALSE(app::mayBeSeen(demo, actor));
}

// The same of a figure below the picture; and a view of half the size reaches twice as far and shows all half as large.
TEST(LevelOfDetail, GoesByThePlaceOfTheView) {
  Demo demo = open(app::Style::kShort);
  const app::Actor& actor = demo.actors[0];
  standAt(200, demo);
  demo.scene.look.light.shadows = false;
  demo.camera.pitch = 0;
  const double half = std::tan(0.5 * demo.camera.fov) * demo.camera.distance;  // m, of the picture
  demo.camera.target.y() = 1.3 * half + 1;
  EXPECT_FALSE(app::mayBeSeen(demo, actor));
  demo.place.rise = -0.6;
  EXPECT_FALSE(app::mayBeSeen(demo, actor));
  demo.place.rise = 0.6;
  EXPECT_TRUE(app::mayBeSeen(demo, actor));
  const double size = app::projectedSize(demo, actor);
  demo.place = {0, 0, 0.5};
  EXPECT_TRUE(app::mayBeSeen(demo, actor));
  EXPECT_NEAR(app::projectedSize(demo, actor), 0.5 * size, 1e-9 * size);
}

}  // namespace level_of_detail_test
