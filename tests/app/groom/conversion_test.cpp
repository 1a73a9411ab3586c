// Grooms of ten kinds to hair meshes: strands that grow from these come back to those that were given.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <sstream>

#include "app/files/errors.h"
#include "app/files/hair_file.h"
#include "app/groom/convert.h"
#include "app/groom/fit/root_mesh.h"
#include "tests/app/groom/combed_groom.h"
#include "tests/groom_kinds.h"

namespace app {
namespace conversion_test {

constexpr int kStrands = 1000, kVertices = 1000;

class ConversionOfAKind : public testing::TestWithParam<groom_kinds::Kind> {};

TEST_P(ConversionOfAKind, StrandsComeBackWithinTheKindsBounds) {
  const groom_kinds::Kind& kind = GetParam();
  ConvertOptions options;
  options.silhouettes = true;
  options.fit.vertices = kVertices;
  const Conversion conversion = convertGroom(kind.make(kStrands), {}, options, kind.name);
  const FitError& error = conversion.fit.error;
  EXPECT_LE(error.mean, kind.mean * error.strand_length) << conversionReport(conversion);
  EXPECT_LE(error.share95, kind.share95 * error.strand_length) << conversionReport(conversion);
  EXPECT_GE(conversion.silhouette_drawn, kind.silhouette);
  EXPECT_GE(conversion.silhouette, conversion.silhouette_drawn - 0.05) << "roots and lengths are those given";
  EXPECT_LE(conversion.shape.vertexCount(), kVertices);
  EXPECT_EQ(conversion.left_out, 0);
  if (kind.name != "two ways") {
    EXPECT_TRUE(conversion.look.columns.empty()) << "all places are alike: " << conversionReport(conversion);
  }
  // What is written is read back to the same bits, and is valid.
  const sim::HairMeshShape again = readHairMesh(writeHairMesh(conversion.shape), "again.obj");
  EXPECT_EQ(again.positions.size(), conversion.shape.positions.size());
}

INSTANTIATE_TEST_SUITE_P(Kinds, ConversionOfAKind, testing::ValuesIn(groom_kinds::kinds()), [](const auto& kind) {
  std::string name = kind.param.name;
  name.erase(std::remove(name.begin(), name.end(), ' '), name.end());
  return name;
});

// Strands lie closer to each other than valid prisms can: they grow beside the hair mesh that is simulated.
TEST(Conversion, StrandsGrowNearerToTheGroomThanItsMeshLies) {
  ConvertOptions options;
  options.fit.vertices = kVertices;
  const Groom groom = groom_kinds::parted(kStrands, 0.02f, 0.22f);
  Conversion conversion = convertGroom(groom, {}, options, "parted");
  ASSERT_EQ(conversion.shape.groom_offsets.size(), conversion.shape.positions.size());
  EXPECT_LT(conversion.fit.error.mean, 0.01 * conversion.fit.error.strand_length);
  const auto off = [&](const HairFit& fit) {
    const GrowthMap growth(fit.shape);
    std::vector<Eigen::Vector3f> grown(25), given(25);
    double sum = 0;
    for (std::size_t s = 0; s < groom.strandCount(); ++s) {
      growStrand(fit, growth, fit.strands[s], grown);
      resample(groom.strand(s), given);
      for (std::size_t k = 0; k < given.size(); ++k) sum += (grown[k] - given[k]).norm();
    }
    return sum / static_cast<double>(groom.strandCount() * given.size());
  };
  const double with = off(conversion.fit);
  for (sim::Vec3& offset : conversion.fit.shape.groom_offsets) offset.setZero();
  EXPECT_LT(with, 0.7 * off(conversion.fit)) << "m";
  sim::buildHairMesh(conversion.shape);
}

TEST(Conversion, KeepsToTheVerticesAskedFor) {
  const Groom groom = groom_kinds::cropped(kStrands);
  int before = 0;
  double error = 1;
  for (const int vertices : {150, 400, 1000}) {
    ConvertOptions options;
    options.fit.vertices = vertices;
    const Conversion conversion = convertGroom(groom, {}, options, "cropped");
    EXPECT_LE(conversion.shape.vertexCount(), vertices);
    EXPECT_GT(conversion.shape.vertexCount(), std::max(before, vertices / 2));
    EXPECT_LT(conversion.fit.error.mean, error) << "more vertices bring the strands nearer";
    before = conversion.shape.vertexCount();
    error = conversion.fit.error.mean;
  }
}

TEST(Conversion, FindsRadiusAndTurnsOfCurls) {
  ConvertOptions options;
  options.fit.vertices = 400;
  const Conversion conversion = convertGroom(groom_kinds::curly(kStrands, 0.003f, 6), {}, options, "curly");
  EXPECT_NEAR(conversion.look.all.curl_radius, 0.003, 0.0008);
  EXPECT_NEAR(conversion.look.all.curl_turns, 6, 0.8);
  const Conversion straight = convertGroom(groom_kinds::cropped(kStrands), {}, options, "straight");
  EXPECT_EQ(straight.look.all.curl_radius, 0);
}

// m, from root to tip, straight and along the strand: means over a groom.
std::pair<double, double> lengthsOf(const Groom& groom) {
  std::pair<double, double> mean;
  for (std::size_t s = 0; s < groom.strandCount(); ++s) {
    mean.first += (groom.strand(s).back() - groom.strand(s).front()).norm() / static_cast<double>(groom.strandCount());
    mean.second += lineLength(groom.strand(s)) / static_cast<double>(groom.strandCount());
  }
  return mean;
}

// Strands dealt out anew are as long as those given, where these curl and where they end early.
TEST(Conversion, StrandsComeBackAsLongAsTheyWere) {
  ConvertOptions options;
  options.fit.vertices = 400;
  render::HairLook early;
  early.offset = early.clump = early.frizz = early.flyaways = early.lock = early.wisp = early.drift = 0;
  early.root_spread = early.hairline = early.baby_hairs = 0;
  early.length_variation = 0.4f;
  const Groom uneven =
      growGroom(convertGroom(groom_kinds::cropped(kStrands), {}, options, "even").shape, early, kStrands, 33);
  for (const auto& [name, given] : {std::pair("wide curls", groom_kinds::curly(kStrands, 0.005f, 7)),
                                    {"narrow curls", groom_kinds::curly(kStrands, 0.003f, 10)},
                                    {"uneven", uneven}}) {
    const Conversion conversion = convertGroom(given, {}, options, name);
    render::HairLook look;
    takeLook(conversion.look, look);
    const auto [ends, along] = lengthsOf(given);
    const auto [ends_anew, along_anew] = lengthsOf(growGroom(conversion.shape, look, kStrands, 129));
    EXPECT_NEAR(ends_anew / ends, 1, 0.04) << name;
    EXPECT_NEAR(along_anew / along, 1, 0.07) << name;
  }
}

// The program's own clumps come back, of uneven strands, over what the hair mesh misses.
TEST(Conversion, FindsClumpsAndTheirSize) {
  ConvertOptions options;
  options.fit.vertices = 400;
  const sim::HairMeshShape head = convertGroom(groom_kinds::parted(kStrands, 0.02f, 0.22f), {}, options, "head").shape;
  render::HairLook look;
  look.lock = look.wisp = look.drift = look.root_spread = look.hairline = look.baby_hairs = look.flyaways = 0;
  for (const auto& [clump, size] : {std::pair(0.1f, 0.012f), {0.5f, 0.012f}, {0.9f, 0.006f}}) {
    look.clump = clump;
    look.clump_size = size;
    const Conversion conversion = convertGroom(growGroom(head, look, 6000, 33), {}, options, "clumps");
    // Hair that hardly closes is hard to tell from its own wander.
    EXPECT_NEAR(conversion.look.all.clump, clump, clump > 0.4f ? 0.12 : 0.22) << conversionReport(conversion);
    if (clump > 0.4f) EXPECT_NEAR(conversion.look.all.clump_size / size, 1, 0.3) << conversionReport(conversion);
  }
}

TEST(Conversion, SaysWhichStrandsGoAnotherWay) {
  ConvertOptions options;
  options.fit.vertices = 400;
  const Conversion conversion = convertGroom(groom_kinds::twoWays(kStrands), {}, options, "two ways");
  ASSERT_FALSE(conversion.misfits.empty());
  EXPECT_TRUE(std::ranges::any_of(conversion.misfits, [](const Misfit& misfit) { return misfit.crossing; }));
  EXPECT_NE(conversionReport(conversion).find("strands of the same roots go other ways"), std::string::npos);
  // Each of them is listed once, with its offset.
  std::istringstream list(misfitList(conversion));
  int listed = 0, number = 0, last = -1;
  double off = 0;
  for (; list >> number >> off; ++listed, last = number) {
    EXPECT_GT(number, last);
    EXPECT_GE(off, 29 * conversion.fit.error.strand_length) << "mm: 3 %, rounded";
  }
  EXPECT_TRUE(list.eof());
  EXPECT_EQ(listed, misfitCount(conversion));
}

TEST(Conversion, NamesRunsOfStrandsThatDoNotFit) {
  ConvertOptions options;
  options.fit.vertices = 400;
  Conversion conversion = convertGroom(groom_kinds::cropped(200), {}, options, "cropped");
  conversion.misfits.assign(1, {});
  conversion.misfits[0].numbers = {3, 4, 5, 9, 12, 13, 20, 30, 31};
  conversion.misfits[0].strands = 9;
  EXPECT_NE(conversionReport(conversion).find("9 strands, numbers 3-5, 9, 12-13, 20 and 2 more, rooted"),
            std::string::npos);
  conversion.fit.error.mean = 0.009 * conversion.fit.error.strand_length;
  EXPECT_NE(conversionReport(conversion).find("aims          mean within 1 %: met"), std::string::npos);
  conversion.fit.error.mean = 0.011 * conversion.fit.error.strand_length;
  EXPECT_NE(conversionReport(conversion).find("mean within 1 %: not met"), std::string::npos);
}

TEST(Conversion, ReadsUnitsFromTheSpreadOfTheRoots) {
  Groom groom = groom_kinds::cropped(400);
  std::string name;
  EXPECT_EQ(inferUnit(groom, name), 1);
  for (Eigen::Vector3f& p : groom.points) p *= 100;
  EXPECT_EQ(inferUnit(groom, name), 0.01);
  EXPECT_EQ(name, "centimetres");
}

// Strands whose root is farther than 4 mm from the face that it was given.
int rootedBeside(const Conversion& conversion, const Groom& groom) {
  const StrandSamples samples = sampleStrands(groom, 1, 25);
  const GrowthMap growth(conversion.fit.shape);
  int beside = 0;
  for (std::size_t s = 0; s < samples.strandCount(); ++s)
    beside += (growth.rootAt(conversion.fit.strands[s].root) - samples.strand(s)[0]).norm() > 0.004f ? 1 : 0;
  return beside;
}

TEST(Conversion, CoversTheRootsAboutAWhorl) {
  for (const float length : {0.04f, 0.08f}) {
    const Groom groom = groom_kinds::whorl(4000, length);
    const Conversion conversion = convertGroom(groom, {}, {}, "whorl");
    EXPECT_EQ(conversion.fit.regions, 1) << "hair that only goes all ways is not torn";
    EXPECT_EQ(conversion.fit.dropped_faces, 0);
    EXPECT_EQ(rootedBeside(conversion, groom), 0);
  }
}

TEST(Conversion, CoversRootsThatLeadToATie) {
  const Groom groom = groom_kinds::ponytail(kStrands);
  ConvertOptions options;
  options.fit.vertices = kVertices;
  const Conversion conversion = convertGroom(groom, {}, options, "ponytail");
  EXPECT_EQ(conversion.fit.dropped_faces, 0);
  EXPECT_LE(rootedBeside(conversion, groom), kStrands / 100);
}

TEST(Conversion, TearsAPartingOnToTheRim) {
  ConvertOptions options;
  options.fit.vertices = 400;
  const Conversion conversion = convertGroom(groom_kinds::parted(4000, 0.02f, 0.22f), {}, options, "parted");
  EXPECT_EQ(conversion.fit.regions, 2) << "the tear turns back along the parting";
  EXPECT_LE(conversion.fit.error.mean, 0.025 * conversion.fit.error.strand_length);
}

TEST(Conversion, KeepsStubbleAsShortAsItIs) {
  ConvertOptions options;
  options.silhouettes = true;
  const Conversion conversion = convertGroom(groom_kinds::stubble(4000), {}, options, "stubble");
  EXPECT_EQ(conversion.fit.knots.size(), 2u);
  EXPECT_GE(conversion.silhouette_drawn, 0.93);
  for (int c = 0; c < conversion.shape.columnCount(); ++c) {
    const int first = conversion.shape.column_first[c];
    EXPECT_LE((conversion.shape.positions[first + 1] - conversion.shape.positions[first]).norm(), 0.006);
  }
}

TEST(Conversion, IsTheSameInAnotherUnit) {
  ConvertOptions metres, centimetres;
  metres.unit = 1;
  centimetres.unit = 0.01;
  metres.fit.vertices = centimetres.fit.vertices = 400;
  for (const int strands : {900, 1000, 1100, 4000}) {
    Groom groom = groom_kinds::whorl(strands, 0.06f);
    const sim::HairMeshShape one = convertGroom(groom, {}, metres, "m").shape;
    for (Eigen::Vector3f& p : groom.points) p *= 100;
    const sim::HairMeshShape other = convertGroom(groom, {}, centimetres, "cm").shape;
    ASSERT_EQ(one.column_first, other.column_first) << strands;
    ASSERT_EQ(one.root_faces.size(), other.root_faces.size());
    for (std::size_t f = 0; f < one.root_faces.size(); ++f)
      ASSERT_EQ(one.root_faces[f].columns, other.root_faces[f].columns) << strands;
    for (std::size_t v = 0; v < one.positions.size(); ++v)
      ASSERT_LT((one.positions[v] - other.positions[v]).norm(), 1e-3) << strands << ", m: rounding";
  }
}

// What is larger than a head, as hair in a unit that is not known, is divided no finer.
TEST(Conversion, KeepsToItsVerticesOnALargerHead) {
  ConvertOptions options;
  options.unit = 2.7;
  const Conversion conversion = convertGroom(groom_kinds::cropped(288), {}, options, "large");
  EXPECT_LE(conversion.shape.vertexCount(), 2400);
  EXPECT_LE(conversion.fit.regions, 8);
}

// What all strands have in common is what the hair mesh misses, and none of their own.
TEST(Conversion, WanderIsWhatNeighboursDoNotShare) {
  app::Groom groom = combed::combedGroom(600, 9);
  ConvertOptions options;
  options.unit = 1;
  options.fit.vertices = 400;
  const Conversion conversion = convertGroom(groom, {}, options, "combed");
  for (std::size_t s = 0; s < groom.strandCount(); ++s) {
    const std::size_t first = groom.strand_first[s], count = groom.pointCount(s);
    for (std::size_t k = 0; k < count; ++k)
      groom.points[first + k].x() += 0.03f * static_cast<float>(k) / static_cast<float>(count - 1);
  }
  const app::LookFit look =
      app::fitLook(groom, conversion.scale, app::sampleStrands(groom, conversion.scale, 24), conversion.fit);
  EXPECT_NEAR(look.all.offset, conversion.look.all.offset, 0.0005);
  EXPECT_LT(look.all.offset, 0.004) << "the most that is taken for wander is 0.005";
}

TEST(Conversion, SaysFirstThatMostStrandsDoNotFit) {
  ConvertOptions options;
  options.fit.vertices = 400;
  Conversion conversion = convertGroom(groom_kinds::cropped(200), {}, options, "cropped");
  conversion.misfits.resize(1);
  conversion.misfits[0].strands = 100;
  EXPECT_EQ(conversionWarning(conversion), "");
  EXPECT_TRUE(conversionReport(conversion).starts_with("read"));
  conversion.misfits[0].strands = 101;
  conversion.fit.error.mean = 0.049 * conversion.fit.error.strand_length;
  EXPECT_EQ(conversionWarning(conversion), "") << "hair that comes back a little off is not lost";
  conversion.fit.error.mean = 0.051 * conversion.fit.error.strand_length;
  EXPECT_NE(conversionWarning(conversion).find("101 of 200 strands do not fit"), std::string::npos);
  EXPECT_TRUE(conversionReport(conversion).starts_with("warning       most of the groom is lost"));
}

TEST(Conversion, RefusesWhatCarriesNoHairMesh) {
  Groom few;
  for (int i = 0; i < 5; ++i) groom_kinds::add({{0, 0, 0.01f * static_cast<float>(i)}, {0, 0.1f, 0}}, few);
  EXPECT_THROW(convertGroom(few, {}, {}, "few.hair"), InputError);
  Groom line;
  for (int i = 0; i < 100; ++i)
    groom_kinds::add({{0, 0, 0.001f * static_cast<float>(i)}, {0, 0.1f, 0.001f * static_cast<float>(i)}}, line);
  try {
    const Conversion conversion = convertGroom(line, {}, {}, "line.hair");
    EXPECT_GT(conversion.shape.vertexCount(), 0);
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("line.hair"), std::string::npos);
  }
}

TEST(Conversion, TriangulatesAGridWhole) {
  std::vector<Eigen::Vector2f> points;
  for (int y = 0; y < 6; ++y)
    for (int x = 0; x < 7; ++x) points.emplace_back(0.01f * static_cast<float>(x), 0.01f * static_cast<float>(y));
  double area = 0;
  for (const auto& t : delaunay(points)) {
    const auto at = [&](std::size_t k) { return points[static_cast<std::size_t>(t[k])]; };
    const Eigen::Vector2f a = at(1) - at(0), b = at(2) - at(0);
    const double one = 0.5 * (a.x() * b.y() - a.y() * b.x());
    EXPECT_GE(one, -1e-9) << "wound the other way";
    area += one;
  }
  EXPECT_NEAR(area, 0.06 * 0.05, 1e-6);
}

}  // namespace conversion_test
}  // namespace app
