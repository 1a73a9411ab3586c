// USD curves: what is written comes back in the same bits, by the program's reader and by one in Python; what other
// programs write of the grammar is read too.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>

#include "app/files/errors.h"
#include "app/groom/formats/usda_file.h"
#include "app/groom/groom_file.h"
#include "app/groom/inspect/groom_inspect.h"
#include "tests/app/groom/groom_samples.h"
#include "tests/app/groom/second_reader.h"

namespace usda_test {

std::vector<app::Groom> swaying(app::Groom groom, std::size_t moments) {
  std::vector<app::Groom> clip;
  for (std::size_t n = 0; n < moments; ++n) {
    for (Eigen::Vector3f& point : groom.points) point.x() += 0.001f * point.y();
    clip.push_back(groom);
  }
  return clip;
}

std::string writtenFile(const std::vector<app::Groom>& clip, const app::ClipSettings& settings) {
  const std::string file = test::freshFolder("usda") + "/groom.usda";
  app::UsdaWriter writer(file, settings);
  for (const app::Groom& groom : clip) writer.add(groom);
  writer.finish();
  return file;
}

void expectTheSame(const std::vector<app::Groom>& clip, const app::ClipSettings& settings) {
  const std::string file = writtenFile(clip, settings), text = test::readAll(file);
  const std::vector<double> times = app::usdaTimes(text, file);
  ASSERT_EQ(times.size(), clip.size());
  std::vector<app::Groom> read;
  for (std::size_t n = 0; n < clip.size(); ++n) {
    read.push_back(app::readUsda(text, file, n));
    EXPECT_NEAR(times[n], settings.timeOf(n), 1e-12);
  }
  EXPECT_TRUE(test::dumpClip({}, read) == test::dumpClip({}, clip)) << "read back differently";
  const std::string second = test::secondReading(file);
  EXPECT_TRUE(second.substr(8 * (clip.size() + 1)) == test::dumpClip({}, clip).substr(8)) << second.substr(0, 2000);
}

TEST(Usda, AClipComesBackInTheSameBitsByBothReaders) {
  expectTheSame(swaying(test::sampleGroom(40, 41), 5), {30, 15, {0}, 1, 0, 3});
  expectTheSame(swaying(test::sampleGroom(7, 42), 12), {24, 0, {-0.01, 0, 0.01}, 0.01});
  expectTheSame({test::sampleGroom(20, 43)}, {});
}

// tinyusdz writes numbers with eight digits, and its attributes in an order of its own.
TEST(Usda, TinyusdzReadsTheSameStrands) {
  const char* given = std::getenv("HAIRMESH_NODE");
  const std::string folder = given ? given : std::string(HAIRMESH_SOURCE_DIR) + "/build/node";
  const std::vector<app::Groom> clip = swaying(test::sampleGroom(40, 45), 3);
  const std::string file = writtenFile(clip, {30, 0, {0}, 1}), out = file + ".again";
  const std::string command = "node " +
                              test::shellQuoted(std::string(HAIRMESH_SOURCE_DIR) + "/tests/groom/tinyusdz.mjs") + " " +
                              test::shellQuoted(folder) + " " + test::shellQuoted(file) + " " + test::shellQuoted(out);
  const int status = std::system(command.c_str());
  const int code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  if (code == 77 || code == 127)
    GTEST_SKIP() << "tinyusdz is not there; npm install --prefix build/node tinyusdz@0.9.0-rc10 brings it";
  ASSERT_EQ(code, 0);
  const std::string text = test::readAll(out);
  EXPECT_EQ(app::usdaTimes(text, out).size(), clip.size());
  for (std::size_t n = 0; n < clip.size(); ++n) {
    const app::Groom read = app::readUsda(text, out, n);
    EXPECT_EQ(read.strand_first, clip[n].strand_first);
    EXPECT_EQ(read.ids, clip[n].ids);
    ASSERT_EQ(read.points.size(), clip[n].points.size());
    ASSERT_EQ(read.widths.size(), clip[n].widths.size());
    for (std::size_t p = 0; p < read.points.size(); ++p) {
      EXPECT_LT((read.points[p] - clip[n].points[p]).norm(), 1e-6f);
      EXPECT_NEAR(read.widths[p], clip[n].widths[p], 1e-11f);
    }
  }
}

TEST(Usda, UnitAndAxisAreHanded) {
  app::GroomHints hints;
  app::readGroom(writtenFile({test::sampleGroom(2, 44)}, {24, 0, {0}, 0.01}), &hints);
  EXPECT_EQ(hints.meters_per_unit, 0.01);
  EXPECT_EQ(hints.up, 'Y');
}

const char* const kForeign = R"(#usda 1.0
(
    "made by hand"
    customLayerData = { string creator = "x } y" }
    upAxis = "Z"
    subLayers = [ @./a.usda@ ]
)
def Xform "root" ( kind = "group" )
{
    double3 xformOp:translate = (0, 0, 10)
    float3 xformOp:scale = (2, 2, 2)
    uniform token[] xformOpOrder = ["xformOp:translate", "xformOp:scale"]
    token visibility
    rel material:binding = </mat>
    # a comment with { a brace
    def BasisCurves "bezier" (
        prepend apiSchemas = ["MaterialBindingAPI"]
    )
    {
        custom string note = """several
lines } """
        point3f[] points = [(0,0,0),(0,0,1),(0,0,2),(0,0,3), (1,0,0),(1,0,1),(1,0,2),(1,0,3)]
        int[] curveVertexCounts = [4, 4]
        float[] widths = [0.5] ( interpolation = "constant" )
        color3f[] primvars:displayColor = [(1,0,0), (0,1,0)] ( interpolation = "uniform" )
        int[] primvars:displayColor:indices = [1, 0]
    }
    def "untyped" { }
    def BasisCurves "linear" { uniform token type = "linear"
        int[] curveVertexCounts = [2]
        point3f[] points.timeSamples = { 1: [(0,0,0),(1,0,0)], 2.5: [(0,0,0),(2,0,0)], }
        texCoord2f[] primvars:st = [(0.25, 0.75)] (interpolation = "uniform") }
}
)";

TEST(Usda, WhatOtherProgramsWriteIsRead) {
  const app::Groom groom = app::readGroom(kForeign, "hand.usda");
  EXPECT_EQ(groom.strand_first, (std::vector<std::uint32_t>{0, 2, 4, 6}));
  EXPECT_EQ(groom.points[1], Eigen::Vector3f(0, 0, 16));
  EXPECT_EQ(groom.points[5], Eigen::Vector3f(2, 0, 10));
  EXPECT_EQ(groom.widths, (std::vector<float>{0.5f, 0.5f, 0.5f, 0.5f, 0, 0}));
  EXPECT_EQ(groom.colors[0], Eigen::Vector3f(0, 1, 0));
  EXPECT_EQ(groom.root_uvs[2], Eigen::Vector2f(0.25f, 0.75f));
  EXPECT_EQ(groom.groups, (std::vector<std::int32_t>{0, 0, 1}));
  EXPECT_EQ(app::readUsda(kForeign, "hand.usda", 1).points[5], Eigen::Vector3f(4, 0, 10));
  EXPECT_EQ(app::usdaTimes(kForeign, "hand.usda"), (std::vector<double>{1.0 / 24, 2.5 / 24}));
  EXPECT_EQ(app::readGroom(std::string("\xEF\xBB\xBF") + kForeign, "hand.usda").points, groom.points);
}

// A unit of nought or below is none.
TEST(Usda, AUnitThatCannotBeIsNotTold) {
  for (const char* unit : {"0", "-1"}) {
    std::string text = test::readAll(writtenFile({test::sampleGroom(2, 44)}, {24, 0, {0}, 0.01}));
    const std::string told = "metersPerUnit = 0.01";
    ASSERT_NE(text.find(told), std::string::npos);
    text.replace(text.find(told), told.size(), std::string("metersPerUnit = ") + unit);
    app::GroomHints hints;
    app::readUsda(text, "unit.usda", 0, &hints);
    EXPECT_FALSE(hints.meters_per_unit) << unit;
  }
}

TEST(Usda, CurvesThatTheFileHidesAreLeftOut) {
  const auto curves = [](const std::string& name, const std::string& hidden) {
    return "def BasisCurves \"" + name + "\" { " + hidden +
           " uniform token type = \"linear\"\n int[] curveVertexCounts = [2]\n"
           " point3f[] points = [(0,0,0),(1,0,0)] }\n";
  };
  const std::string invisible = "token visibility = \"invisible\"\n", guide = "uniform token purpose = \"guide\"\n";
  const std::string text = "#usda 1.0\n" + curves("seen", "token visibility = \"inherited\"\n") +
                           curves("unseen", invisible) + curves("guide", guide) +
                           curves("proxy", "uniform token purpose = \"proxy\"\n") + "def Xform \"a\" { " + invisible +
                           curves("below", "") + "}\ndef Xform \"b\" { " + guide + curves("low", "") +
                           curves("render", "uniform token purpose = \"render\"\n") + "}\n";
  app::GroomHints hints;
  EXPECT_EQ(app::readGroom(text, "hidden.usda", &hints).strandCount(), 2u);
  EXPECT_EQ(hints.hidden, 5);
  const app::GroomInspection inspection = app::inspectGroom(app::readGroom(text, ""), hints, nullptr);
  ASSERT_TRUE(inspection.find("hidden"));
  EXPECT_EQ(test::lacking(inspection.find("hidden")->text, "5 objects of curves that the file does not show"), "");
  EXPECT_FALSE(inspection.find("hidden")->fault);
  try {
    app::readGroom("#usda 1.0\n" + curves("unseen", invisible), "none.usda");
    ADD_FAILURE() << "nothing is left to read";
  } catch (const app::InputError& error) {
    EXPECT_EQ(test::lacking(error.what(), "all its BasisCurves are invisible"), "");
  }
}

TEST(Usda, FaultsNameTheirLine) {
  const auto fault = [](std::string text, const std::string& from, const std::string& to) -> std::string {
    text.replace(text.find(from), from.size(), to);
    try {
      app::readGroom(text, "hand.usda");
    } catch (const app::InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(test::lacking(fault(kForeign, "(0,0,1)", "(0,0,x)"), "hand.usda: line 22: 'x)"), "");
  EXPECT_EQ(test::lacking(fault(kForeign, "[4, 4]", "[4, 5]"), "curveVertexCounts reach beyond"), "");
  EXPECT_EQ(test::lacking(fault(kForeign, "[0.5]", "[0.5, 1, 2]"), "widths has 3 values for 2 curves"), "");
  EXPECT_EQ(test::lacking(fault(kForeign, "(0.25, 0.75)]", "(0.25, 0.75)"), "line 34: an attribute or a prim"), "");
  const std::string whole = kForeign;
  EXPECT_EQ(test::lacking(fault(whole, "xformOp:scale\"", "xformOp:shear\""), "'xformOp:shear' is not read"), "");
}

}  // namespace usda_test
