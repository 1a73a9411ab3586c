// Golden images: compared by a maximum difference and a count of outliers, the difference image kept on failure, the
// renderer that drew the golden named beside it. HAIRMESH_UPDATE_GOLDEN=1 rewrites them.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "app/files/image_io.h"

namespace golden {

// How two images differ, per channel of 0..255.
struct Difference {
  int largest = 0;
  long outliers = 0;  // pixels with a channel off by more than the tolerance
  double mean = 0;    // over all channels
};

inline Difference compare(const app::Image& a, const app::Image& b, int tolerance) {
  Difference difference{255, static_cast<long>(a.rgba.size() / 4), 255.0};
  if (a.width != b.width || a.height != b.height) return difference;
  difference = {};
  for (std::size_t pixel = 0; pixel < a.rgba.size(); pixel += 4) {
    int worst = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      const int off = std::abs(static_cast<int>(a.rgba[pixel + c]) - static_cast<int>(b.rgba[pixel + c]));
      worst = std::max(worst, off);
      difference.mean += off;
    }
    difference.largest = std::max(difference.largest, worst);
    difference.outliers += worst > tolerance;
  }
  difference.mean /= static_cast<double>(a.rgba.size()) * 0.75;
  return difference;
}

// The difference, four times amplified around grey.
inline app::Image differenceImage(const app::Image& a, const app::Image& b) {
  app::Image image{a.width, a.height, std::vector<unsigned char>(a.rgba.size(), 255)};
  for (std::size_t i = 0; i < a.rgba.size() && i < b.rgba.size(); ++i) {
    if (i % 4 == 3) continue;
    image.rgba[i] = static_cast<unsigned char>(std::clamp(128 + 4 * (static_cast<int>(a.rgba[i]) - b.rgba[i]), 0, 255));
  }
  return image;
}

struct Limits {
  int tolerance = 12;            // levels a pixel may be off before it is an outlier
  double outlier_share = 0.002;  // of all pixels
};

// Holds `image` to tests/golden/<name>.png. Another renderer than the golden's draws edges a little differently: the
// limits are then loosened, and a note says so.
inline void expectGolden(const app::Image& image, const std::string& name, const std::string& renderer) {
  const std::string base = std::string(HAIRMESH_SOURCE_DIR) + "/tests/golden/" + name;
  if (std::getenv("HAIRMESH_UPDATE_GOLDEN") != nullptr) {
    app::writePng(base + ".png", image.width, image.height, image.rgba);
    std::ofstream(base + ".json") << nlohmann::json{{"renderer", renderer}}.dump(2) << "\n";
    return;
  }
  ASSERT_TRUE(std::filesystem::exists(base + ".png")) << base << ".png is missing; HAIRMESH_UPDATE_GOLDEN=1 writes it";
  const app::Image expected = app::readPng(base + ".png");
  const std::string drawn_by = nlohmann::json::parse(std::ifstream(base + ".json")).at("renderer");
  Limits limits;
  if (drawn_by != renderer) {
    limits = {40, 0.06};
    std::printf("note: %s was drawn by %s, this is %s: limits loosened\n", name.c_str(), drawn_by.c_str(),
                renderer.c_str());
  }
  const Difference difference = compare(expected, image, limits.tolerance);
  const auto pixels = static_cast<double>(image.width) * image.height;
  if (static_cast<double>(difference.outliers) <= limits.outlier_share * pixels) return;
  const std::string out = std::string(HAIRMESH_TEST_OUT) + "/" + name;
  std::filesystem::create_directories(HAIRMESH_TEST_OUT);
  app::writePng(out + ".png", image.width, image.height, image.rgba);
  const app::Image shown = differenceImage(expected, image);
  app::writePng(out + "_difference.png", shown.width, shown.height, shown.rgba);
  ADD_FAILURE() << name << ": " << difference.outliers << " pixels off by more than " << limits.tolerance
                << " levels (largest " << difference.largest << ", mean " << difference.mean << "); see " << out
                << "_difference.png";
}

}  // namespace golden
