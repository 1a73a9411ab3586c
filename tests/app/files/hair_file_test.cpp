// The OBJ convention of hair meshes: what is written comes back bit for bit; what is broken is refused with its line.
#include "app/files/hair_file.h"

#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "app/files/errors.h"
#include "tests/analytic_head.h"

namespace hair_file_test {

using app::Resolution;
using app::Style;

// Two bundles, a quad and a triangle on its right; the triangle ends a layer earlier.
const char* const kTwoBundles = R"(# a comment
g layer_0
v 0 0 0
v 0.02 0 0
v 0.02 0.02 0
v 0 0.02 0
v 0.04 0.01 0
usemtl bundle_0
f 1 2 3 4
usemtl bundle_1
f 2 5 3
g layer_1
v 0 0 0.02
v 0.02 0 0.02
v 0.02 0.02 0.02
v 0 0.02 0.02
v 0.04 0.01 0.02
usemtl bundle_0
f 6 7 8 9
usemtl bundle_1
f 7 10 8
g layer_2
v 0 0 0.04
v 0.02 0 0.04
v 0.02 0.02 0.04
v 0 0.02 0.04
usemtl bundle_0
f 11 12 13 14
)";

std::string replaced(std::string text, const std::string& what, const std::string& with) {
  const std::size_t at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return text.replace(at, what.size(), with);
}

std::string messageOf(const std::string& text) {
  try {
    app::readHairMesh(text, "bob.obj");
  } catch (const app::InputError& error) {
    return error.what();
  }
  return "no error";
}

void expectSame(const sim::HairMeshShape& a, const sim::HairMeshShape& b) {
  ASSERT_EQ(a.column_first, b.column_first);
  ASSERT_EQ(a.root_faces.size(), b.root_faces.size());
  for (std::size_t f = 0; f < a.root_faces.size(); ++f) {
    EXPECT_EQ(a.root_faces[f].corner_count, b.root_faces[f].corner_count);
    EXPECT_EQ(a.root_faces[f].columns, b.root_faces[f].columns);
  }
  ASSERT_EQ(a.positions.size(), b.positions.size());
  EXPECT_EQ(std::memcmp(a.positions.data(), b.positions.data(), a.positions.size() * sizeof(sim::Vec3)), 0);
}

TEST(HairFile, NineStylesComeBackBitForBit) {
  const app::Scalp scalp = tests::analyticScalp();
  for (const Style style : {Style::kShort, Style::kShoulder, Style::kLong, Style::kBob, Style::kPixie}) {
    for (const Resolution resolution : {Resolution::kLow, Resolution::kMedium, Resolution::kHigh}) {
      SCOPED_TRACE(std::string(app::styleName(style)) + " " + std::string(app::resolutionName(resolution)));
      const sim::HairMeshShape shape = app::makeStyle(style, resolution, scalp, tests::bodyDistance);
      expectSame(app::readHairMesh(app::writeHairMesh(shape), "style.obj"), shape);
    }
  }
}

TEST(HairFile, ReadsColumnsOfDifferentLengths) {
  const sim::HairMeshShape shape = app::readHairMesh(kTwoBundles, "two.obj");
  EXPECT_EQ(shape.column_first, (std::vector<int>{0, 3, 6, 9, 12, 14}));
  const sim::HairMesh mesh = sim::buildHairMesh(shape);
  EXPECT_EQ(mesh.bundle_layers, (std::vector<int>{3, 2}));
  expectSame(app::readHairMesh(app::writeHairMesh(shape), "again.obj"), shape);
}

TEST(HairFile, GroomOffsetsComeBackBitForBitAndBelongToTheVertexBefore) {
  sim::HairMeshShape shape = app::readHairMesh(kTwoBundles, "two.obj");
  EXPECT_TRUE(shape.groom_offsets.empty());
  shape.groom_offsets.assign(shape.positions.size(), sim::Vec3::Zero());
  shape.groom_offsets[1] = {0.001 / 3, -0.002, 1e-17};
  shape.groom_offsets.back() = {0, 0, 0.003};
  const sim::HairMeshShape again = app::readHairMesh(app::writeHairMesh(shape), "again.obj");
  expectSame(again, shape);
  EXPECT_EQ(again.groom_offsets, shape.groom_offsets);
  const std::string one =
      replaced(kTwoBundles, "v 0.04 0.01 0\n", "v 0.04 0.01 0\n# a comment\n#groom_offset 0 1e-3 0\n");
  EXPECT_EQ(app::readHairMesh(one, "one.obj").groom_offsets[12], sim::Vec3(0, 1e-3, 0));
}

TEST(HairFile, RefusesGroomOffsetsThatAreNone) {
  const std::string vertex = "v 0.04 0.01 0\n";
  EXPECT_NE(messageOf(replaced(kTwoBundles, vertex, vertex + "#groom_offset 0 1\n")).find("line 8: the vertex has"),
            std::string::npos);
  EXPECT_NE(
      messageOf(replaced(kTwoBundles, vertex, vertex + "#groom_offset 0 1 x\n")).find("line 8: 'x' is not a number"),
      std::string::npos);
  EXPECT_NE(
      messageOf("#groom_offset 0 0 0\n" + std::string(kTwoBundles)).find("line 1: the groom offset belongs to no"),
      std::string::npos);
}

TEST(HairFile, ReadsWhatModellingToolsWrite) {
  const sim::HairMeshShape plain = app::readHairMesh(kTwoBundles, "two.obj");
  std::string crlf;
  for (const char c : std::string(kTwoBundles)) crlf += c == '\n' ? std::string("\r\n") : std::string(1, c);
  expectSame(app::readHairMesh(crlf, "crlf.obj"), plain);
  expectSame(app::readHairMesh(crlf.substr(0, crlf.size() - 2), "no_newline_at_the_end.obj"), plain);
  std::string objects = kTwoBundles;
  for (const char* layer : {"layer_0", "layer_1", "layer_2"})
    objects =
        replaced(objects, std::string("g ") + layer, std::string("mtllib hair.mtl\ns off\no ") + layer + "_Mesh.001");
  expectSame(app::readHairMesh(objects, "objects.obj"), plain);
  std::string relative = replaced(kTwoBundles, "f 11 12 13 14", "vt 0 0\nvn 0 0 1\nf -4/1/1 -3//1 13/1 -1");
  relative = replaced(relative, "v 0.02 0 0\n", "v +2e-2 0.0 -0 1.0 # w\n");
  const sim::HairMeshShape shape = app::readHairMesh(relative, "relative.obj");
  EXPECT_EQ(shape.column_first, plain.column_first);
  EXPECT_EQ(shape.positions[3], plain.positions[3]);
  // Without names the order of the faces tells the bundles, as long as all reach every layer.
  std::string unnamed;
  std::istringstream lines(replaced(replaced(kTwoBundles, "usemtl bundle_0\nf 11 12 13 14\n", ""), "g layer_2", "#"));
  for (std::string line; std::getline(lines, line);) {
    if (line.rfind("usemtl", 0) == 0 || line.find(" 0.04\n") != std::string::npos) continue;
    if (line.size() > 5 && line.compare(line.size() - 5, 5, " 0.04") == 0) continue;
    unnamed += line + "\n";
  }
  EXPECT_EQ(app::readHairMesh(unnamed, "unnamed.obj").column_first, (std::vector<int>{0, 2, 4, 6, 8, 10}));
}

TEST(HairFile, FindsBundlesByNameInAnyOrder) {
  const std::string swapped = replaced(kTwoBundles, "usemtl bundle_0\nf 6 7 8 9\nusemtl bundle_1\nf 7 10 8\n",
                                       "usemtl bundle_1\nf 7 10 8\nusemtl bundle_0\nf 6 7 8 9\n");
  expectSame(app::readHairMesh(swapped, "swapped.obj"), app::readHairMesh(kTwoBundles, "two.obj"));
}

struct BadText {
  const char* name;
  std::string text;
  const char* said;  // part of the message
};

TEST(HairFile, RefusesBrokenFilesNamingTheLine) {
  const std::string good = kTwoBundles;
  const std::vector<BadText> bad = {
      {"empty", "", "it has no layer_0"},
      {"other text", "hello\nworld\n", "it has no layer_0"},
      {"missing scalp", replaced(good, "g layer_0", "g scalp"), "line 9: the face belongs to no layer"},
      {"scalp numbered 3", replaced(good, "g layer_0", "g layer_3"), "it has no layer_0"},
      {"gap in layers", replaced(good, "g layer_2", "g layer_5"), "line 22: layer_5 dangles: there is no layer_2"},
      {"layer without faces", good + "g layer_3\n", "layer_3 has no faces"},
      {"only a scalp", good.substr(0, good.find("g layer_1")), "extrude it at least once"},
      {"layer number not a number", replaced(good, "g layer_2", "g layer_two"), "line 22: the layer's number 'two'"},
      {"not a number", replaced(good, "v 0.04 0.01 0\n", "v 0.04 abc 0\n"), "line 7: 'abc' is not a number"},
      {"not quite a number", replaced(good, "v 0.04 0.01 0\n", "v 0.04 0.01x 0\n"), "line 7: '0.01x' is not a number"},
      {"NaN", replaced(good, "v 0.04 0.01 0\n", "v 0.04 nan 0\n"), "line 7: the coordinate 'nan' is not finite"},
      {"infinite", replaced(good, "v 0.04 0.01 0\n", "v 0.04 -inf 0\n"), "line 7: the coordinate '-inf' is not finite"},
      {"1e30", replaced(good, "v 0.04 0.01 0\n", "v 0.04 1e30 0\n"), "line 7: the coordinate '1e30'"},
      {"1e999", replaced(good, "v 0.04 0.01 0\n", "v 0.04 1e999 0\n"), "line 7: the coordinate '1e999'"},
      {"two coordinates", replaced(good, "v 0.04 0.01 0\n", "v 0.04 0.01\n"),
       "line 7: the vertex has fewer than three"},
      {"index out of range", replaced(good, "f 7 10 8", "f 7 99 8"),
       "line 21: the face names vertex 99, which does not exist"},
      {"index zero", replaced(good, "f 7 10 8", "f 7 0 8"), "line 21: the face's corner '0' is not a vertex number"},
      {"index too far back", replaced(good, "f 7 10 8", "f 7 -11 8"), "line 21: the face names vertex -11"},
      {"index overflow", replaced(good, "f 7 10 8", "f 7 99999999999999999999 8"), "line 21: the face's corner"},
      {"index below int", replaced(good, "f 7 10 8", "f 7 -9223372036854775808 8"), "line 21: the face names vertex"},
      {"two corners", replaced(good, "f 7 10 8", "f 7 10"), "line 21: the face has fewer than three corners"},
      {"five corners", replaced(good, "f 6 7 8 9", "f 6 7 8 9 10"), "line 19: the face has more than four corners"},
      {"corner count changes", replaced(good, "f 7 10 8", "f 7 10 8 9"),
       "line 21: the face has another number of corners"},
      {"duplicate bundle", replaced(good, "usemtl bundle_1\nf 7 10 8", "f 7 10 8"),
       "line 20: the bundle bundle_0 has two faces"},
      {"unknown bundle", replaced(good, "usemtl bundle_0\nf 11", "usemtl bundle_7\nf 11"),
       "no bundle of the name bundle_7"},
      {"same name twice", replaced(good, "usemtl bundle_1\nf 2 5 3", "f 2 5 3"),
       "line 10: a second root face is named bundle_0"},
      {"bundle skips a layer", replaced(replaced(good, "usemtl bundle_0\nf 6 7 8 9\n", ""), "g layer_2", "g layer_2\n"),
       "the face dangles: its bundle has none in layer_1"},
      {"unnamed faces that fail to match", replaced(good, "usemtl bundle_0\nf 11", "usemtl hair\nf 11"),
       "line 22: layer_2 has 1 faces where layer_0 has 2, and they are not named"},
      {"vertex without a face", replaced(good, "g layer_2", "v 1 1 1\ng layer_2"), "the vertex dangles"},
      {"corners turned", replaced(good, "f 7 10 8", "f 10 8 7"),
       "line 21: the face's vertex 10 does not stand over corner 1"},
      {"unwelded layer", replaced(good, "usemtl bundle_1\nf 7 10 8", "v 0.02 0 0.02\nusemtl bundle_1\nf 11 10 8"),
       "does not stand over corner 1"},
      {"layer reuses the scalp", replaced(good, "f 7 10 8", "f 7 5 8"), "line 21: the face's vertex 5 does not stand"},
      {"zero-area face", replaced(good, "v 0.04 0.01 0\n", "v 0.02 0.01 0\n"),
       "line 11 (root face 1): its area is zero"},
      {"inverted prism", replaced(good, "v 0 0.02 0.04", "v 0 0.02 -0.04"), "line 19 (root face 0, layer 1, corner"},
  };
  for (const BadText& one : bad) {
    SCOPED_TRACE(one.name);
    const std::string message = messageOf(one.text);
    EXPECT_NE(message.find(one.said), std::string::npos) << message;
    if (message != "no error") {
      EXPECT_EQ(message.rfind("bob.obj", 0), 0u) << message;
      EXPECT_NE(message.find("; "), std::string::npos) << "no mend: " << message;
    }
  }
}

// The middle one of three bundles cannot end before its neighbours, for all its columns are theirs as well.
TEST(HairFile, RefusesABundleThatEndsBeforeItsColumns) {
  std::string text;
  for (int l = 0; l < 3; ++l) {
    text += "g layer_" + std::to_string(l) + "\n";
    for (int x = 0; x < 4; ++x)
      for (int y = 0; y < 2; ++y)
        text +=
            "v " + std::to_string(0.02 * x) + " " + std::to_string(0.02 * y) + " " + std::to_string(0.02 * l) + "\n";
    for (int b = 0; b < 3; ++b) {
      if (b == 1 && l == 2) continue;
      const int v = 8 * l + 2 * b + 1;
      text += "usemtl bundle_" + std::to_string(b) + "\nf " + std::to_string(v) + " " + std::to_string(v + 2) + " " +
              std::to_string(v + 3) + " " + std::to_string(v + 1) + "\n";
    }
  }
  EXPECT_NE(messageOf(text).find("line 28: the bundle ends in layer_1 though all its columns go on to layer_2"),
            std::string::npos)
      << messageOf(text);
}

// A file cut off anywhere is refused or is still a whole hair mesh; it never crashes.
TEST(HairFile, SurvivesTruncationAnywhere) {
  const std::string good = kTwoBundles;
  for (std::size_t length = 0; length <= good.size(); ++length) {
    const std::string message = messageOf(good.substr(0, length));
    EXPECT_TRUE(message == "no error" || message.rfind("bob.obj", 0) == 0) << message;
  }
}

TEST(HairFile, ExampleInAssetsIsValid) {
  const std::string file = std::string(HAIRMESH_SOURCE_DIR) + "/assets/hair/bob_example.obj";
  std::ifstream in(file);
  ASSERT_TRUE(in) << file;
  std::stringstream text;
  text << in.rdbuf();
  const sim::HairMeshShape shape = app::readHairMesh(text.str(), file);
  EXPECT_GT(shape.vertexCount(), 100);
  EXPECT_EQ(app::writeHairMesh(shape), text.str());
}

TEST(HairFile, FacesThatAreAllWoundTheOtherWayAreNamedAndReversed) {
  std::string text = kTwoBundles;
  for (const auto& [outward, inward] : {std::pair{"f 1 2 3 4", "f 4 3 2 1"},
                                        {"f 2 5 3", "f 3 5 2"},
                                        {"f 6 7 8 9", "f 9 8 7 6"},
                                        {"f 7 10 8", "f 8 10 7"},
                                        {"f 11 12 13 14", "f 14 13 12 11"}})
    text = replaced(text, outward, inward);
  EXPECT_EQ(messageOf(text), "bob.obj: all faces are wound the other way; reverse the faces, or give --reverse-faces");
  expectSame(app::readHairMesh(text, "bob.obj", true), app::readHairMesh(kTwoBundles, "bob.obj"));
  EXPECT_THROW(app::readHairMesh(kTwoBundles, "bob.obj", true), app::InputError);
  for (const bool reversed : {false, true}) {
    bool turned = false;
    expectSame(app::readHairMesh(text, "bob.obj", reversed, "", &turned), app::readHairMesh(kTwoBundles, "bob.obj"));
    EXPECT_EQ(turned, !reversed) << "it is turned by itself and said so";
  }
  // One face wound the other way is named by its place.
  EXPECT_NE(messageOf(replaced(text, "f 4 3 2 1", "f 1 2 3 4")).find("line "), std::string::npos);
}

}  // namespace hair_file_test
