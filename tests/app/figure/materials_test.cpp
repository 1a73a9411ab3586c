// Colours and pictures that a figure's file brings.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <string>
#include <vector>

#include "app/figure/character.h"
#include "app/files/image_io.h"

namespace materials_test {

namespace fs = std::filesystem;

const fs::path kFolder = fs::path(HAIRMESH_TEST_OUT) / "materials";

// A ball of radius one: positions, then texture coordinates, then indices, as glTF's buffer has them.
struct Ball {
  static constexpr int kRings = 12, kSegments = 16;
  std::vector<float> positions, places;
  std::vector<std::uint16_t> indices;

  Ball() {
    for (int r = 0; r <= kRings; ++r) {
      for (int s = 0; s <= kSegments; ++s) {
        const double polar = std::numbers::pi * r / kRings, around = 2 * std::numbers::pi * s / kSegments;
        positions.insert(positions.end(),
                         {static_cast<float>(std::sin(polar) * std::sin(around)), static_cast<float>(std::cos(polar)),
                          static_cast<float>(std::sin(polar) * std::cos(around))});
        places.insert(places.end(), {static_cast<float>(s) / kSegments, static_cast<float>(r) / kRings});
      }
    }
    for (int r = 0; r < kRings; ++r) {
      for (int s = 0; s < kSegments; ++s) {
        const auto at = [&](int dr, int ds) { return static_cast<std::uint16_t>((r + dr) * (kSegments + 1) + s + ds); };
        for (const std::uint16_t i : {at(0, 0), at(1, 0), at(1, 1), at(0, 0), at(1, 1), at(0, 1)}) indices.push_back(i);
      }
    }
  }
};

// Writes a figure of two balls, hips and head; the head's material shows `picture`. Returns the file's name.
std::string writeFigure(const std::string& name, const std::string& materials, const std::string& head = "Head",
                        const std::string& neck = "") {
  fs::create_directories(kFolder);
  const Ball ball;
  std::ofstream bin(kFolder / "a ball.bin", std::ios::binary);
  const auto put = [&](const auto& values) {
    const auto bytes = values.size() * sizeof(values[0]);
    bin.write(reinterpret_cast<const char*>(values.data()), static_cast<std::streamsize>(bytes));
    return std::to_string(bytes);
  };
  const std::string positions = put(ball.positions), places = put(ball.places), indices = put(ball.indices);
  const std::size_t first = ball.positions.size() * 4, second = first + ball.places.size() * 4;
  const std::string count = std::to_string(ball.positions.size() / 3);
  const auto mesh = [](int material) {
    return R"({"primitives":[{"attributes":{"POSITION":0,"TEXCOORD_0":1},"indices":2,"material":)" +
           std::to_string(material) + "}]}";
  };
  std::ofstream(kFolder / name)
      << R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[)"
      << R"({"name":"Hips","mesh":0,"translation":[0,0.8,0],"scale":[0.2,0.7,0.15],"children":[1]},)"
      << (neck.empty() ? "" : R"({"name":")" + neck + R"(","translation":[0,0.9,0],"children":[2]},)") << R"({"name":")"
      << head << R"(","mesh":1,"translation":[0,)" << (neck.empty() ? "1.1" : "0.2")
      << R"(,0],"scale":[0.5,0.16,0.7]}],)"
      << R"("meshes":[)" << mesh(0) << "," << mesh(1) << "]," << materials << R"(,"buffers":[{"uri":"a%20ball.bin",)"
      << R"("byteLength":)" << second + ball.indices.size() * 2 << R"(}],"bufferViews":[)"
      << R"({"buffer":0,"byteOffset":0,"byteLength":)" << positions << R"(},{"buffer":0,"byteOffset":)" << first
      << R"(,"byteLength":)" << places << R"(},{"buffer":0,"byteOffset":)" << second << R"(,"byteLength":)" << indices
      << R"(}],"accessors":[{"bufferView":0,"componentType":5126,"count":)" << count
      << R"(,"type":"VEC3","min":[-1,-1,-1],"max":[1,1,1]},{"bufferView":1,"componentType":5126,"count":)" << count
      << R"(,"type":"VEC2"},{"bufferView":2,"componentType":5123,"count":)" << ball.indices.size()
      << R"(,"type":"SCALAR"}]})";
  return (kFolder / name).string();
}

// Two materials, one of a colour, one of a picture.
std::string twoMaterials(const std::string& picture) {
  return R"("materials":[{"name":"suit","pbrMetallicRoughness":{"baseColorFactor":[0.5,0.2,0.1,1]}},)"
         R"({"name":"face","pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}],)"
         R"("textures":[{"source":0}],"images":[{"uri":")" +
         picture + R"("}])";
}

std::uint32_t asTexel(const unsigned char* rgba) {
  return rgba[0] | rgba[1] << 8 | rgba[2] << 16 | 0xff000000u;
}

bool says(const app::Character& character, const std::string& words) {
  for (const std::string& note : character.notes) {
    if (note.find(words) != std::string::npos) return true;
  }
  return false;
}

// Whatever the joint above the neck is called, it carries the head.
TEST(Materials, TheHeadIsTheJointAboveTheNeck) {
  const std::string materials = twoMaterials("nowhere.png");
  for (const char* neck : {"neck", "nacken"}) {
    for (const char* head : {"kopf", "j3", "Head"}) {
      const app::Character figure = app::loadCharacter(writeFigure("neck.gltf", materials, head, neck));
      EXPECT_TRUE(says(figure, "head: joint '" + std::string(head) + "'")) << neck << " " << head;
    }
  }
}

TEST(Materials, ColourAndPictureComeWithTheFigure) {
  fs::create_directories(kFolder);
  std::vector<unsigned char> rgba;
  for (int t = 0; t < 16; ++t) {
    const auto ramp = static_cast<unsigned char>(16 * t);
    rgba.insert(rgba.end(), {ramp, static_cast<unsigned char>(255 - ramp), 40, 255});
  }
  app::writePng((kFolder / "a face.png").string(), 4, 4, rgba);
  const app::Character figure = app::loadCharacter(writeFigure("two.gltf", twoMaterials("a%20f%61ce.png")));
  ASSERT_EQ(figure.mesh.materials.size(), 2u);
  ASSERT_EQ(figure.mesh.material_places.size(), figure.mesh.positions.size());
  // The curve of sRGB at 0.5, 0.2 and 0.1: 188, 124 and 89.
  EXPECT_EQ(figure.mesh.materials[0], std::vector<std::uint32_t>(16, 0xff597cbcu));
  for (std::size_t t = 0; t < 16; ++t) EXPECT_EQ(figure.mesh.materials[1][t], asTexel(&rgba[4 * t])) << t;
  // The head's vertices, and they alone, are of the second; rows of the picture go down with the ball's rings.
  for (std::size_t v = 0; v < figure.mesh.positions.size(); ++v) {
    const Eigen::Vector3f& place = figure.mesh.material_places[v];
    const bool of_head = figure.mesh.joints[v][0] == figure.head_joint;
    EXPECT_EQ(place.z(), of_head ? 1 : 0);
  }
  const auto top = std::max_element(figure.mesh.positions.begin(), figure.mesh.positions.end(),
                                    [](const auto& a, const auto& b) { return a.y() < b.y(); });
  EXPECT_NEAR(figure.mesh.material_places[static_cast<std::size_t>(top - figure.mesh.positions.begin())].y(), 0, 1e-5);
  EXPECT_TRUE(says(figure, "materials: 2, 1 with a picture"));
}

TEST(Materials, APictureThatIsMissingIsSaidAndItsColourStays) {
  const app::Character figure = app::loadCharacter(writeFigure("missing.gltf", twoMaterials("nowhere.png")));
  ASSERT_EQ(figure.mesh.materials.size(), 2u);
  EXPECT_EQ(figure.mesh.materials[1], std::vector<std::uint32_t>(1, 0xffffffffu));
  EXPECT_TRUE(says(figure, "material 'face' is shown without its picture"));
}

TEST(Materials, AColourOutOfRangeIsBroughtThereAndSaid) {
  const std::string bright =
      R"("materials":[{"name":"suit","pbrMetallicRoughness":{"baseColorFactor":[2,0.2,-1,1]}},{"name":"face"}])";
  const app::Character figure = app::loadCharacter(writeFigure("bright.gltf", bright));
  ASSERT_EQ(figure.mesh.materials.size(), 2u);
  EXPECT_EQ(figure.mesh.materials[0].at(0), 0xff007cffu);
  EXPECT_TRUE(says(figure, "material 'suit': its colour is not within 0 and 1"));
  EXPECT_FALSE(says(figure, "material 'face'"));
}

TEST(Materials, AFileOfGreyBringsNone) {
  const std::string grey = R"("materials":[{"pbrMetallicRoughness":{"baseColorFactor":[0.6,0.6,0.6,1]}},{}])";
  const app::Character figure = app::loadCharacter(writeFigure("grey.gltf", grey));
  EXPECT_TRUE(figure.mesh.materials.empty());
  EXPECT_TRUE(figure.mesh.material_places.empty());
}

TEST(Materials, TheRobotHasThree) {
  const fs::path file = fs::path(HAIRMESH_SOURCE_DIR) / "../shared/characters/robot.glb";
  if (!fs::exists(file)) GTEST_SKIP() << file << " is absent";
  EXPECT_EQ(app::loadCharacter(file.string()).mesh.materials.size(), 3u);
}

}  // namespace materials_test
