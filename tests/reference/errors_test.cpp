#include "tests/reference/errors.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace reference_errors_test {

using reference::DrawnPixel, reference::TracedPixel;

// The truth's own noise is taken off: a picture that draws it exactly has no error, however few samples told of it.
TEST(ReferenceErrors, CoverOfANoisyTruthIsNoError) {
  const int samples = 16, pixels = 40000;
  std::mt19937 random(5);
  std::vector<TracedPixel> traced(pixels);
  std::vector<DrawnPixel> drawn(pixels);
  for (int i = 0; i < pixels; ++i) {
    const float cover = static_cast<float>(i % 10) / 9;
    std::binomial_distribution<int> seen(samples, cover);
    traced[i].samples = samples;
    traced[i].cover = static_cast<float>(seen(random)) / samples;
    drawn[i].cover = cover;
  }
  const reference::CoverError exact = reference::coverError(traced, drawn);
  EXPECT_NEAR(exact.ratio, 1, 0.005);
  EXPECT_LT(exact.rms, 0.008f);
  for (DrawnPixel& pixel : drawn) pixel.cover *= 0.8f;
  const reference::CoverError thin = reference::coverError(traced, drawn);
  EXPECT_NEAR(thin.ratio, 0.8, 0.005);
  EXPECT_NEAR(thin.rms, 0.2 * std::sqrt((0 + 1 + 4 + 9 + 16 + 25 + 36 + 49 + 64 + 81) / 81.0 / 9), 0.005);
}

// Pixels that neither picture covers say nothing.
TEST(ReferenceErrors, EmptyPixelsDoNotCount) {
  std::vector<TracedPixel> traced(100);
  std::vector<DrawnPixel> drawn(100);
  traced[0].cover = 1;
  drawn[0].cover = 0.5f;
  EXPECT_FLOAT_EQ(reference::coverError(traced, drawn).rms, 0.5f);
}

// Only full pixels without a lit sample count, each light by itself, and skin apart from hair.
TEST(ReferenceErrors, LeaksAreWhatIsDrawnWhereNoLightComes) {
  std::vector<TracedPixel> traced(4);
  std::vector<DrawnPixel> drawn(4);
  for (int i = 0; i < 3; ++i) traced[i].cover = drawn[i].cover = 1;
  drawn[0].lit = {0.5f, 0, 0, 0.004f};
  traced[1].lit = {0, 1, 1, 1};
  drawn[1].lit = {0.1f, 1, 1, 1};
  drawn[2].cover = 0.5f;  // a pixel that is not full
  drawn[2].lit = {1, 1, 1, 1};
  traced[3].skin = {1, 1, 0, 1};  // away from the third light
  traced[3].skin_lit = {0, 0.5f, 0, 0};
  drawn[3].skin = 0.95f;
  drawn[3].skin_lit = {0.19f, 0.5f, 0.5f, 0};
  const reference::Leaks hair = reference::hairLeaks(traced, drawn), skin = reference::skinLeaks(traced, drawn);
  EXPECT_TRUE(hair.pixels.isApprox(Eigen::Vector4f(2, 1, 1, 1))) << hair.pixels.transpose();
  EXPECT_TRUE(hair.mean.isApprox(Eigen::Vector4f(0.3f, 0, 0, 0.004f))) << hair.mean.transpose();
  EXPECT_TRUE(hair.above.isApprox(Eigen::Vector4f(1, 0, 0, 0))) << hair.above.transpose();
  EXPECT_TRUE(skin.pixels.isApprox(Eigen::Vector4f(1, 0, 0, 1))) << skin.pixels.transpose();
  EXPECT_TRUE(skin.mean.isApprox(Eigen::Vector4f(0.2f, 0, 0, 0))) << skin.mean.transpose();
}

}  // namespace reference_errors_test
