// Strips, cards and tubes to hair meshes: rows become layers, roots are where they should be.
#include <gtest/gtest.h>

#include <assimp/Exporter.hpp>
#include <assimp/Importer.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "app/files/errors.h"
#include "app/files/hair_file.h"
#include "app/files/polygon_file.h"
#include "app/groom/strips/strip_convert.h"
#include "tests/app/groom/strip_samples.h"
#include "tests/run_program.h"

namespace app {
namespace strip_test {

using Eigen::Vector3d;
using strip_samples::Cap;
using strip_samples::ObjText;

std::string written(const std::string& text, const std::string& name) {
  const std::string file = test::freshFolder("strips") + "/" + name;
  std::ofstream(file, std::ios::binary) << text;
  return file;
}

StripConversion convert(const std::string& text, StripOptions options = {}) {
  if (options.unit == 0) options.unit = 1;
  const std::string file = written(text, "hair.obj");
  return convertStrips(readPolygons(file), options, file);
}

// Mean height of a hair mesh's roots and of its last layers.
std::pair<double, double> heights(const sim::HairMeshShape& shape) {
  double root = 0, tip = 0;
  for (int c = 0; c < shape.columnCount(); ++c) {
    root += shape.positions[static_cast<std::size_t>(shape.column_first[static_cast<std::size_t>(c)])].y();
    tip += shape.positions[static_cast<std::size_t>(shape.column_first[static_cast<std::size_t>(c) + 1] - 1)].y();
  }
  return {root / shape.columnCount(), tip / shape.columnCount()};
}

struct CardCase {
  const char* name;
  int across, down, cut;
  double bend;
};
void PrintTo(const CardCase& one, std::ostream* out) {
  *out << one.name;
}
class Cards : public testing::TestWithParam<CardCase> {};

TEST_P(Cards, RowsBecomeLayersFromTheHighestEdge) {
  const CardCase& one = GetParam();
  ObjText obj;
  strip_samples::card({0, 0, 0}, one.across, one.down, one.bend, one.cut, obj);
  const StripConversion conversion = convert(obj.text);
  const sim::HairMeshShape& shape = conversion.mesh.shape;
  EXPECT_EQ(conversion.strips, 1);
  EXPECT_EQ(conversion.tubes, 0);
  EXPECT_EQ(shape.columnCount(), 2 * (one.across + 1));
  EXPECT_EQ(static_cast<int>(shape.root_faces.size()), one.across);
  EXPECT_EQ(shape.columnLength(0), one.down + 1);
  EXPECT_NEAR(heights(shape).first, 0, 1e-6);
  EXPECT_LT(heights(shape).second, -0.05);
  // The middle of both sides is the strip itself: its length is kept.
  const int other = one.across + 1;
  double length = 0;
  for (int l = 1; l <= one.down; ++l) {
    const auto middle = [&](int layer) {
      return Vector3d(
          0.5 *
          (shape.positions[static_cast<std::size_t>(layer)] +
           shape.positions[static_cast<std::size_t>(shape.column_first[static_cast<std::size_t>(other)] + layer)]));
    };
    length += (middle(l) - middle(l - 1)).norm();
  }
  EXPECT_NEAR(length, 0.2, 1e-6);
}

INSTANTIATE_TEST_SUITE_P(Kinds, Cards,
                         testing::Values(CardCase{"Flat", 1, 6, 0, 0}, CardCase{"FlatTriangles", 1, 6, 1, 0},
                                         CardCase{"Bent", 1, 8, 0, 1.5}, CardCase{"BentTriangles", 1, 8, 1, 1.5},
                                         CardCase{"Wide", 4, 8, 0, 0.8}, CardCase{"WideTriangles", 4, 8, 1, 0.8},
                                         CardCase{"WideMixedTriangles", 3, 9, 2, 0.4},
                                         CardCase{"WiderThanLong", 8, 4, 0, 0.3},
                                         CardCase{"WiderThanLongTriangles", 8, 4, 2, 0.3}),
                         [](const auto& one) { return std::string(one.param.name); });

struct TubeCase {
  const char* name;
  int sides, cut;
  Cap root, tip;
  double bend;
};
void PrintTo(const TubeCase& one, std::ostream* out) {
  *out << one.name;
}
class Tubes : public testing::TestWithParam<TubeCase> {};

TEST_P(Tubes, BecomeOneBundleFromTheHighestRing) {
  const TubeCase& one = GetParam();
  ObjText obj;
  strip_samples::tube({0, 0, 0}, one.sides, 6, one.root, one.tip, one.cut, obj, one.bend);
  const StripConversion conversion = convert(obj.text);
  const sim::HairMeshShape& shape = conversion.mesh.shape;
  EXPECT_EQ(conversion.tubes, 1) << stripReport(conversion);
  EXPECT_EQ(shape.columnCount(), one.sides);
  EXPECT_EQ(static_cast<int>(shape.root_faces.size()), (one.sides - 1) / 2);
  EXPECT_EQ(shape.columnLength(0), one.tip == Cap::kPoint ? 8 : 7);
  EXPECT_NEAR(heights(shape).first, 0, 1e-6);
  EXPECT_LT(heights(shape).second, -0.09);
}

INSTANTIATE_TEST_SUITE_P(Kinds, Tubes,
                         testing::Values(TubeCase{"FourOpen", 4, 0, Cap::kNone, Cap::kNone, 0},
                                         TubeCase{"FourOpenTriangles", 4, 1, Cap::kNone, Cap::kNone, 0.5},
                                         TubeCase{"FourCapped", 4, 0, Cap::kPolygon, Cap::kPolygon, 0},
                                         TubeCase{"FourCappedTriangles", 4, 1, Cap::kPolygon, Cap::kPolygon, 0.5},
                                         TubeCase{"SixOpen", 6, 0, Cap::kNone, Cap::kNone, 0.5},
                                         TubeCase{"SixCapped", 6, 0, Cap::kPolygon, Cap::kPolygon, 0},
                                         TubeCase{"SixCappedTriangles", 6, 1, Cap::kPolygon, Cap::kPolygon, 0.5},
                                         TubeCase{"SixFans", 6, 1, Cap::kFan, Cap::kFan, 0.5},
                                         TubeCase{"SixPointed", 6, 1, Cap::kNone, Cap::kPoint, 0.5},
                                         TubeCase{"EightOpen", 8, 0, Cap::kNone, Cap::kNone, 0.5},
                                         TubeCase{"EightCapped", 8, 0, Cap::kPolygon, Cap::kPolygon, 0.5},
                                         TubeCase{"EightFansTriangles", 8, 2, Cap::kFan, Cap::kFan, 0.5},
                                         TubeCase{"EightPointedTriangles", 8, 2, Cap::kNone, Cap::kPoint, 0.8},
                                         TubeCase{"EightRootFanTipPoint", 8, 1, Cap::kFan, Cap::kPoint, 0.5},
                                         TubeCase{"FiveOpen", 5, 1, Cap::kNone, Cap::kNone, 0.5},
                                         TubeCase{"ThreeCapped", 3, 1, Cap::kPolygon, Cap::kPolygon, 0.5}),
                         [](const auto& one) { return std::string(one.param.name); });

TEST(Strips, ThatShareVerticesAreJoinedAndOthersStayApart) {
  ObjText apart;
  for (const double x : {0.0, 0.031, 0.062}) strip_samples::card({x, 0, 0}, 1, 6, 0.4, 0, apart);
  EXPECT_EQ(convert(apart.text).strips, 3);
  StripOptions join;
  join.join = 0.004;
  const StripConversion near = convert(apart.text, join);
  EXPECT_EQ(near.strips, 1);
  EXPECT_EQ(near.joined, 1);
  EXPECT_EQ(near.mesh.shape.root_faces.size(), 3u);
  ObjText shared;  // each with its own copy of the vertices between
  for (const double x : {0.0, 0.03, 0.06}) strip_samples::card({x, 0, 0}, 1, 6, 0.4, 0, shared);
  const StripConversion joined = convert(shared.text);
  EXPECT_EQ(joined.strips, 1);
  EXPECT_EQ(joined.mesh.shape.columnCount(), 8);
}

TEST(Strips, RootAtTheScalpWhereThereIsOne) {
  ObjText obj;  // a lock that stands up from the top of the head
  strip_samples::card({0, 0.29, 0}, 1, 6, 0, 0, obj);
  EXPECT_NEAR(heights(convert(obj.text).mesh.shape).first, 0.29, 1e-6);
  obj.object("Head");
  strip_samples::ball(0.09, obj);
  const StripConversion conversion = convert(obj.text);
  EXPECT_EQ(conversion.strips, 1);
  EXPECT_NEAR(heights(conversion.mesh.shape).first, 0.09, 1e-6);
  EXPECT_NE(stripReport(conversion).find("nearest to the scalp"), std::string::npos);
  StripOptions highest;
  highest.root = RootEdge::kHighest;
  EXPECT_NEAR(heights(convert(obj.text, highest).mesh.shape).first, 0.29, 1e-6);
}

TEST(Strips, RootEdgeIsOverruled) {
  ObjText obj;
  strip_samples::card({0, 0, 0}, 1, 6, 0, 0, obj);
  strip_samples::card({0.1, 0, 0}, 1, 6, 0, 1, obj);
  StripOptions options;
  options.other_end = true;
  EXPECT_NEAR(heights(convert(obj.text, options).mesh.shape).first, -0.2, 1e-6);
  options.other_end = false;
  options.flipped = {2};
  EXPECT_NEAR(heights(convert(obj.text, options).mesh.shape).first, -0.1, 1e-6);
  options.root = RootEdge::kLowest;
  options.flipped = {};
  EXPECT_NEAR(heights(convert(obj.text, options).mesh.shape).first, -0.2, 1e-6);
  options.flipped = {3};
  EXPECT_THROW(convert(obj.text, options), InputError);
}

TEST(Strips, UnitIsInferredFromTheRoots) {
  for (const double scale : {1.0, 100.0, 1000.0}) {
    ObjText obj;
    obj.scale = scale;
    for (const Vector3d& root : strip_samples::rootsOnHead(40)) strip_samples::card(root, 1, 5, 0.3, 0, obj);
    const std::string file = written(obj.text, "unit.obj");
    const StripConversion conversion = convertStrips(readPolygons(file), {}, file);
    EXPECT_EQ(conversion.strips, 40);
    EXPECT_NEAR(conversion.scale, 1 / scale, 1e-9) << conversion.unit;
    EXPECT_NEAR(heights(conversion.mesh.shape).first - heights(conversion.mesh.shape).second, 0.195, 0.01);
  }
}

TEST(Strips, KeepToTheVerticesAskedFor) {
  ObjText obj;
  for (const Vector3d& root : strip_samples::rootsOnHead(30))
    strip_samples::tube(root, 8, 16, Cap::kFan, Cap::kPoint, 0, obj, 0.6);
  StripOptions options;
  options.mesh.vertices = 30 * 4 * 6;
  const StripConversion conversion = convert(obj.text, options);
  EXPECT_EQ(conversion.tubes, 30);
  EXPECT_LE(conversion.mesh.shape.vertexCount(), options.mesh.vertices);
  EXPECT_TRUE(conversion.mesh.thinned);
  EXPECT_NE(stripReport(conversion).find("--vertices"), std::string::npos);
}

TEST(Strips, OfMorePiecesThanTheVerticesCarryAreRefusedWithTheFewest) {
  ObjText obj;
  for (const Vector3d& root : strip_samples::rootsOnHead(60)) strip_samples::card(root, 3, 8, 0, 0, obj, 0.01);
  StripOptions options;
  options.mesh.vertices = 60 * 4 * 4;
  EXPECT_EQ(convert(obj.text, options).mesh.shape.vertexCount(), 960);
  options.mesh.vertices = 400;
  try {
    convert(obj.text, options);
    FAIL() << "400 vertices do not carry 60 strips";
  } catch (const InputError& fault) {
    EXPECT_NE(std::string(fault.what()).find("--vertices 960"), std::string::npos) << fault.what();
  }
  options.mesh.vertices = 960;
  options.mesh.layers = 6;
  EXPECT_THROW(convert(obj.text, options), InputError);
  options.mesh.vertices = 1440;
  EXPECT_EQ(convert(obj.text, options).mesh.shape.vertexCount(), 1440);
}

TEST(Strips, ReportSaysWhichEndIsTheRootOfEach) {
  ObjText obj;
  for (const double x : {0.0, 0.1, 0.2, 0.3}) strip_samples::card({x, 0, 0}, 1, 6, 0, 0, obj);
  StripOptions options;
  options.flipped = {2, 4};
  const std::string turned = stripReport(convert(obj.text, options));
  EXPECT_NE(turned.find("the highest end (y up), of 2 of 4 pieces"), std::string::npos) << turned;
  EXPECT_NE(turned.find("turned        strips 2, 4: rooted at the other end"), std::string::npos) << turned;
  EXPECT_EQ(turned.find("unclear"), std::string::npos) << turned;
  options.flipped = {};
  EXPECT_EQ(stripReport(convert(obj.text, options)).find("turned "), std::string::npos);
  options.other_end = true;
  const std::string all = stripReport(convert(obj.text, options));
  EXPECT_NE(all.find("turned        all"), std::string::npos) << all;
  options.other_end = false;
  options.up = 'z';  // as high as each other: which is the root is no more than a guess
  const std::string guessed = stripReport(convert(obj.text, options));
  EXPECT_NE(guessed.find("unclear       strips 1, 2, 3, 4: both ends"), std::string::npos) << guessed;
  obj.object("Head");
  strip_samples::ball(0.09, obj);
  const std::string scalp = stripReport(convert(obj.text));
  EXPECT_NE(scalp.find("from the scalp, tips "), std::string::npos) << scalp;
}

TEST(Strips, ComeTheSameFromEveryFormat) {
  ObjText obj;
  obj.object("Hair");
  for (const Vector3d& root : strip_samples::rootsOnHead(12)) strip_samples::card(root, 2, 6, 0.7, 0, obj);
  strip_samples::tube({0, 0.09, 0}, 6, 6, Cap::kPolygon, Cap::kPolygon, 0, obj, 0.4);
  const std::string source = written(obj.text, "hair.obj");
  const sim::HairMeshShape first = convertStrips(readPolygons(source), {}, source).mesh.shape;
  Assimp::Importer importer;
  const aiScene* scene = importer.ReadFile(source, 0);
  ASSERT_NE(scene, nullptr);
  for (const auto& [format, name] :
       {std::pair("glb2", "hair.glb"), {"gltf2", "hair.gltf"}, {"fbxa", "hair.fbx"}, {"glb2", "hair.vrm"}}) {
    const std::string file = test::freshFolder(std::string("strips_") + format) + "/" + name;
    // What is named .vrm is binary glTF.
    const std::string made = std::string(name) == "hair.vrm" ? file + ".glb" : file;
    const unsigned triangles = std::string(format) == "fbxa" ? 0u : 8u;  // aiProcess_Triangulate
    ASSERT_EQ(Assimp::Exporter().Export(scene, format, made, triangles), AI_SUCCESS) << format;
    if (made != file) std::filesystem::rename(made, file);
    StripOptions metres;
    metres.unit = std::string(format) == "fbxa" ? 1 : 0;
    const StripConversion conversion = convertStrips(readPolygons(file), metres, file);
    EXPECT_EQ(conversion.strips, 12) << file;
    EXPECT_EQ(conversion.tubes, 1) << file;
    const sim::HairMeshShape& shape = conversion.mesh.shape;
    EXPECT_EQ(shape.root_faces.size(), first.root_faces.size()) << file;
    EXPECT_EQ(shape.vertexCount(), first.vertexCount()) << file;
    EXPECT_NEAR(heights(shape).first, heights(first).first, 1e-5) << file;
  }
}

TEST(Strips, OwnHairMeshesAreToldByTheirLayers) {
  EXPECT_TRUE(hasLayers("# x\nv 0 0 0\n g layer_0\n"));
  EXPECT_TRUE(hasLayers("o head layer_12_Mesh.001\r\n"));
  EXPECT_FALSE(hasLayers("g player_0\no layer_\n# g layer_0\nusemtl layer_1\n"));
  ObjText obj;
  strip_samples::card({0, 0, 0}, 1, 6, 0, 0, obj);
  const sim::HairMeshShape shape = convert(obj.text).mesh.shape;
  const std::string text = writeHairMesh(shape);
  EXPECT_TRUE(hasLayers(text));
  EXPECT_EQ(readHairMesh(text, "again.obj").vertexCount(), shape.vertexCount());
}

// hairmesh-convert and hairmesh --hair infer alike: which axis is up, and the place on the head.
TEST(Strips, AreBroughtToTheHeadByTheProgram) {
  const std::string folder = test::freshFolder("strips_program");
  const std::string binary = std::filesystem::path(HAIRMESH_BINARY).parent_path().string() + "/hairmesh-convert";
  const auto run = [&](const std::string& in, const std::string& out, const std::string& options = "") {
    const std::string command = test::shellQuoted(binary) + " " + test::shellQuoted(in) + " " + test::shellQuoted(out) +
                                options + " >" + test::shellQuoted(folder + "/said") + " 2>&1";
    const int status = std::system(command.c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  };
  std::vector<double> tops;
  for (const auto& [units, z_up] : {std::pair(100, false), {100, true}, {1, false}, {1000, true}}) {
    ObjText obj;
    obj.scale = units;
    obj.z_up = z_up;
    for (const Vector3d& root : strip_samples::rootsOnHead(40))
      strip_samples::card(root + Vector3d(0, 1.5, 0), 1, 5, 0.3, 0, obj);
    const std::string out = folder + "/out.obj";
    ASSERT_EQ(run(written(obj.text, z_up ? "z.obj" : "y.obj"), out), 0) << test::readAll(folder + "/said");
    tops.push_back(heights(readHairMesh(test::readAll(out), out)).first);
  }
  for (const double top : tops) EXPECT_NEAR(tops[0], top, 0.01);
  EXPECT_LT(std::abs(tops[0]), 0.3) << "above the head's joint";
  // In a unit that makes giants of them they are for no head, and it says what mends it.
  ObjText giants;
  giants.scale = 100;
  for (const Vector3d& root : strip_samples::rootsOnHead(40)) strip_samples::card(root, 1, 5, 0.3, 0, giants);
  EXPECT_EQ(run(written(giants.text, "giants.obj"), folder + "/out.obj", " --unit m"), 1);
  EXPECT_NE(test::readAll(folder + "/said").find("--scalp FILE"), std::string::npos) << test::readAll(folder + "/said");
  std::ofstream(folder + "/own.glb") << "glTF....{\"asset\":{\"generator\":\"hairmesh\"}}";
  EXPECT_EQ(run(folder + "/own.glb", folder + "/own.obj"), 4);
  EXPECT_NE(test::readAll(folder + "/said").find("is a moving hair mesh that this program has exported"),
            std::string::npos);
}

// hairmesh-inspect tells by content what a file of polygons is.
TEST(Strips, AreInspectedByTheProgramWithBodiesAndHairMeshes) {
  const std::string folder = test::freshFolder("strips_inspected");
  const std::string binary = std::filesystem::path(HAIRMESH_BINARY).parent_path().string() + "/hairmesh-inspect";
  const auto said = [&](const std::string& arguments, int expected) {
    const std::string command =
        test::shellQuoted(binary) + " " + arguments + " >" + test::shellQuoted(folder + "/said") + " 2>&1";
    const int status = std::system(command.c_str());
    const std::string text = test::readAll(folder + "/said");
    EXPECT_EQ(WIFEXITED(status) ? WEXITSTATUS(status) : -1, expected) << arguments << ": " << text;
    return text;
  };
  ObjText cards;
  cards.scale = 100;
  cards.z_up = true;
  for (const Vector3d& root : strip_samples::rootsOnHead(40))
    strip_samples::card(root + Vector3d(0, 1.5, 0), 1, 5, 0.3, 0, cards);
  const std::string file = test::shellQuoted(written(cards.text, "cards.obj"));
  const std::string found = said(file + " --strict", 1);
  EXPECT_NE(found.find("unit: the roots are spread as over a head in cm, not m; --unit cm (certain)"),
            std::string::npos)
      << found;
  EXPECT_NE(found.find("; --up z (certain)"), std::string::npos) << found;
  EXPECT_NE(found.find("40 strips and 0 tubes"), std::string::npos) << found;
  const std::string asked = said(file + " --unit cm --up z --drop-strips 1,2", 0);
  EXPECT_EQ(asked.find("unit: "), std::string::npos) << asked;
  EXPECT_NE(asked.find("38 strips and 0 tubes"), std::string::npos) << asked;
  EXPECT_NE(said(file + " --out " + folder + "/x.abc", 2).find("hairmesh-convert"), std::string::npos);
  EXPECT_NE(said(file + " --drop-strips 41", 4).find("from 1 to 40"), std::string::npos);
  const std::string assets = HAIRMESH_SOURCE_DIR "/assets/";
  EXPECT_NE(
      said(test::shellQuoted(assets + "hair/bob_example.obj") + " --strict", 0).find("a hair mesh of this program"),
      std::string::npos);
  EXPECT_NE(said(test::shellQuoted(assets + "attachments/beanie.obj"), 4).find("is a mesh to wear"), std::string::npos);
  EXPECT_NE(said(test::shellQuoted(assets + "clips/walk.bvh"), 4).find("is a motion"), std::string::npos);
}

struct BadCase {
  const char* name;
  const char* text;
  const char* said;
};
void PrintTo(const BadCase& one, std::ostream* out) {
  *out << one.name;
}
class BadStrips : public testing::TestWithParam<BadCase> {};

TEST_P(BadStrips, GiveOneMessageThatNamesTheFault) {
  try {
    convert(GetParam().text);
    FAIL() << "nothing was said";
  } catch (const InputError& fault) {
    EXPECT_NE(std::string(fault.what()).find(GetParam().said), std::string::npos) << fault.what();
    EXPECT_NE(std::string(fault.what()).find("; "), std::string::npos) << "no mend: " << fault.what();
  }
}

INSTANTIATE_TEST_SUITE_P(
    Kinds, BadStrips,
    testing::Values(BadCase{"NoFaces", "v 0 0 0\nv 1 0 0\nv 0 1 0\n", "hair.obj"},
                    BadCase{"NotFinite", "v 0 0 nan\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n", "hair.obj"},
                    BadCase{"ZeroArea", "v 0 0 0\nv 0 0 0\nv 0 0 0\nv 0 0 0\nf 1 2 3 4\n", "hair.obj"},
                    BadCase{"Line", "v 0 0 0\nv 1 0 0\nv 2 0 0\nv 3 0 0\nf 1 2 3 4\n", "hair.obj"},
                    BadCase{"Utf16", "\xff\xfev\x01 \x01 0 0 0 0 0", "UTF-16"},
                    BadCase{"Noise", "nothing of the kind, but long enough", "hair.obj"}),
    [](const auto& one) { return std::string(one.param.name); });

}  // namespace strip_test
}  // namespace app
