// The hair that is simulated, into files: every format has the same strands in every frame, where and as they are
// drawn.
#include "app/scene/record/hair_export.h"

#include <gtest/gtest.h>

#include <cstring>
#include <nlohmann/json.hpp>
#include <set>

#include "app/figure/head_model.h"
#include "app/files/data_path.h"
#include "app/files/polygon_file.h"
#include "app/groom/formats/alembic_file.h"
#include "app/groom/formats/usda_file.h"
#include "app/groom/groom_file.h"
#include "app/groom/inspect/groom_inspect.h"
#include "app/scene/record/card_mesh.h"
#include "tests/app/groom/groom_samples.h"
#include "tests/app/groom/second_reader.h"
#include "tests/app/scene/small_scene.h"

namespace hair_export_test {

namespace fs = std::filesystem;

// A run of the program without pictures, of 600 strands of the short style.
test::Outcome exported(const std::string& file, std::vector<std::string> more, int frames = 6) {
  std::vector<std::string> arguments{"--no-images", "--frames",     std::to_string(frames),
                                     "--strands",   "600",          "--style",
                                     "short",       "--resolution", "low",
                                     "--motion",    "walk.bvh",     "--export",
                                     file};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return test::runProgram(arguments);
}

void expectTheSame(const app::Groom& a, const app::Groom& b) {
  EXPECT_EQ(a.strand_first, b.strand_first);
  EXPECT_EQ(a.points, b.points);
  EXPECT_EQ(a.widths, b.widths);
  EXPECT_EQ(a.colors, b.colors);
}

TEST(HairExport, EveryFormatHasTheSameStrandsInEveryFrame) {
  const std::string folder = test::freshFolder("hair_export");
  for (const char* ending : {"abc", "usda", "hair", "ply", "tfx"}) {
    const test::Outcome outcome = exported(folder + "/walk." + ending, {"--export-points", "16"});
    EXPECT_EQ(outcome.exit_code, 0) << ending << outcome.err;
    EXPECT_EQ(test::lacking(outcome.out, "6 frames of "), "");
  }
  const std::string bytes = test::readAll(folder + "/walk.abc"), text = test::readAll(folder + "/walk.usda");
  ASSERT_EQ(app::alembicTimes(bytes, "walk.abc").size(), 6u);
  for (std::size_t frame = 0; frame < 6; ++frame) {
    const app::Groom strands = app::readAlembic(bytes, "walk.abc", frame);
    const std::string number = "/walk_000" + std::to_string(frame);
    EXPECT_GT(strands.strandCount(), 500u);
    expectTheSame(app::readUsda(text, "walk.usda", frame), strands);
    expectTheSame(app::readGroom(folder + number + ".hair"), strands);
    expectTheSame(app::readGroom(folder + number + ".ply"), strands);
    const app::Groom tressfx = app::readGroom(folder + number + ".tfx");
    EXPECT_EQ(tressfx.points, strands.points);
    EXPECT_EQ(tressfx.root_uvs, strands.root_uvs);
  }
  const app::Groom first = app::readAlembic(bytes, "walk.abc", 0), last = app::readAlembic(bytes, "walk.abc", 5);
  EXPECT_NE(first.points, last.points) << "nothing moves";
  EXPECT_EQ(first.ids.size(), first.strandCount());
  for (std::size_t s = 0; s < first.strandCount(); ++s) {
    EXPECT_GT(first.strand(s)[0].y(), 1.3f) << "roots are in the world, at a head's height";
    EXPECT_TRUE((first.root_uvs[s].array() >= 0).all() && (first.root_uvs[s].array() <= 1).all());
  }
  EXPECT_TRUE(test::dumpClip({}, {first}).size() > 100);
  const std::string second = test::secondReading(folder + "/walk.abc");
  EXPECT_TRUE(second.find("failed") == std::string::npos) << second.substr(0, 500);
}

TEST(HairExport, FramesAreChosenAndNumbered) {
  const std::string folder = test::freshFolder("hair_export_range");
  const test::Outcome outcome = exported(folder + "/a.hair", {"--export-frames", "1-5", "--export-every", "2"});
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_EQ(test::lacking(outcome.out, "written to " + folder + "/a_0001.hair to " + folder + "/a_0005.hair"), "");
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) names.push_back(entry.path().filename().string());
  std::ranges::sort(names);
  EXPECT_EQ(names, (std::vector<std::string>{"a_0001.hair", "a_0003.hair", "a_0005.hair"}));
  EXPECT_EQ(exported(folder + "/b.ply", {"--export-frames", "2"}).exit_code, 0);
  EXPECT_TRUE(fs::exists(folder + "/b.ply")) << "one frame has the name that was given";
  EXPECT_EQ(test::lacking(exported(folder + "/c.ply", {"--export-frames", "2-2"}).out,
                          "written to " + folder + "/c_0002.ply\n"),
            "");
  EXPECT_TRUE(fs::exists(folder + "/c_0002.ply")) << "a range is numbered";
  EXPECT_EQ(exported(folder + "/all.abc", {}).exit_code, 0);
  EXPECT_EQ(exported(folder + "/some.abc", {"--export-frames", "1-5", "--export-every", "2"}).exit_code, 0);
  const std::string all = test::readAll(folder + "/all.abc"), some = test::readAll(folder + "/some.abc");
  const std::vector<double> times = app::alembicTimes(some, "some.abc");
  ASSERT_EQ(times.size(), 3u);
  EXPECT_NEAR(times[0], 1.0 / 60, 1e-9);
  EXPECT_NEAR(times[2], 5.0 / 60, 1e-9);
  for (std::size_t n = 0; n < 3; ++n)
    EXPECT_EQ(app::readAlembic(some, "", n).points, app::readAlembic(all, "", 2 * n + 1).points);
}

// A run in two parts has the numbers, the times and the strands of one.
TEST(HairExport, ARunThatGoesOnNumbersItsFramesOn) {
  const std::string folder = test::freshFolder("hair_export_resumed"), state = folder + "/state";
  EXPECT_EQ(exported(folder + "/one.usda", {"--export-frames", "4-5"}).exit_code, 0);
  EXPECT_EQ(exported(folder + "/half.hair", {"--save-state", state}, 4).exit_code, 0);
  for (const char* ending : {"hair", "usda", "abc", "glb"}) {
    const test::Outcome outcome =
        exported(folder + "/half." + ending, {"--load-state", state, "--report", folder + "/report.json"}, 2);
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  }
  for (int frame = 0; frame < 6; ++frame)
    EXPECT_TRUE(fs::exists(folder + "/half_000" + std::to_string(frame) + ".hair")) << frame;
  const std::string text = test::readAll(folder + "/half.usda"), one = test::readAll(folder + "/one.usda");
  EXPECT_EQ(test::lacking(text.substr(0, 400), "startTimeCode = 4\n    endTimeCode = 5"), "");
  EXPECT_EQ(app::readUsda(text, "", 1).points, app::readUsda(one, "", 1).points);
  EXPECT_NEAR(app::alembicTimes(test::readAll(folder + "/half.abc"), "")[1], 5.0 / 60, 1e-9);
  EXPECT_EQ(test::lacking(test::readAll(folder + "/report.json"), "\"frame\": 4"), "");
  EXPECT_EQ(test::lacking(test::readAll(folder + "/half.glb"), "\"min\":[0.0666666"), "");
  const std::vector<std::string> second{"--load-state", state, "--export-frames", "5"};
  EXPECT_EQ(exported(folder + "/five.ply", second, 2).exit_code, 0);
  EXPECT_EQ(app::readGroom(folder + "/five.ply").points, app::readUsda(one, "", 1).points);
  EXPECT_EQ(test::lacking(exported(folder + "/six.ply", second, 1).err, "the run's 1 frame, 4 to 4"), "");
}

// Times are those of the frames' numbers at the run's rate, in every format.
TEST(HairExport, FramesThatAreLeftOutLeaveTheTimesOfTheOthers) {
  const std::string folder = test::freshFolder("hair_export_every");
  for (const char* ending : {"usda", "abc", "glb"})
    EXPECT_EQ(exported(folder + "/e." + ending, {"--export-frames", "2-8", "--export-every", "3"}, 9).exit_code, 0);
  const std::string text = test::readAll(folder + "/e.usda"), mesh = test::readAll(folder + "/e.glb");
  EXPECT_EQ(test::lacking(text.substr(0, 400), "timeCodesPerSecond = 60"), "");
  EXPECT_EQ(test::lacking(text.substr(0, 400), "startTimeCode = 2\n    endTimeCode = 8"), "");
  EXPECT_NE(text.find("\n            5: ["), std::string::npos);
  EXPECT_EQ(test::lacking(mesh, "\"max\":[0.1333333"), "");
  EXPECT_EQ(test::lacking(mesh, "\"min\":[0.0333333"), "");
  const std::vector<double> times = app::alembicTimes(test::readAll(folder + "/e.abc"), "");
  ASSERT_EQ(times.size(), 3u);
  for (std::size_t n = 0; n < 3; ++n) {
    EXPECT_NEAR(times[n], (2.0 + 3.0 * static_cast<double>(n)) / 60, 1e-9);
    EXPECT_NEAR(app::usdaTimes(text, "")[n], times[n], 1e-12);
  }
}

TEST(HairExport, MotionBlurSamplesLieBetweenTheFrames) {
  const std::string folder = test::freshFolder("hair_export_blur");
  const std::string report = folder + "/report.json";
  const std::vector<std::string> moments{"--export-samples", "3", "--export-shutter", "0.5", "--report", report};
  EXPECT_EQ(exported(folder + "/blur.abc", moments, 4).exit_code, 0);
  int steps = 0;
  const nlohmann::json read = nlohmann::json::parse(test::readAll(report));
  for (const auto& frame : read.at("frames")) steps += frame.at("counts").at("steps").get<int>();
  EXPECT_GE(steps, 3) << "those of a frame's further moments are counted";
  EXPECT_EQ(exported(folder + "/plain.abc", {}, 4).exit_code, 0);
  const std::string blur = test::readAll(folder + "/blur.abc"), plain = test::readAll(folder + "/plain.abc");
  const std::vector<double> times = app::alembicTimes(blur, "blur.abc");
  ASSERT_EQ(times.size(), 12u);
  EXPECT_NEAR(times[4], 1.25 / 60, 1e-9);
  const auto distance = [](const app::Groom& a, const app::Groom& b) {
    float sum = 0;
    for (std::size_t p = 0; p < a.points.size(); ++p) sum += (a.points[p] - b.points[p]).norm();
    return sum / static_cast<float>(a.points.size());
  };
  for (std::size_t frame = 1; frame < 3; ++frame) {
    const app::Groom here = app::readAlembic(plain, "", frame), next = app::readAlembic(plain, "", frame + 1);
    const float step = distance(here, next);
    EXPECT_LT(distance(app::readAlembic(blur, "", 3 * frame), here), 0.02f * step) << "frames are where they were";
    EXPECT_NEAR(distance(app::readAlembic(blur, "", 3 * frame + 2), here), 0.5f * step, 0.2f * step);
  }
}

TEST(HairExport, GuidesAreTheColumnsAndTheUnitIsTheFiles) {
  const std::string folder = test::freshFolder("hair_export_guides");
  EXPECT_EQ(exported(folder + "/m.abc", {"--export-what", "guides"}, 1).exit_code, 0);
  EXPECT_EQ(exported(folder + "/cm.usda", {"--export-what", "guides", "--export-unit", "cm"}, 1).exit_code, 0);
  const app::Groom metres = app::readGroom(folder + "/m.abc");
  app::GroomHints hints;
  const app::Groom centimetres = app::readGroom(folder + "/cm.usda", &hints);
  EXPECT_EQ(hints.meters_per_unit, 0.01);
  ASSERT_EQ(metres.points.size(), centimetres.points.size());
  for (std::size_t p = 0; p < metres.points.size(); ++p)
    EXPECT_LT((100 * metres.points[p] - centimetres.points[p]).norm(), 1e-4f);
  EXPECT_EQ(metres.guides, std::vector<std::uint8_t>(metres.strandCount(), 1));
  EXPECT_LT(metres.strandCount(), 200u);
}

TEST(HairExport, TheCageIsAMeshWithMorphTargets) {
  const std::string folder = test::freshFolder("hair_export_cage");
  EXPECT_EQ(exported(folder + "/cage.glb", {}).exit_code, 0);
  EXPECT_EQ(exported(folder + "/columns.abc", {"--export-what", "guides"}).exit_code, 0);
  const std::string second = test::secondReading(folder + "/cage.glb");
  const std::string bytes = test::readAll(folder + "/columns.abc");
  std::vector<double> times(6);
  std::uint64_t length = 0;
  ASSERT_GT(second.size(), 8u + 6 * 8);
  std::memcpy(&length, second.data(), sizeof length);
  ASSERT_EQ(length, 6 * sizeof(double)) << second.substr(0, 500);
  // The vertices of the cage are those of the columns, one after another.
  std::size_t at = 8 + length;
  for (std::size_t frame = 0; frame < 6; ++frame) {
    const app::Groom columns = app::readAlembic(bytes, "", frame);
    at += 8 + 8;  // the first vertices of the one strand
    std::memcpy(&length, second.data() + at, sizeof length);
    ASSERT_EQ(length, columns.points.size() * 12);
    for (std::size_t v = 0; v < columns.points.size(); ++v) {
      Eigen::Vector3f vertex;
      std::memcpy(vertex.data(), second.data() + at + 8 + 12 * v, 12);
      ASSERT_LT((vertex - columns.points[v]).norm(), 1e-6f);
    }
    at += 8 + length + 6 * 8;
  }
}

// Cards face outwards, lie flat on the head, reach from the scalp to the tips, and leave no root face without one.
TEST(HairExport, CardsLieOverTheHeadAndFaceOutwards) {
  for (const app::Style style : {app::Style::kLong, app::Style::kBob, app::Style::kPixie}) {
    app::Scene scene = test::smallScene("idle_turns.bvh");
    scene.characters[0].style = style;
    scene.characters.push_back(scene.characters[0]);
    const app::Demo demo = app::openScene(std::move(scene), 1.5);
    const app::CardMesh cards = app::cardsOf(demo);
    const sim::HairMeshShape& shape = demo.actors[0].haircut->mesh.shape;
    const auto vertices = static_cast<std::uint32_t>(shape.vertexCount());
    ASSERT_EQ(cards.vertices.size(), cards.coordinates.size());
    ASSERT_EQ(cards.count % 2, 0) << "both wear the same";
    EXPECT_GT(2 * shape.columnCount(), cards.count / 2);
    EXPECT_GT(cards.count / 2, shape.columnCount() / 2);
    const Eigen::Vector3d centre = demo.actors[0].body->character.scalp.center;
    const auto at = [&](std::uint32_t v) { return shape.positions[cards.vertices[v] % vertices]; };
    int outwards = 0, upper = 0;
    for (std::size_t t = 0; t < cards.triangles.size(); t += 3) {
      const std::uint32_t* k = &cards.triangles[t];
      if (cards.coordinates[k[0]].y() > 0.5f) continue;  // tips hang free
      ++upper;
      outwards += (at(k[1]) - at(k[0])).cross(at(k[2]) - at(k[0])).dot(at(k[0]) - centre) > 0;
    }
    EXPECT_GT(outwards, 0.97 * upper);
    std::set<std::uint32_t> rooted;  // columns' roots that a card has
    for (std::size_t v = 0; v < cards.vertices.size(); ++v) {
      if (cards.coordinates[v].y() == 0) rooted.insert(cards.vertices[v] % vertices);
    }
    for (const sim::RootFace& face : shape.root_faces) {
      int with = 0;
      for (int c = 0; c < face.corner_count; ++c)
        with += rooted.contains(static_cast<std::uint32_t>(
            shape.column_first[static_cast<std::size_t>(face.columns[static_cast<std::size_t>(c)])]));
      EXPECT_GE(with, 2);
    }
  }
}

TEST(HairExport, CardsAreReadAgainAsStrips) {
  const std::string folder = test::freshFolder("hair_export_cards");
  const test::Outcome outcome = exported(folder + "/cards.glb", {"--export-what", "cards"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(test::lacking(outcome.out, "cards, written to"), "");
  EXPECT_EQ(test::lacking(test::readAll(folder + "/cards.glb"), "\"doubleSided\":true"), "");
  EXPECT_GT(test::secondReading(folder + "/cards.glb").size(), 1000u);
  const app::PolygonMesh mesh = app::readPolygons(folder + "/cards.glb");
  EXPECT_GT(mesh.positions.size(), 100u);
}

// glTF has no unit but the metre.
TEST(HairExport, TheMeshOfAGlbIsInMetres) {
  const std::string folder = test::freshFolder("hair_export_glb_unit");
  EXPECT_EQ(exported(folder + "/m.glb", {}, 1).exit_code, 0);
  const test::Outcome outcome = exported(folder + "/cm.glb", {"--export-unit", "cm"}, 1);
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_EQ(test::lacking(outcome.out, "1 frame, in metres: glTF has no other unit, written to"), "");
  EXPECT_EQ(test::readAll(folder + "/m.glb"), test::readAll(folder + "/cm.glb"));
}

TEST(HairExport, AFullDiskLeavesNothingHalfWritten) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "there is no /dev/full";
  const std::string folder = test::freshFolder("hair_export_full");
  for (const char* ending : {"abc", "usda", "hair", "glb"}) {
    const std::string file = folder + "/full." + ending;
    fs::create_symlink("/dev/full", file);
    const test::Outcome outcome = exported(file, {}, 1);
    EXPECT_EQ(outcome.exit_code, 1) << ending;
    EXPECT_EQ(test::lacking(outcome.err, "cannot be written: No space left on device; make room"), "");
    fs::remove(file);
  }
  EXPECT_TRUE(fs::is_empty(folder));
  EXPECT_EQ(exported(folder + "/none/a.abc", {}, 1).exit_code, 1);
}

TEST(HairExport, WithoutAFrameTheFileThatWasThereStays) {
  const std::string folder = test::freshFolder("hair_export_none");
  app::Scene scene;
  scene.characters.resize(1);
  scene.characters[0].motion = app::dataPath("assets/clips/walk.bvh");
  scene.characters[0].resolution = app::Resolution::kLow;
  const app::Demo demo = app::openScene(scene, 1);
  for (const char* ending : {".abc", ".usda", ".hair", ".ply", ".glb"}) {
    const std::string file = folder + "/a" + ending;
    std::ofstream(file) << "before";
    app::ExportSpec spec;
    spec.file = file;
    if (file.ends_with(".glb")) spec.what = app::ExportWhat::kMesh;
    const std::string said = app::HairExport(spec, demo, 60, 0, 10).finish(demo);
    EXPECT_EQ(said, "no frame to export; " + file + " is as it was\n");
    EXPECT_EQ(test::readAll(file), "before");
  }
  EXPECT_EQ(std::distance(fs::directory_iterator(folder), fs::directory_iterator()), 5) << "something is left beside";
}

TEST(HairExport, WhatCannotBeAskedForIsNamed) {
  const auto fault = [](std::vector<std::string> arguments) {
    const test::Outcome outcome = test::runProgram(arguments);
    EXPECT_EQ(outcome.exit_code, 2) << outcome.err;
    return outcome.err;
  };
  EXPECT_EQ(test::lacking(fault({"--export", "a.fbx"}), "name it .abc, .usda, .hair, .ply, .tfx or .glb"), "");
  EXPECT_EQ(test::lacking(fault({"--export-what", "guides"}), "add --export FILE"), "");
  EXPECT_EQ(test::lacking(fault({"--export", "a.glb", "--export-what", "strands"}), "glTF has no curves"), "");
  EXPECT_EQ(test::lacking(fault({"--export", "a.ply", "--export-samples", "3"}), "takes a clip"), "");
  EXPECT_EQ(test::lacking(fault({"--export", "a.abc", "--export-shutter", "0.3"}), "add --export-samples 3"), "");
  EXPECT_EQ(test::lacking(fault({"--export", "a.tfx", "--export-points", "10"}), "give 4, 8, 16, 32 or 64"), "");
  EXPECT_EQ(test::lacking(fault({"--export", "a.abc", "--export-frames", "9-3"}), "FIRST-LAST"), "");
  EXPECT_EQ(test::lacking(fault({"--frames", "3", "--export", "a.abc", "--export-frames", "1-9"}),
                          "the run's 3 frames, 0 to 2"),
            "");
  EXPECT_EQ(test::lacking(fault({"--frames", "1", "--strands", "0", "--export", "a.abc"}), "more than 0 --strands"),
            "");
  EXPECT_FALSE(fs::exists("a.abc"));
  EXPECT_EQ(test::lacking(fault({"--export", "a.abc", "--record", "a.abc"}), "name two"), "");
}

// What the program has written is no groom with faults, whatever the pose, the unit and the number of figures.
TEST(HairExport, TheInspectorFindsNoFaultInWhatIsExported) {
  const std::string folder = test::freshFolder("export_inspected");
  const app::HeadModel head = app::headModelOf(app::loadCharacter(app::dataPath("assets/clips/idle_turns.bvh")));
  const std::vector<std::vector<std::string>> runs{{"--motion", "walk.bvh", "--export-unit", "cm"},
                                                   {"--motion", "head_shake.bvh", "--export-unit", "mm"},
                                                   {"--motion", "jump_spin.bvh", "--style", "long"},
                                                   {"pony_tail.json", "--export-unit", "in"},
                                                   {"trio.json"},
                                                   {"--motion", "idle_turns.bvh", "--style", "bob"}};
  const std::vector<std::string> endings{"abc", "usda", "hair", "ply", "tfx"};  // two of a run, each in two runs
  for (std::size_t r = 0; r < runs.size(); ++r) {
    for (const std::size_t format : {r, r + 2}) {
      const std::string file = folder + "/" + std::to_string(r) + "." + endings[format % endings.size()];
      std::vector<std::string> words{"--no-images",     "--strands", "400",      "--frames", "31",
                                     "--export-frames", "30",        "--export", file};
      words.insert(words.end(), runs[r].begin(), runs[r].end());
      ASSERT_EQ(test::runProgram(words).exit_code, 0) << file;
      app::GroomHints hints;
      const app::Groom groom = app::readGroom(file, &hints);
      EXPECT_EQ(hints.world_heads, r == 4 ? 3 : 1) << file;
      // Another program leaves out what the file says of itself: one head that stands at its height is no fault.
      if (r == 5) {
        hints = {};
        EXPECT_TRUE(std::ranges::none_of(app::inspectGroom(groom, hints, &head).findings, &app::GroomFinding::fault));
      }
      const app::GroomInspection inspection = app::inspectGroom(groom, hints, &head);
      bool placed = false;
      for (const app::GroomFinding& finding : inspection.findings) {
        EXPECT_FALSE(finding.fault) << file << ": " << finding.what << ": " << finding.text;
        placed = placed || (finding.what == "roots" && finding.certain);
      }
      EXPECT_EQ(placed, r != 4) << file << ": where its head is, is told for --hair";
    }
  }
}

}  // namespace hair_export_test
