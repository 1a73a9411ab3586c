// The mends that are certain, done where a groom becomes a hair mesh, and the wishes that overrule them.
#include "app/groom/inspect/certain_mends.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "app/groom/convert.h"
#include "app/groom/groom_writer.h"
#include "tests/app/groom/combed_groom.h"
#include "tests/app/groom/groom_samples.h"
#include "tests/run_program.h"

namespace certain_mends_test {

using namespace combed;

// What a person says of the unit is taken, whatever the hair looks like.
TEST(CertainMends, TheConverterTakesTheUnitThatIsGiven) {
  const std::string folder = test::freshFolder("convert_unit"), in = folder + "/cm.hair";
  app::Groom groom = combedGroom(300, 5);
  moveAll(groom, Eigen::Matrix3f::Identity(), 100, Vector3f::Zero());
  app::writeGroom(groom, in);
  const std::string binary = std::filesystem::path(HAIRMESH_BINARY).parent_path().string() + "/hairmesh-convert";
  const auto said = [&](const std::string& unit, int expected) {
    const std::string command = test::shellQuoted(binary) + " " + test::shellQuoted(in) + " " +
                                test::shellQuoted(folder + "/out.obj") + " --vertices 400 --unit " + unit + " >" +
                                test::shellQuoted(folder + "/said") + " 2>&1";
    const int status = std::system(command.c_str());
    EXPECT_EQ(WIFEXITED(status) ? WEXITSTATUS(status) : -1, expected) << unit << test::readAll(folder + "/said");
    return test::readAll(folder + "/said");
  };
  EXPECT_EQ(test::lacking(said("cm", 0), " strands in units of 0.01 m"), "");
  const std::string half = said("0.005", 0);
  EXPECT_EQ(test::lacking(half, " strands in units of 0.005 m"), "");
  EXPECT_EQ(half.find("the file tells"), std::string::npos) << half;
  EXPECT_EQ(test::lacking(said("furlong", 2), "'furlong' is no unit; give m, cm, mm, in or ft"), "");
}

TEST(CertainMends, BringAGroomBackBeforeItBecomesAHairMesh) {
  for (std::uint32_t seed = 1; seed <= 4; ++seed) {
    const app::Groom clean = combedGroom(300, seed);
    app::Groom groom = clean;
    moveAll(groom, turnOf("z"), 100, Vector3f::Zero());
    for (std::size_t s = 0; s < groom.strandCount(); ++s)
      std::reverse(groom.points.begin() + groom.strand_first[s], groom.points.begin() + groom.strand_first[s + 1]);
    const app::HeadModel model = head();
    const app::MendReport report = app::mendCertain({}, &model, "", groom);
    EXPECT_TRUE(report.unit_known);
    EXPECT_GE(report.findings.size(), 3u);
    for (const app::MendedFinding& one : report.findings) EXPECT_TRUE(one.done) << one.finding.what;
    EXPECT_EQ(test::lacking(app::mendText(report), "mended        unit: "), "");
    ASSERT_EQ(groom.points.size(), clean.points.size());
    float far = 0;
    for (std::size_t p = 0; p < groom.points.size(); ++p)
      far = std::max(far, (groom.points[p] - clean.points[p]).norm());
    EXPECT_LT(far, 1e-4f) << seed;
  }
}

TEST(CertainMends, AreOverruledByWishes) {
  app::Groom groom = combedGroom(300, 5);
  const std::vector<Vector3f> clean = groom.points;
  moveAll(groom, turnOf("z"), 100, Vector3f::Zero());
  const app::Groom given = groom;
  const app::HeadModel model = head();
  EXPECT_FALSE(app::mendCertain({}, &model, "--no-guess", groom).unit_known);
  EXPECT_EQ(groom.points, given.points) << "nothing was asked for";
  const app::MendReport report = app::mendCertain({}, &model, "--no-guess --unit cm --up z", groom);
  EXPECT_TRUE(report.unit_known);
  EXPECT_LT((groom.points.back() - clean.back()).norm(), 1e-4f);
  app::ConvertOptions options;
  options.unit = 1, options.file_unit = report.unit;
  EXPECT_EQ(app::convertGroom(groom, {}, options, "").unit, "units of 0.01 m") << "the file's unit is told";
  app::GroomMends mends;
  for (const char* wrong : {"--unit parsec", "--up", "up z", "--points 1", "--move 1,2", "--width -1"})
    EXPECT_EQ(test::lacking(app::readMends(wrong, mends), "is no mend; "), "") << wrong;
  EXPECT_EQ(app::readMends("--move 0,0.1,-0.2  --push-out --drop-far 0.03 --turn 90", mends), "");
  EXPECT_TRUE(mends.push_out);
  EXPECT_EQ(mends.move, Vector3f(0, 0.1f, -0.2f));
}

TEST(CertainMends, LeaveAMohawkUprightAndABeardOnTheChin) {
  const app::HeadModel model = head();
  for (const bool beard : {false, true}) {
    const app::Groom clean = strip(beard);
    app::Groom groom = clean;
    const app::MendReport report = app::mendCertain({}, &model, "", groom);
    EXPECT_TRUE(report.on_head) << app::mendText(report);
    ASSERT_EQ(groom.points.size(), clean.points.size());
    float far = 0;
    for (std::size_t p = 0; p < groom.points.size(); ++p)
      far = std::max(far, (groom.points[p] - clean.points[p]).norm());
    EXPECT_LT(far, 0.02f) << (beard ? "beard: " : "mohawk: ") << app::mendText(report);
  }
}

// Hair on the face's skin stays, told so; where the figure stands in its world it comes along with the head, in the
// unit in which it lies on the skin.
TEST(CertainMends, ABeardStaysOnTheFaceThatItGrowsOn) {
  app::HeadModel model = head();
  model.standing = model.center + Vector3f(0, 1.49f, -0.015f);
  const app::Groom clean = strip(true);
  for (const bool in_world : {false, true}) {
    for (const float scale : {1.0f, 100.0f}) {
      app::Groom groom = clean;
      moveAll(groom, Eigen::Matrix3f::Identity(), scale,
              in_world ? Vector3f(scale * Vector3f(0, 1.49f, -0.015f)) : Vector3f::Zero());
      const app::MendReport report = app::mendCertain({}, &model, "", groom);
      const std::string said = app::mendText(report);
      EXPECT_NE(said.find("the hair grows on the face, as a beard does"), std::string::npos) << said;
      EXPECT_TRUE(report.on_head && report.unit_known) << said;
      EXPECT_EQ(std::ranges::count_if(report.findings, [](const auto& one) { return one.finding.fault; }),
                scale == 1 ? 0 : 1)
          << said;
      float far = 0;
      for (std::size_t p = 0; p < groom.points.size(); ++p)
        far = std::max(far, (groom.points[p] - clean.points[p]).norm());
      EXPECT_LT(far, 0.001f) << said;
    }
  }
}

// The place is sought for the axes that were given.
TEST(CertainMends, PlaceTheHairForTheAxesThatWereGiven) {
  const app::HeadModel model = head();
  const app::Groom clean = combedGroom(300, 5);
  app::Groom groom = clean;
  moveAll(groom, turnOf("z"), 1, Vector3f(0, 0, 0.4f));
  const app::MendReport report = app::mendCertain({}, &model, "--up z", groom);
  EXPECT_TRUE(report.on_head) << app::mendText(report);
  EXPECT_LT((groom.points[0] - clean.points[0]).norm(), 0.02f) << app::mendText(report);
}

// Hair of a smaller or larger head, about the neck's place or in the world, comes to the figure's size and place; hair
// of its size stays as large as it is.
TEST(CertainMends, HairOfAnotherHeadIsScaledToTheFigures) {
  const app::HeadModel model = head();
  for (const float scale : {0.6f, 0.8f, 1.0f, 1.25f}) {
    for (const Vector3f& place : {Vector3f(0, -0.09f, 0), Vector3f(0.3f, 1.2f, 0.1f)}) {
      const app::Groom clean = combedGroom(400, 5);
      app::Groom groom = clean;
      moveAll(groom, Eigen::Matrix3f::Identity(), scale, place);
      const app::MendReport report = app::mendCertain({}, &model, "", groom);
      const std::string said = app::mendText(report);
      EXPECT_TRUE(report.on_head) << scale << ": " << said;
      EXPECT_EQ(said.find("times as large as the figure's") != std::string::npos, scale != 1) << scale << ": " << said;
      EXPECT_LT((groom.points[0] - clean.points[0]).norm(), 0.012f) << scale << ": " << said;
      const float length = (groom.points[7] - groom.points[0]).norm() / (clean.points[7] - clean.points[0]).norm();
      EXPECT_NEAR(length, 1, 0.08) << scale << ": " << said;
    }
  }
}

}  // namespace certain_mends_test
