// What the screen shows of a radiance, by the published formulas: debug shapes keep their colour, edges weigh samples.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "render/renderer.h"
#include "tests/gl_fixture.h"

namespace tone_test {

using Color = std::array<double, 3>;

constexpr int kSide = 64, kSamples = 4;

// IEC 61966-2-1.
double coded(double linear) {
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}
double decoded(double value) {
  return value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4);
}

// Narkowicz 2015.
double film(double x) {
  return x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14);
}

// The radiance that the film shows so bright, by halving.
double radianceShownAs(double shown) {
  double low = 0, high = 100;
  for (int k = 0; k < 100; ++k) (film((low + high) / 2) < shown ? low : high) = (low + high) / 2;
  return low;
}

// What a pixel shows of a radiance that `covered` of its samples have, the others being black: samples weigh 1 / (1 +
// luminance) (Karis 2013, luminance by ITU-R BT.709).
Color edgeOf(const Color& radiance, int covered) {
  const double weight = 1 / (1 + 0.2126 * radiance[0] + 0.7152 * radiance[1] + 0.0722 * radiance[2]);
  Color shown{};
  for (int c = 0; c < 3; ++c)
    shown[c] = coded(film(covered * weight * radiance[c] / (covered * weight + kSamples - covered)));
  return shown;
}

class Tone : public gl_fixture::GlTest {
 protected:
  // A triangle before a black backdrop, seen from straight ahead: corners in halves of the picture.
  static std::vector<unsigned char> drawTriangle(const std::array<std::array<float, 2>, 3>& corners, const Color& color,
                                                 float exposure) {
    static render::Renderer renderer(gl_fixture::kShaderDir);
    render::FrameInput frame;
    frame.width = frame.height = kSide;
    frame.camera.eye = {0, 0, 1};
    frame.camera.target = {0, 0, 0};
    frame.view.backdrop_top = frame.view.backdrop_bottom = {0, 0, 0};
    frame.view.ground = false;
    frame.view.samples = kSamples;
    frame.view.exposure = exposure;
    const float half = std::tan(0.5f * frame.camera.fov_y);
    std::vector<render::LineVertex> triangle;
    for (const auto& corner : corners) {
      triangle.push_back(
          {{half * corner[0], half * corner[1], 0},
           {static_cast<float>(color[0]), static_cast<float>(color[1]), static_cast<float>(color[2]), 1}});
    }
    frame.debug_triangles = triangle;
    std::vector<unsigned char> rgba;
    renderer.renderImage(frame, rgba);
    return rgba;
  }
};

TEST_F(Tone, DebugShapesKeepTheirColourAtAnyExposure) {
  const Color color{0.85, 0.3, 0.12};
  for (const float exposure : {0.5f, 1.0f, 1.25f, 3.0f}) {
    const std::vector<unsigned char> rgba = drawTriangle({{{-9, -9}, {9, -9}, {0, 9}}}, color, exposure);
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(rgba[4 * (kSide * kSide / 2 + kSide / 2) + c], 255 * color[c], 1.6) << exposure << " " << c;
  }
}

TEST_F(Tone, EdgesWeighTheirSamplesByLuminance) {
  for (const Color& color : {Color{0.97, 0.2, 0.1}, Color{0.1, 0.97, 0.2}, Color{0.2, 0.1, 0.97}}) {
    Color radiance;
    for (int c = 0; c < 3; ++c) radiance[c] = radianceShownAs(decoded(color[c]));
    const std::vector<unsigned char> rgba = drawTriangle({{{-0.8f, -0.7f}, {0.9f, -0.31f}, {-0.13f, 0.83f}}}, color, 1);
    int edges = 0;
    for (std::size_t pixel = 0; pixel < rgba.size(); pixel += 4) {
      double nearest = 255;
      int covered = 0;
      for (int k = 0; k <= kSamples; ++k) {
        double off = 0;
        for (int c = 0; c < 3; ++c) off = std::max(off, std::abs(rgba[pixel + c] - 255 * edgeOf(radiance, k)[c]));
        if (off < nearest) nearest = off, covered = k;
      }
      EXPECT_LT(nearest, 2) << "pixel " << pixel / 4 << ", " << covered << " samples covered";
      edges += covered > 0 && covered < kSamples;
    }
    EXPECT_GT(edges, 30);
  }
}

}  // namespace tone_test
