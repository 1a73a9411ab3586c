// What brushes have made goes along where hair is made anew: tied, under a hat, painted, at another resolution, on
// another head, saved and opened.
#include "app/scene/edit/brushed_hair.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "app/files/data_path.h"
#include "app/files/hair_file.h"
#include "app/scene/edit/cut_stroke.h"
#include "app/scene/edit/groom_brush.h"
#include "app/scene/project.h"
#include "tests/app/groom/groom_samples.h"
#include "tests/app/scene/small_scene.h"
#include "tests/run_program.h"

namespace brushed_hair_test {

using app::Ask;

std::string did(const app::Request& request, app::Demo& demo) {
  demo.requests = {request, {Ask::kEndGesture, "", ""}};
  demo.message.clear();
  app::advanceFrame(demo, 0, {});
  app::finishCuts(demo);
  EXPECT_FALSE(demo.message_is_fault) << demo.message;
  return demo.message;
}

const std::vector<sim::Vec3>& restOf(const app::Demo& demo) {
  return demo.actors[0].haircut->mesh.shape.positions;
}

void brush(app::BrushTool tool, app::Demo& demo) {
  const app::Actor& actor = demo.actors[0];
  const sim::HairMeshShape& shape = actor.haircut->mesh.shape;
  std::size_t tip = 0;  // of the column that ends farthest in front
  for (int c = 0; c < shape.columnCount(); ++c) {
    const auto end = static_cast<std::size_t>(shape.column_first[static_cast<std::size_t>(c) + 1] - 1);
    if (tip == 0 || shape.positions[end].z() > shape.positions[tip].z()) tip = end;
  }
  app::BrushSample sample;
  sample.tool = tool;
  sample.at = app::scalpToWorld(actor.body->character, actor.pose).inverse() * actor.hair.positions[tip];
  sample.along = {0, 0, 0.02};
  sample.radius = 0.1;
  const std::vector<sim::Vec3> before = restOf(demo);
  did({Ask::kBrush, std::string(app::kBrushNames[static_cast<std::size_t>(tool)]), app::brushText(sample)}, demo);
  ASSERT_TRUE(restOf(demo) != before);
}

app::Demo combed(app::Style style, app::Resolution resolution = app::Resolution::kLow) {
  app::Scene scene = test::smallScene("idle_turns.bvh");
  scene.characters[0].style = style;
  scene.characters[0].resolution = resolution;
  app::Demo demo = app::openScene(std::move(scene), 1.5);
  brush(app::BrushTool::kComb, demo);
  return demo;
}

constexpr const char* kTail = R"([{"at": "back"}])";
const std::string kGlasses = R"([{"file": "glasses.obj", "joint": "head"}])";
const std::string kBeanie = R"([{"file": "beanie.obj", "joint": "head"}])";

double farthest(const std::vector<sim::Vec3>& a, const std::vector<sim::Vec3>& b) {
  EXPECT_EQ(a.size(), b.size());
  double most = 0;
  for (std::size_t v = 0; v < std::min(a.size(), b.size()); ++v) most = std::max(most, (a[v] - b[v]).norm());
  return most;
}

TEST(BrushedHair, IsTiedAsItWasBrushedAndIsThereAgainWhenItIsUntied) {
  app::Demo demo = combed(app::Style::kLong);
  brush(app::BrushTool::kCut, demo);
  const std::vector<sim::Vec3> brushed = restOf(demo);
  EXPECT_EQ(did({Ask::kTie, "", kTail}, demo).find("is gone"), std::string::npos) << demo.message;
  const std::vector<sim::Vec3> tied = restOf(demo);
  EXPECT_EQ(did({Ask::kTie, "", "[]"}, demo).find("is gone"), std::string::npos) << demo.message;
  EXPECT_TRUE(restOf(demo) == brushed);
  EXPECT_TRUE(app::reshapedByHand(*demo.actors[0].haircut));
  did({Ask::kUndo, "", "", 1}, demo);
  EXPECT_TRUE(restOf(demo) == tied);
  did({Ask::kUndo, "", "", 1}, demo);
  EXPECT_TRUE(restOf(demo) == brushed);
  did({Ask::kRedo, "", "", 1}, demo);
  EXPECT_TRUE(restOf(demo) == tied);
  did({Ask::kUndo, "", "", 3}, demo);
  EXPECT_TRUE(restOf(demo) != brushed) << "the strokes are undone as well";
  EXPECT_FALSE(app::reshapedByHand(*demo.actors[0].haircut));
  did({Ask::kTie, "", kTail}, demo);
  EXPECT_TRUE(restOf(demo) != tied) << "the stroke shows in the tail";
}

TEST(BrushedHair, StaysUnderWhatIsWornAndAfterwards) {
  app::Demo demo = combed(app::Style::kLong);
  const std::vector<sim::Vec3> brushed = restOf(demo);
  did({Ask::kAttach, "", kBeanie}, demo);
  const app::Haircut& under = *demo.actors[0].haircut;
  ASSERT_FALSE(under.covered.empty());
  EXPECT_FALSE(app::reshapedByHand(under));
  std::size_t uncovered = 0, kept = 0;
  for (std::size_t v = 0; v < brushed.size(); ++v) {
    if (std::ranges::binary_search(under.covered, static_cast<int>(v))) continue;
    ++uncovered;
    kept += (restOf(demo)[v] - brushed[v]).norm() < 0.002;
  }
  EXPECT_GT(static_cast<double>(kept), 0.9 * static_cast<double>(uncovered));
  const std::vector<sim::Vec3> pressed = restOf(demo);
  brush(app::BrushTool::kComb, demo);
  const std::vector<sim::Vec3> again = restOf(demo);
  EXPECT_EQ(did({Ask::kAttach, "", "[]"}, demo).find("is gone"), std::string::npos) << demo.message;
  for (std::size_t v = 0; v < again.size(); ++v)
    EXPECT_LT((restOf(demo)[v] - brushed[v] - (again[v] - pressed[v])).norm(), 1e-9) << "vertex " << v;
}

TEST(BrushedHair, TiedHairKeepsItsStrokesAsLongAsItsTies) {
  app::Demo demo = app::openScene(test::tiedScene(kTail, "idle_turns.bvh", app::Resolution::kLow), 1.5);
  app::Demo plain = app::openScene(test::tiedScene(kTail, "idle_turns.bvh", app::Resolution::kLow), 1.5);
  brush(app::BrushTool::kComb, demo);
  const std::vector<sim::Vec3> brushed = restOf(demo);
  did({Ask::kMap, "stiffness", "left_side.png"}, demo);
  EXPECT_TRUE(restOf(demo) == brushed);
  const double way = farthest(brushed, restOf(plain));
  // Under what is worn the tail has other seams.
  EXPECT_EQ(did({Ask::kAttach, "", kGlasses}, demo).find("is gone"), std::string::npos) << demo.message;
  did({Ask::kAttach, "", kGlasses}, plain);
  EXPECT_NEAR(farthest(restOf(demo), restOf(plain)), way, 0.3 * way);
  EXPECT_NE(did({Ask::kTie, "", R"([{"at": "high"}])"}, demo).find("the tied hair is gone"), std::string::npos)
      << demo.message;
  EXPECT_EQ(did({Ask::kTie, "", kTail}, demo).find("gone"), std::string::npos) << "nothing is, any more";
  did({Ask::kUndo, "", "", 4}, demo);
  EXPECT_TRUE(restOf(demo) == brushed);
}

// What brushes have moved, m in the mean over where they did.
double meanWay(const app::Demo& demo) {
  const app::Haircut& worn = *demo.actors[0].haircut;
  double way = 0, weight = 0;
  for (std::size_t v = 0; v < worn.painted.size(); ++v) {
    const double far = (restOf(demo)[v] - worn.painted[v]).norm();
    way += far * far, weight += far;
  }
  return weight > 0 ? way / weight : 0;
}

TEST(BrushedHair, GoesAlongToOtherResolutions) {
  for (const auto& [from, to] : {std::pair(app::Resolution::kLow, app::Resolution::kMedium),
                                 std::pair(app::Resolution::kMedium, app::Resolution::kLow)}) {
    app::Demo demo = combed(app::Style::kShoulder, from);
    const double way = meanWay(demo);
    ASSERT_GT(way, 0.002);
    const std::string said = did({Ask::kResolution, std::string(app::resolutionName(to)), ""}, demo);
    EXPECT_EQ(said.find("is gone"), std::string::npos) << said;
    EXPECT_TRUE(app::reshapedByHand(*demo.actors[0].haircut)) << said;
    EXPECT_NEAR(meanWay(demo), way, 0.35 * way) << said;
  }
}

// A cut whose edge other columns cannot follow loses some of itself there, and is whole again where it was made.
TEST(BrushedHair, ACutIsKeptAtOtherResolutionsAndComesBackAsItWas) {
  for (const auto& [from, to] : {std::pair(app::Resolution::kLow, app::Resolution::kMedium),
                                 std::pair(app::Resolution::kMedium, app::Resolution::kLow),
                                 std::pair(app::Resolution::kMedium, app::Resolution::kHigh)}) {
    app::Demo demo = combed(app::Style::kLong, from);
    for (int k = 0; k < 3; ++k) brush(app::BrushTool::kCut, demo);
    const std::vector<sim::Vec3> cut = restOf(demo);
    const double way = meanWay(demo);
    const std::string there = did({Ask::kResolution, std::string(app::resolutionName(to)), ""}, demo);
    EXPECT_GT(meanWay(demo), 0.6 * way) << app::resolutionName(from) << " to " << app::resolutionName(to) << ": "
                                        << there;
    std::printf("%s: %.1f of %.1f mm\n", there.c_str(), 1e3 * meanWay(demo), 1e3 * way);
    did({Ask::kResolution, std::string(app::resolutionName(from)), ""}, demo);
    EXPECT_TRUE(restOf(demo) == cut);
  }
}

TEST(BrushedHair, GoesAlongToAnotherHead) {
  app::Demo demo = combed(app::Style::kShoulder);
  const double way = meanWay(demo);
  did({Ask::kMotionFile, "", app::dataPath("assets/clips/walk.bvh")}, demo);
  EXPECT_NEAR(meanWay(demo), way, 0.2 * way) << demo.message;
}

TEST(BrushedHair, AnotherStyleBeginsAnewAndSaysSo) {
  app::Demo demo = combed(app::Style::kShoulder);
  EXPECT_NE(did({Ask::kStyle, "bob", ""}, demo).find("the hair is gone, Ctrl+Z"), std::string::npos) << demo.message;
  EXPECT_FALSE(app::reshapedByHand(*demo.actors[0].haircut));
  did({Ask::kStyle, "shoulder", ""}, demo);
  EXPECT_FALSE(app::reshapedByHand(*demo.actors[0].haircut));
}

TEST(BrushedHair, IsSavedWithTheHairThatWasTiedFromIt) {
  app::Demo demo = combed(app::Style::kLong);
  const std::vector<sim::Vec3> brushed = restOf(demo);
  did({Ask::kTie, "", kTail}, demo);
  const std::vector<sim::Vec3> tied = restOf(demo);
  const std::string folder = test::freshFolder("brushed_hair_saved");
  app::saveProject(folder + "/mine.json", demo);
  app::Demo other = app::openScene(test::smallScene("idle_turns.bvh"), 1.5);
  app::openProject(folder + "/mine.json", other);
  EXPECT_TRUE(restOf(other) == tied);
  did({Ask::kTie, "", "[]"}, other);
  EXPECT_TRUE(restOf(other) == brushed);
  EXPECT_EQ(did({Ask::kSaveScene, "", folder + "/scene.json"}, demo),
            "saved " + folder + "/scene.json, its hair beside it in scene-hair1.obj");
  app::Demo scene = app::openScene(app::loadScene(folder + "/scene.json"), 1.5);
  EXPECT_LT(farthest(restOf(scene), tied), 2e-3);
  did({Ask::kTie, "", "[]"}, scene);
  ASSERT_EQ(restOf(scene).size(), brushed.size());
  EXPECT_LT(farthest(restOf(scene), brushed), 1e-5);
  const test::Outcome written = test::runProgram({folder + "/mine.json", "--write-hair", folder + "/hair.obj"});
  EXPECT_EQ(written.exit_code, 0) << written.err;
  EXPECT_EQ(test::readAll(folder + "/hair.obj"), app::writeHairMesh(demo.actors[0].haircut->mesh.shape));
}

// Strokes on tied hair are no part of the hair that is tied from it.
TEST(BrushedHair, ASceneOfTiedHairHasWhatWasBrushedBefore) {
  app::Demo demo = combed(app::Style::kLong);
  const std::vector<sim::Vec3> brushed = restOf(demo);
  did({Ask::kTie, "", kTail}, demo);
  brush(app::BrushTool::kComb, demo);
  const std::string folder = test::freshFolder("brushed_hair_tied_scene");
  EXPECT_EQ(test::lacking(did({Ask::kSaveScene, "", folder + "/scene.json"}, demo), "a project keeps them"), "");
  app::Demo scene = app::openScene(app::loadScene(folder + "/scene.json"), 1.5);
  EXPECT_FALSE(scene.actors[0].haircut->tied.empty());
  did({Ask::kTie, "", "[]"}, scene);
  EXPECT_LT(farthest(restOf(scene), brushed), 1e-5);
  app::saveProject(folder + "/project.json", demo);
  EXPECT_TRUE(app::holdsProject(folder + "/project.json"));
  EXPECT_FALSE(app::holdsProject(folder + "/scene.json"));
}

}  // namespace brushed_hair_test
