#include "tests/bench/draw_picture.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>

namespace bench {
namespace {

using Color = std::array<double, 3>;

constexpr int kBlock = 8;            // pixels
constexpr double kBrightest = 0.99;  // of the film curve, as shaders/common/film.glsl inverts it

double decodeSrgb(double coded) {
  return coded > 0.04045 ? std::pow((coded + 0.055) / 1.055, 2.4) : coded / 12.92;
}

double encodeSrgb(double linear) {
  return linear > 0.0031308 ? 1.055 * std::pow(linear, 1 / 2.4) - 0.055 : 12.92 * linear;
}

// The curve of shaders/common/film.glsl, and its inverse.
double film(double x) {
  return std::clamp(x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14), 0.0, 1.0);
}

double filmInverse(double y) {
  y = std::clamp(y, 0.0, kBrightest);
  const double a = 2.51 - 2.43 * y, b = 0.03 - 0.59 * y, c = -0.14 * y;
  return (-b + std::sqrt(std::max(b * b - 4 * a * c, 0.0))) / (2 * a);
}

double radianceOf(float level) {
  return filmInverse(decodeSrgb(std::clamp(level / 255.0, 0.0, 1.0)));
}

float levelOf(double radiance) {
  return static_cast<float>(255 * encodeSrgb(film(radiance)));
}

double squaredError(const LevelPicture& a, const LevelPicture& b, int x0, int y0, double& block) {
  double squares = 0;
  Color sum{};
  const int x1 = std::min(x0 + kBlock, a.width), y1 = std::min(y0 + kBlock, a.height);
  for (int y = y0; y < y1; ++y) {
    for (int x = x0; x < x1; ++x) {
      for (int k = 0; k < 3; ++k) {
        const std::size_t at = 3 * (static_cast<std::size_t>(y) * a.width + x) + k;
        const double off = a.levels[at] - b.levels[at];
        squares += off * off;
        sum[k] += off;
      }
    }
  }
  const double pixels = (x1 - x0) * (y1 - y0);
  for (const double off : sum) block += off * off / pixels;
  return squares;
}

}  // namespace

LevelPicture levelsOf(int width, int height, const std::vector<unsigned char>& rgba) {
  LevelPicture picture{width, height, {}};
  picture.levels.reserve(rgba.size() / 4 * 3);
  for (std::size_t i = 0; i < rgba.size(); ++i) {
    if (i % 4 != 3) picture.levels.push_back(rgba[i]);
  }
  return picture;
}

LevelPicture averagedDown(const LevelPicture& larger, int finer, Half half) {
  LevelPicture picture{larger.width / finer, larger.height / finer, {}};
  picture.levels.reserve(3 * static_cast<std::size_t>(picture.width) * picture.height);
  std::array<double, 256> radiance{};
  for (int level = 0; level < 256; ++level) radiance[level] = radianceOf(static_cast<float>(level));
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      Color sum{};
      double weights = 0;
      for (int j = 0; j < finer; ++j) {
        for (int i = 0; i < finer; ++i) {
          if (half != Half::kAll && ((i + j) % 2 == 0) != (half == Half::kEven)) continue;
          const float* at =
              &larger.levels[3 * (static_cast<std::size_t>(y * finer + j) * larger.width + x * finer + i)];
          Color color{};
          for (int k = 0; k < 3; ++k) color[k] = radiance[static_cast<std::size_t>(at[k])];
          const double weight = 1 / (1 + 0.2126 * color[0] + 0.7152 * color[1] + 0.0722 * color[2]);
          for (int k = 0; k < 3; ++k) sum[k] += weight * color[k];
          weights += weight;
        }
      }
      for (int k = 0; k < 3; ++k) picture.levels.push_back(levelOf(sum[k] / weights));
    }
  }
  return picture;
}

PictureError differenceOf(const LevelPicture& a, const LevelPicture& b) {
  assert(a.width == b.width && a.height == b.height);
  double squares = 0, blocks = 0;
  for (int y = 0; y < a.height; y += kBlock) {
    for (int x = 0; x < a.width; x += kBlock) squares += squaredError(a, b, x, y, blocks);
  }
  const auto count = static_cast<double>(std::max<std::size_t>(a.levels.size(), 1));
  return {std::sqrt(squares / count), std::sqrt(blocks / count)};
}

}  // namespace bench
