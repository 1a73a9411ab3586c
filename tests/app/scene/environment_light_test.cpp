// A panorama's light: where it comes from, how much of it, and what cannot be read.
#include "app/scene/view/environment_light.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <string>

#include "app/files/errors.h"

namespace environment_light_test {

constexpr double kSphere = 4 * std::numbers::pi;

app::RadiancePicture evenly(int width, float radiance) {
  const int height = width / 2;
  return {width, height, std::vector<float>(static_cast<std::size_t>(width) * height * 3, radiance)};
}

// Adds a patch of some rgb around a pixel.
void addPatch(app::RadiancePicture& picture, int column, int row, int half, std::array<float, 3> rgb) {
  for (int y = row - half; y <= row + half; ++y)
    for (int x = column - half; x <= column + half; ++x)
      for (int c = 0; c < 3; ++c) picture.rgb[3 * (static_cast<std::size_t>(y) * picture.width + x) + c] += rgb[c];
}

double inAll(const render::LightInput& light) {
  double sum = 0;
  for (int c = 0; c < 3; ++c) {
    sum += (light.key[c] + light.fill[c] + light.rim[c]) / kSphere;
    sum += 0.5 * (light.ambient_sky[c] + light.ambient_ground[c]);
  }
  return sum / 3;
}

std::string written(const std::string& name, const std::string& bytes) {
  const std::string file = (std::filesystem::temp_directory_path() / ("hairmesh_environment_" + name)).string();
  std::ofstream(file, std::ios::binary) << bytes;
  return file;
}

std::string header(const std::string& size) {
  return "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n" + size + "\n";
}

std::string refusal(const std::string& name, const std::string& bytes) {
  const std::string file = written(name, bytes);
  try {
    app::environmentLight(file, render::LightInput{});
  } catch (const app::InputError& error) {
    return error.what();
  }
  return "read";
}

TEST(EnvironmentLight, EvenLightComesFromAllAround) {
  const render::LightInput light = app::environmentLight("even", evenly(128, 7.0f), {});
  EXPECT_NEAR(inAll(light), inAll({}), 1e-5);
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(light.key[c], 0, 1e-5);
    EXPECT_NEAR(light.ambient_sky[c], light.ambient_ground[c], 1e-4);
    EXPECT_NEAR(light.ambient_sky[c], inAll({}), 1e-4);
  }
}

TEST(EnvironmentLight, LampsAreFoundStrongestFirst) {
  app::RadiancePicture picture = evenly(256, 0.05f);
  addPatch(picture, 64, 32, 3, {90, 80, 70});   // left of the middle by 90 degrees: +x; 45 degrees up
  addPatch(picture, 128, 64, 3, {20, 20, 20});  // the middle: +z
  addPatch(picture, 210, 60, 3, {8, 10, 12});
  const render::LightInput light = app::environmentLight("lamps", picture, {});
  EXPECT_NEAR(light.to_light[0], std::sqrt(0.5), 0.06);
  EXPECT_NEAR(light.to_light[1], std::sqrt(0.5), 0.06);
  EXPECT_NEAR(light.to_light[2], 0, 0.06);
  EXPECT_GT(light.to_fill[2], 0.99);
  EXPECT_GT(light.key[0], 2 * light.fill[0]);
  EXPECT_GT(light.fill[0], light.rim[0]);
  EXPECT_GT(light.rim[2], light.rim[0]) << "a lamp keeps its colour";
  EXPECT_GT(light.key[0], light.key[2]);
  EXPECT_NEAR(inAll(light), inAll({}), 1e-5);
}

TEST(EnvironmentLight, SkyIsBrighterThanGroundWhereItIs) {
  app::RadiancePicture picture = evenly(64, 1.0f);
  for (std::size_t i = 0; i < picture.rgb.size() / 2; ++i) picture.rgb[i] = 3.0f;
  const render::LightInput light = app::environmentLight("sky", picture, {});
  EXPECT_GT(light.ambient_sky[1], 1.5 * light.ambient_ground[1]);
  EXPECT_NEAR(inAll(light), inAll({}), 1e-5);
  EXPECT_EQ(app::environmentLight("sky", picture, {.shadow_size = 777}).shadow_size, 777);
}

TEST(EnvironmentLight, TheBrightestThatAFileCanHoldAndTheSmallestPanorama) {
  app::RadiancePicture picture = evenly(2, 1.7e38f);
  picture.rgb[0] = 0;
  const render::LightInput light = app::environmentLight("bright", picture, {});
  EXPECT_TRUE(std::isfinite(inAll(light)));
  EXPECT_NEAR(inAll(light), inAll({}), 1e-5);
}

TEST(EnvironmentLight, PackedRowsHoldWhatFlatOnesDo) {
  std::string flat = header("-Y 8 +X 16"), packed = flat;
  for (int y = 0; y < 8; ++y) {
    for (int x = 0; x < 16; ++x) flat += std::string{char(100), char(x < 5 ? 7 : 9), char(3), char(129)};
    packed += std::string{char(2), char(2), char(0), char(16)};
    packed += std::string{char(128 + 16), char(100)};
    packed += std::string{char(128 + 5), char(7), char(3), char(9), char(9), char(9), char(128 + 8), char(9)};
    packed += std::string{char(128 + 16), char(3)} + std::string{char(128 + 16), char(129)};
  }
  const app::RadiancePicture a = app::readRadiance(written("flat.hdr", flat)),
                             b = app::readRadiance(written("packed.hdr", packed));
  EXPECT_EQ(a.width, 16);
  EXPECT_FLOAT_EQ(a.rgb[0], 100 / 128.0f);
  EXPECT_EQ(a.rgb, b.rgb);
  for (std::size_t length = 45; length + 1 < packed.size(); length += 7)
    EXPECT_NE(refusal("cut.hdr", packed.substr(0, length)), "read") << length << " bytes";
}

TEST(EnvironmentLight, WhatIsNoPanoramaIsRefusedByName) {
  const auto saysOf = [](const std::string& what, const std::string& name, const std::string& bytes) {
    const std::string text = refusal(name, bytes);
    EXPECT_NE(text.find(name), std::string::npos) << text;
    EXPECT_NE(text.find(what), std::string::npos) << text;
  };
  saysOf("is no Radiance picture's", "picture.hdr", "\x89PNG and more\n");
  saysOf("lacks FORMAT", "format.hdr", "#?RADIANCE\n\n-Y 1 +X 2\n12341234");
  saysOf("is not -Y HEIGHT +X WIDTH", "upside.hdr", header("+Y 1 +X 2") + "12341234");
  saysOf("is not -Y HEIGHT +X WIDTH", "negative.hdr", header("-Y -1 +X 2"));
  saysOf("larger than 8192", "huge.hdr", header("-Y 400000 +X 800000"));
  saysOf("broken off", "short.hdr", header("-Y 64 +X 128") + "12341234");
  saysOf("twice as wide", "square.hdr", header("-Y 1 +X 1") + "1234");
  saysOf("black everywhere", "black.hdr", header("-Y 1 +X 2") + std::string(8, '\0'));
}

}  // namespace environment_light_test
