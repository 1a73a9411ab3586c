// Painted fields: white changes no bit, strokes change the hair and are undone, saved and replayed to the bit, and what
// cannot be painted is told.
#include "app/scene/edit/paint_brush.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ranges>

#include "app/files/errors.h"
#include "app/files/image_io.h"
#include "app/files/recording.h"
#include "app/scene/project.h"
#include "tests/app/scene/small_scene.h"
#include "tests/run_program.h"

namespace paint_brush_test {

using app::Ask;

app::Demo open(app::Scene scene) {
  return app::openScene(std::move(scene), 1.5);
}

// A stroke on the crown's hair of the first character.
app::Request paintOf(const std::string& field, double value, double radius = 0.08) {
  app::PaintSample sample{field, sim::Vec3(0.05, 0.17, 0), radius, 0.8, 1, true, value};
  sample.color = {value, value, value};
  return {Ask::kPaint, field, app::paintText(sample)};
}

void frames(int count, app::Demo& demo) {
  for (int k = 0; k < count; ++k) app::advanceFrame(demo, 1.0 / 60, {});
}

// m, of all columns.
double lengthOf(const app::Demo& demo) {
  const sim::HairMesh& mesh = demo.actors[0].haircut->mesh;
  double sum = 0;
  for (int v = 1; v < mesh.vertexCount(); ++v) {
    if (mesh.isRoot(v)) continue;
    const auto at = static_cast<std::size_t>(v);
    sum += (mesh.shape.positions[at] - mesh.shape.positions[at - 1]).norm();
  }
  return sum;
}

std::string whitePicture() {
  return app::pictureText(app::FieldMap{4, 2, std::vector<float>(8, 1)});
}

TEST(PaintBrush, ASampleReadsBackToTheSameBits) {
  app::PaintSample sample{"mass", sim::Vec3(0.1, -1.0 / 3, 2e-17), 0.0123456789, 1.0 / 7, 2.5, true, 0.3};
  EXPECT_EQ(app::paintText(app::parsePaint("mass", app::paintText(sample))), app::paintText(sample));
  EXPECT_THROW(app::parsePaint("colour", app::paintText(sample)), app::InputError);
  EXPECT_THROW(app::parsePaint("color", app::paintText(sample)), app::InputError) << "of one channel";
  app::PaintSample dye{"color", sample.at, 0.01, 1, 1, false, 0, {0.1, 1.0 / 3, 1}};
  EXPECT_EQ(app::paintText(app::parsePaint("color", app::paintText(dye))), app::paintText(dye));
  EXPECT_THROW(app::parsePaint("mass", app::paintText(dye)), app::InputError) << "of three channels";
  for (const char* text : {"", "1 2 3", "0 0 0 9 1 1 0 0", "0 0 0 0.1 1 1 0 2", "0 0 0 0.1 nan 1 0 0"})
    EXPECT_THROW(app::parsePaint("mass", text), app::InputError) << text;
}

TEST(PaintBrush, APictureInTextReadsBackToTheSameGreys) {
  for (int count : {1, 2, 3, 7, 64}) {
    app::FieldMap map{count, 1, {}};
    for (int k = 0; k < count; ++k) map.value.push_back(static_cast<float>(k * 3 % 256) / 255);
    const app::FieldMap back = app::readFieldMap(app::pictureText(map));
    ASSERT_EQ(back.width, count);
    for (std::size_t k = 0; k < map.value.size(); ++k) EXPECT_NEAR(back.value[k], map.value[k], 1e-6);
  }
  EXPECT_THROW(app::readFieldMap("data:image/png;base64,????"), app::InputError);
  const app::FieldMap red{2, 1, {0.2f, 1}}, blue{2, 1, {0, 0.6f}};
  const app::ColorMap color = app::readColorMap(app::pictureText(app::ColorMap{red, red, blue}));
  EXPECT_EQ(color[1].value, red.value);
  EXPECT_EQ(color[2].value, blue.value);
}

TEST(PaintBrush, SharesOfLightAndPicturesGoForthAndBack) {
  EXPECT_EQ(app::linearShare(1), 1) << "white changes no bit";
  for (const double value : {0.0, 0.02, 0.3, 0.99})
    EXPECT_NEAR(app::pictureValue(app::linearShare(value)), value, 1e-9);
}

TEST(PaintBrush, WhiteFieldsAndCurvesOfOneGiveTheScalarsResultToTheBit) {
  app::Demo plain = open(test::smallScene("walk.bvh", 0.3));
  app::Scene scene = test::smallScene("walk.bvh", 0.3);
  for (const std::string_view name : app::kFieldNames) *app::findMap(name, scene.characters[0].maps) = whitePicture();
  for (const std::string_view name : app::kCurveNames)
    app::setCurve(std::string(name), name == "color" ? "#ffffff,1" : "1,1,1", scene.characters[0].curves);
  app::Demo painted = open(std::move(scene));
  frames(20, plain);
  painted.requests = {paintOf("stiffness", 1), paintOf("mass", 1), paintOf("bend", 1), paintOf("color", 1),
                      paintOf("curl", 1)};
  frames(20, painted);
  EXPECT_NE(painted.message.find("is there already"), std::string::npos) << painted.message;
  EXPECT_EQ(app::stateHash(plain), app::stateHash(painted));
  const app::PaintedLook& look = painted.actors[0].haircut->look_shares;
  EXPECT_TRUE(look.roots.empty() && look.along.empty()) << "the renderer is given nothing";
}

// `change` puts the same into a scene's parameters and into the curves of another.
void expectCurveIsParameter(void (*change)(sim::SimParams&, app::FieldCurves&)) {
  app::Scene half = test::smallScene("walk.bvh", 0.3), curve = half;
  app::FieldCurves no_curves;
  sim::SimParams same = half.sim;
  change(half.sim, no_curves);
  change(same, curve.characters[0].curves);
  app::Demo one = open(std::move(half)), other = open(std::move(curve));
  frames(10, one), frames(10, other);
  double apart = 0;
  for (std::size_t v = 0; v < one.actors[0].hair.positions.size(); ++v)
    apart = std::max(apart, (one.actors[0].hair.positions[v] - other.actors[0].hair.positions[v]).norm());
  EXPECT_LT(apart, 1e-9) << "a power of two";
}

TEST(PaintBrush, AUniformCurveOfBendIsTheParameter) {
  expectCurveIsParameter([](sim::SimParams& params, app::FieldCurves& curves) {
    params.bend *= 0.5;
    curves.bend = {0.5, 0.5};
  });
}

// But for rounding: the share is a mean of six.
TEST(PaintBrush, AUniformCurveOfDampingIsTheParameter) {
  expectCurveIsParameter([](sim::SimParams& params, app::FieldCurves& curves) {
    params.damping *= 0.5;
    curves.damping = {0.5, 0.5};
  });
}

TEST(PaintBrush, AUniformCurveIsAsMuchAsTheParameter) {
  app::Scene half = test::smallScene("walk.bvh", 0.3), curve = half;
  half.sim.density *= 2;
  curve.characters[0].curves.mass = {2};
  app::Demo one = open(std::move(half)), other = open(std::move(curve));
  frames(1, one), frames(1, other);
  double apart = 0;
  for (std::size_t v = 0; v < one.actors[0].hair.positions.size(); ++v)
    apart = std::max(apart, (one.actors[0].hair.positions[v] - other.actors[0].hair.positions[v]).norm());
  EXPECT_LT(apart, 0.02);
}

TEST(PaintBrush, EveryFieldIsPaintedAndUndone) {
  for (const std::string_view name : app::kFieldNames) {
    const std::string field(name);
    app::Demo demo = open(test::smallScene("walk.bvh", 0.3));
    if (field == "curl") demo.actors[0].spec.look.hair.curl_radius = 0.005f;  // of straight hair it begins at none
    frames(5, demo);
    const std::string before = app::stateHash(demo);
    const float area = demo.actors[0].haircut->faces[0].area;
    const double length = lengthOf(demo);
    for (int k = 0; k < 6; ++k) {
      demo.requests = {paintOf(field, 0.1)};
      app::advanceFrame(demo, 0, {});
      ASSERT_FALSE(demo.message_is_fault) << demo.message;
    }
    const app::Haircut& cut = *demo.actors[0].haircut;
    app::FieldFiles maps = demo.actors[0].spec.maps;
    const app::FieldMap map = app::readFieldMap(*app::findMap(field, maps));
    EXPECT_LT(*std::ranges::min_element(map.value), 0.2) << field;
    EXPECT_GT(*std::ranges::max_element(map.value), 0.9) << field << ": the brush is everywhere";
    if (field == "stiffness") {
      EXPECT_LT(*std::ranges::min_element(cut.shares.stiffness), 0.4f);
    }
    if (field == "damping") {
      EXPECT_LT(*std::ranges::min_element(cut.shares.damping), 0.4f);
      EXPECT_EQ(cut.mesh.damping_share.size(), cut.mesh.shape.positions.size());
    }
    if (field == "bend") {
      EXPECT_LT(*std::ranges::min_element(cut.shares.bend), 0.4f);
      EXPECT_TRUE(cut.shares.stiffness.empty());
    }
    EXPECT_EQ(cut.look_shares.roots.empty(), !app::isOfLook(field)) << field;
    if (app::isOfLook(field)) {
      const auto shown = [&](const render::LookShare& share) {
        return std::min({share.width, share.clump, share.curl, share.roughness, share.frizz, share.color[2]});
      };
      EXPECT_LT(std::ranges::min(cut.look_shares.roots | std::views::transform(shown)), 0.5f) << field;
    }
    if (field == "mass") {
      EXPECT_LT(*std::ranges::min_element(cut.shares.mass), 0.5f);
    }
    if (field == "length") {
      EXPECT_LT(lengthOf(demo), 0.97 * length);
    }
    if (field == "density") {
      EXPECT_TRUE(std::ranges::any_of(cut.faces, [&](const auto& face) { return face.area < area; }));
    }
    EXPECT_EQ(demo.edits.steps.size(), 1u) << "a stroke is one step";
    demo.requests = {{Ask::kUndo, "", "", 1}};
    app::advanceFrame(demo, 0, {});
    EXPECT_EQ(app::stateHash(demo), before) << field;
    EXPECT_EQ(demo.actors[0].spec.maps, app::FieldFiles{});
    EXPECT_EQ(demo.actors[0].haircut->shares, app::PaintedShares{});
    EXPECT_TRUE(demo.actors[0].haircut->look_shares.roots.empty());
    demo.requests = {{Ask::kRedo, "", "", 1}};
    frames(10, demo);
    EXPECT_EQ(demo.actors[0].spec.maps, maps) << field;
    EXPECT_EQ(demo.stats.recoveries, 0);
  }
}

TEST(PaintBrush, WhatCannotBePaintedIsToldAndStays) {
  app::Scene scene = test::smallScene("walk.bvh");
  scene.characters[0].style = app::Style::kLong;
  scene.characters[0].ties = app::tiesFromText("back");
  app::Demo demo = open(std::move(scene));
  const std::string before = app::stateHash(demo);
  const auto told = [&](app::Request request, const std::string& part) {
    demo.requests = {std::move(request)};
    app::advanceFrame(demo, 0, {});
    EXPECT_TRUE(demo.message_is_fault);
    EXPECT_NE(demo.message.find(part), std::string::npos) << demo.message;
    EXPECT_EQ(app::stateHash(demo), before);
    EXPECT_EQ(demo.actors[0].spec.maps, app::FieldFiles{});
  };
  told(paintOf("length", 0), "tied");
  told({Ask::kPaint, "stiffness", "5 5 5 0.03 1 1 0 0"}, "reaches no hair");
  told({Ask::kCurve, "stiffness", "1,x"}, "no list of shares");
  told({Ask::kCurve, "stiffness", "0"}, "no list of shares");
  told({Ask::kCurve, "length", "1"}, "no field");
  told({Ask::kCurve, "width", "#ffffff"}, "no list of shares");
  told({Ask::kCurve, "color", "#fffffg"}, "no list of shares");
  told({Ask::kPaint, "color", "0 0.2 0 0.03 1 1 0 0"}, "not ten numbers");
  told({Ask::kMap, "curl", "walk.bvh"}, "walk.bvh");
}

TEST(PaintBrush, WhatIsThereAlreadyIsToldAndMakesNoStep) {
  app::Demo demo = open(test::smallScene("walk.bvh"));
  const auto paint = [&] {
    demo.requests = {paintOf("mass", 0.5)};
    app::advanceFrame(demo, 0, {});
    demo.requests = {{Ask::kEndGesture, "", ""}};
    app::advanceFrame(demo, 0, {});
  };
  for (int k = 0; k < 40 && !demo.message_is_fault; ++k) paint();
  EXPECT_NE(demo.message.find("is there already"), std::string::npos) << demo.message;
  const std::size_t steps = demo.edits.steps.size();
  const std::string before = demo.actors[0].spec.maps.mass;
  EXPECT_GE(steps, 1u);
  paint();
  EXPECT_EQ(demo.edits.steps.size(), steps);
  EXPECT_EQ(demo.actors[0].spec.maps.mass, before);
}

// Straight hair curls where it is painted, and nowhere else; undone, it is straight again. Less of no curls is told.
TEST(PaintBrush, StraightHairCurlsWhereItIsPainted) {
  app::Demo demo = open(test::smallScene("walk.bvh"));
  app::Actor& actor = demo.actors[0];
  actor.spec.look.hair.curl_radius = 0;
  demo.requests = {paintOf("curl", 0)};
  app::advanceFrame(demo, 0, {});
  EXPECT_FALSE(demo.message_is_fault);
  EXPECT_EQ(demo.message, "painted curl changes nothing while curl_radius is 0");
  demo.requests = {{Ask::kUndo, "", "", 1}};
  app::advanceFrame(demo, 0, {});
  ASSERT_TRUE(demo.actors[0].spec.maps.curl.empty());

  demo.requests = {paintOf("curl", 1), paintOf("curl", 1), {Ask::kEndGesture, "", ""}};
  app::advanceFrame(demo, 0, {});
  EXPECT_GT(demo.actors[0].spec.look.hair.curl_radius, 0.003f);
  float least = 1, most = 0;
  for (const render::LookShare& share : demo.actors[0].haircut->look_shares.roots)
    least = std::min(least, share.curl), most = std::max(most, share.curl);
  EXPECT_LT(least, 0.02f);
  EXPECT_GT(most, 0.5f);
  demo.requests = {{Ask::kUndo, "", "", 1}};
  app::advanceFrame(demo, 0, {});
  EXPECT_EQ(demo.actors[0].spec.look.hair.curl_radius, 0);
  EXPECT_TRUE(demo.actors[0].spec.maps.curl.empty());
}

TEST(PaintBrush, CurvesOfTheLookAreDrawnAndUndone) {
  app::Demo demo = open(test::smallScene("walk.bvh", 0.3));
  frames(2, demo);
  const std::string before = app::stateHash(demo);
  demo.requests = {{Ask::kCurve, "color", "#ffffff,#ff0000"}, {Ask::kCurve, "curl", "0.5,2"}};
  app::advanceFrame(demo, 0, {});
  ASSERT_FALSE(demo.message_is_fault) << demo.message;
  const std::vector<render::LookShare>& along = demo.actors[0].haircut->look_shares.along;
  ASSERT_FALSE(along.empty());
  EXPECT_EQ(along.front().color, (render::Float3{1, 1, 1}));
  EXPECT_EQ(along.back().color, (render::Float3{1, 0, 0}));
  EXPECT_FLOAT_EQ(along.front().curl, 0.5f);
  EXPECT_FLOAT_EQ(along.back().curl, 2);
  EXPECT_EQ(app::stateHash(demo), before) << "what is drawn alone moves nothing";
  demo.requests = {{Ask::kUndo, "", "", 2}};
  app::advanceFrame(demo, 0, {});
  EXPECT_TRUE(demo.actors[0].haircut->look_shares.along.empty());
  EXPECT_EQ(demo.actors[0].spec.curves, app::FieldCurves{});
}

TEST(PaintBrush, ASceneAndAProjectKeepIt) {
  app::Demo demo = open(test::smallScene("walk.bvh", 0.2));
  demo.requests = {paintOf("stiffness", 0),
                   paintOf("length", 0.3),
                   paintOf("mass", 0.4),
                   {Ask::kCurve, "mass", "1,0.5"},
                   paintOf("color", 0.4),
                   paintOf("bend", 0.3),
                   {Ask::kCurve, "color", "1,#804020"}};
  frames(5, demo);
  ASSERT_FALSE(demo.message_is_fault) << demo.message;
  const app::Scene back = app::readScene(app::writeScene(demo.scene), "scene.json");
  EXPECT_EQ(back.characters.size(), 1u);
  const std::string file = test::freshFolder("painted_project") + "/project.json";
  app::saveProject(file, demo);
  app::Demo other = open(test::smallScene("walk.bvh"));
  app::openProject(file, other);
  EXPECT_EQ(app::stateHash(other), app::stateHash(demo));
  EXPECT_EQ(other.actors[0].spec.maps, demo.actors[0].spec.maps);
  EXPECT_EQ(other.actors[0].spec.curves, demo.actors[0].spec.curves);
  EXPECT_EQ(other.actors[0].haircut->mesh.shape.positions, demo.actors[0].haircut->mesh.shape.positions);
}

TEST(PaintBrush, AMapThatIsNotAsExpectedIsSaidWithItsFile) {
  const std::string folder = test::freshFolder("odd_map");
  const auto noteOf = [&](const char* name, int width, int height, std::array<unsigned char, 4> left) {
    std::vector<unsigned char> rgba;
    for (int k = 0; k < width * height; ++k) {
      if (k % width < width / 2) {
        rgba.insert(rgba.end(), left.begin(), left.end());
      } else {
        rgba.insert(rgba.end(), {255, 255, 255, 255});
      }
    }
    app::FieldFiles maps;
    maps.mass = folder + "/" + name;
    app::writePng(maps.mass, width, height, rgba);
    const std::string notes = app::mapNotes(maps);
    EXPECT_TRUE(notes.empty() || notes.starts_with(maps.mass + " is ")) << notes;
    return notes;
  };
  EXPECT_EQ(noteOf("grey.png", 64, 32, {90, 90, 90, 255}), "");
  EXPECT_NE(noteOf("blue.png", 64, 32, {20, 40, 200, 255}).find("coloured"), std::string::npos);
  EXPECT_NE(noteOf("glass.png", 64, 32, {90, 90, 90, 0}).find("transparent"), std::string::npos);
  EXPECT_NE(noteOf("square.png", 50, 50, {90, 90, 90, 255}).find("50x50"), std::string::npos);
  EXPECT_EQ(noteOf("white.png", 50, 50, {255, 255, 255, 255}), "") << "the same everywhere, whatever its sides";
  app::Scene scene = test::smallScene("idle_turns.bvh");
  scene.characters[0].maps.mass = folder + "/blue.png";
  EXPECT_NE(app::openScene(std::move(scene), 1.5).message.find("blue.png is coloured"), std::string::npos);
}

// The mean share of the hair's volume, and that of each side, whatever the mesh.
TEST(PaintBrush, AFieldPaintsTheSameShareOfTheHairAtEveryResolution) {
  const app::Character character = app::loadCharacter(app::dataPath("assets/clips/idle_turns.bvh"), "");
  const app::BodyDistance body = app::restBodyDistance(character);
  app::FieldFiles maps;
  maps.stiffness = app::dataPath("assets/maps/left_side.png");
  std::vector<double> means;
  for (const app::Resolution resolution : {app::Resolution::kLow, app::Resolution::kMedium, app::Resolution::kHigh}) {
    const sim::HairMesh mesh =
        sim::buildHairMesh(app::makeStyle(app::Style::kShoulder, resolution, character.scalp, body));
    const std::vector<float> shares = app::paintedShares(maps, {}, character.scalp, mesh.shape).stiffness;
    ASSERT_EQ(shares.size(), mesh.shape.positions.size());
    double painted = 0, whole = 0;
    for (std::size_t v = 0; v < shares.size(); ++v) {
      painted += double(shares[v]) * mesh.vertex_volume[v];
      whole += mesh.vertex_volume[v];
    }
    means.push_back(painted / whole);
    std::printf("%s: %.3f of the hair's stiffness\n", app::resolutionName(resolution).data(), means.back());
  }
  EXPECT_LT(means[2], 0.9);
  EXPECT_NEAR(means[0], means[2], 0.06);
  EXPECT_NEAR(means[1], means[2], 0.05);
}

}  // namespace paint_brush_test
