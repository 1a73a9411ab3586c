// The rasterizers of the software path, against what they should fill, sample by sample.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "render/software/line_raster.h"
#include "render/software/strand_raster.h"
#include "shaders/shared.h"

namespace raster_test {

constexpr int kSide = 16;

struct Picture {
  std::vector<render::SampledPixel> pixels = std::vector<render::SampledPixel>(kSide * kSide);
  render::SampleGrid grid{pixels, kSide, kSide, {}};

  Picture() {
    grid.pattern.count = 4;
    grid.pattern.x = {0.375f, 0.875f, 0.125f, 0.625f};
    grid.pattern.y = {0.125f, 0.375f, 0.625f, 0.875f};
    render::clearSamples({0, 0, kSide, kSide}, grid);
  }
  int covered() const {
    int count = 0;
    for (const render::SampledPixel& pixel : pixels)
      for (const float depth : pixel.depth) count += depth < 1;
    return count;
  }
};

// A ribbon through points, each with its half width across it.
std::vector<render::RibbonEdges> ribbon(const std::vector<std::array<float, 2>>& middle, std::array<float, 2> aside,
                                        float depth, float coverage = 1) {
  std::vector<render::RibbonEdges> points;
  for (const auto& [x, y] : middle)
    points.push_back({x - aside[0], y - aside[1], x + aside[0], y + aside[1], depth, coverage, {}});
  return points;
}

render::PixelBox fill(const std::vector<render::RibbonEdges>& points, Picture& picture, std::uint32_t first = 0) {
  const render::StoredStrand strand{static_cast<std::uint32_t>(points.size()), 0.5f, 0, 0, {}};
  return render::rasterizeStrands({{&strand, 1}, points, static_cast<std::uint32_t>(points.size()), first},
                                  picture.grid);
}

TEST(StrandRaster, ARibbonTakesTheSamplesInsideIt) {
  Picture picture;
  fill(ribbon({{2, 5}, {9, 5}, {14, 5}}, {0, 2}, 0.5f), picture);
  EXPECT_EQ(picture.covered(), 4 * 12 * 4);  // 12 pixels by 4, four samples each; no gap where segments meet
}

// Turned over itself, a step is two triangles; turned about, the same ribbon backwards.
TEST(StrandRaster, EitherTurnIsFilled) {
  Picture forwards, backwards;
  fill(ribbon({{2.3f, 4.1f}, {9.2f, 7.7f}}, {0.4f, -1.1f}, 0.5f), forwards);
  fill(ribbon({{9.2f, 7.7f}, {2.3f, 4.1f}}, {0.4f, -1.1f}, 0.5f), backwards);
  EXPECT_GT(forwards.covered(), 40);
  EXPECT_EQ(forwards.covered(), backwards.covered());
  Picture crossed;
  std::vector<render::RibbonEdges> points = ribbon({{2, 5}, {12, 5}}, {0, 2}, 0.5f);
  std::swap(points[1].left_y, points[1].right_y);
  fill(points, crossed);
  EXPECT_GT(crossed.covered(), 0);
  EXPECT_LT(crossed.covered(), 4 * 10 * 4);
}

TEST(StrandRaster, TheNearestIsShownWithItsSegmentAndShare) {
  Picture picture;
  fill(ribbon({{0, 8}, {16, 8}}, {0, 4}, 0.5f), picture, 100);
  fill(ribbon({{8, 0}, {8, 8}, {8, 16}}, {2, 0}, 0.3f), picture, 200);
  fill(ribbon({{0, 8}, {16, 8}}, {0, 8}, 0.7f), picture, 300);
  const auto at = [&](int x, int y) { return picture.pixels[static_cast<std::size_t>(y * kSide + x)].shown[0]; };
  EXPECT_EQ(at(1, 8) >> 8u, 100u);
  EXPECT_EQ(at(8, 5) >> 8u, 200u);
  EXPECT_EQ(at(8, 11) >> 8u, 201u);
  EXPECT_EQ(at(1, 1) >> 8u, 300u);
  EXPECT_NEAR(static_cast<float>(at(8, 11) & 255u) / 255, 3.5f / 8, 0.01f);
  std::vector<std::uint8_t> seen(400, 0);
  render::markSeen({0, 0, kSide, kSide}, picture.grid, seen);
  for (const std::size_t point : {100, 101, 200, 201, 202, 300, 301}) EXPECT_EQ(seen[point], 1) << point;
  EXPECT_EQ(seen[203] + seen[102] + seen[0], 0);
  render::clearSamples({0, 0, kSide, kSide}, picture.grid);
  EXPECT_EQ(picture.covered(), 0);
}

TEST(StrandRaster, AThinStrandTakesItsShareOfSamples) {
  Picture whole, half;
  fill(ribbon({{0, 8}, {16, 8}}, {0, 8}, 0.5f), whole);
  fill(ribbon({{0, 8}, {16, 8}}, {0, 8}, 0.5f, 0.5f), half);
  EXPECT_EQ(whole.covered(), 4 * kSide * kSide);
  EXPECT_EQ(half.covered(), 2 * kSide * kSide);
}

TEST(StrandRaster, OutsideAndBeforeTheNearPlaneNothingIsFilled) {
  Picture picture;
  EXPECT_TRUE(fill(ribbon({{-9, 8}, {-1.5f, 8}}, {0, 2}, 0.5f), picture).empty());
  EXPECT_TRUE(fill(ribbon({{2, 40}, {9, 1e7f}}, {0, 2}, 0.5f), picture).empty());
  fill(ribbon({{2, 8}, {9, 8}}, {0, 2}, -1.0f), picture);
  EXPECT_EQ(picture.covered(), 0);
  fill(ribbon({{-1e6f, 8}, {1e6f, 8}}, {0, 2}, 0.5f), picture);
  EXPECT_EQ(picture.covered(), 4 * kSide * 4);
}

render::OpacityTile cast(const std::vector<std::vector<render::LinePoint>>& strands) {
  std::vector<std::uint32_t> counts;
  std::vector<render::LinePoint> points;
  std::size_t stride = 0;
  for (const auto& strand : strands) stride = std::max(stride, strand.size());
  for (const auto& strand : strands) {
    counts.push_back(static_cast<std::uint32_t>(strand.size()));
    points.insert(points.end(), strand.begin(), strand.end());
    points.resize(counts.size() * stride);
  }
  render::OpacityTile tile;
  tile.side = kSide;
  tile.depth_range = 1;
  tile.thickness = 0.01f;
  render::rasterizeLines({counts, points, static_cast<std::uint32_t>(stride)}, tile);
  return tile;
}

// A line takes one texel a step of its longer axis, and none twice where segments meet.
TEST(LineRaster, ALineTakesATexelAStep) {
  const render::OpacityTile tile =
      cast({{{1.2f, 3.3f, 0.5f, 0}, {6.7f, 5.1f, 0.5f, 1}, {13.4f, 9.9f, 0.5f, 1}, {14.0f, 15.6f, 0.5f, 1}}});
  float sum = 0;
  for (const auto& far : tile.far) {
    EXPECT_LE(far[3], 2.0f);
    sum += far[3];
  }
  EXPECT_NEAR(sum, 12 + 6, 1.1f);
}

// A second hair lies in the layers that reach behind it, and in the channel of all hair.
TEST(LineRaster, LayersHoldWhatLiesInThem) {
  const auto across = [](float depth) {
    return std::vector<render::LinePoint>{{0, 8.5f, depth, 0}, {16, 8.5f, depth, 0.25f}};
  };
  const render::OpacityTile tile = cast({across(0.52f), across(0.5f)});
  const std::size_t at = 8 * kSide + 5;
  EXPECT_FLOAT_EQ(tile.depth[at], 0.5f);
  EXPECT_FLOAT_EQ(tile.depth[0], 1.0f);
  EXPECT_FLOAT_EQ(tile.near[at][0], 0.25f);          // to 1 cm
  EXPECT_FLOAT_EQ(tile.near[at][1], 0.25f + 0.25f);  // to 2.5 cm
  EXPECT_FLOAT_EQ(tile.far[at][2], 0.5f);
  EXPECT_FLOAT_EQ(tile.far[at][3], 0.5f);
  EXPECT_FLOAT_EQ(tile.near[0][0] + tile.far[0][3], 0);
}

// Strands every way over a picture, some of them beyond its edges.
std::vector<render::RibbonEdges> scatteredPoints(std::size_t count, float side) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> place(-0.2f * side, 1.2f * side), share(0, 1);
  std::vector<render::RibbonEdges> points;
  for (std::size_t k = 0; k < count; ++k) {
    const float x = place(random), y = place(random);
    points.push_back({x, y, x + 2 * share(random), y + 2 * share(random), share(random), share(random), {}});
  }
  return points;
}

TEST(StrandRaster, BandsChangeNoSample) {
  constexpr int kWidth = 90, kHeight = 170;
  constexpr std::uint32_t kStride = 6;
  const std::vector<render::RibbonEdges> points = scatteredPoints(300 * kStride, 170);
  const std::vector<render::StoredStrand> strands(300, {kStride, 0.3f, 0, 0});
  const auto drawn = [&](int bands) {
    std::vector<render::SampledPixel> pixels(kWidth * kHeight);
    render::SampleGrid grid{pixels, kWidth, kHeight, Picture().grid.pattern};
    render::clearSamples({0, 0, kWidth, kHeight}, grid);
    const render::PixelBox box = render::rasterizeStrands({strands, points, kStride, 0}, grid, bands);
    EXPECT_EQ(box.high_x - box.low_x + box.high_y - box.low_y, kWidth + kHeight);
    std::vector<std::uint32_t> shown;
    for (const render::SampledPixel& pixel : pixels) shown.insert(shown.end(), pixel.shown.begin(), pixel.shown.end());
    return shown;
  };
  const std::vector<std::uint32_t> whole = drawn(1);
  EXPECT_GT(std::count_if(whole.begin(), whole.end(), [](std::uint32_t s) { return s > 0; }), kWidth * kHeight);
  for (const int bands : {2, 3, 8}) EXPECT_EQ(drawn(bands), whole) << bands << " bands";
}

TEST(StrandRaster, BandsLeaveNoRowBetweenThem) {
  constexpr int kWidth = 4, kHeight = 300;
  for (const int bands : {1, 2, 3}) {
    std::vector<render::SampledPixel> pixels(kWidth * kHeight);
    render::SampleGrid grid{pixels, kWidth, kHeight, Picture().grid.pattern};
    render::clearSamples({0, 0, kWidth, kHeight}, grid);
    const render::StoredStrand strand{2, 0.5f, 0, 0};
    render::rasterizeStrands({{&strand, 1}, ribbon({{2, -1}, {2, 301}}, {3, 0}, 0.5f), 2, 0}, grid, bands);
    for (std::size_t at = 0; at < pixels.size(); ++at) {
      for (const float depth : pixels[at].depth) ASSERT_LT(depth, 1) << bands << " bands, row " << at / kWidth;
    }
  }
}

TEST(LineRaster, BandsChangeNoTexel) {
  constexpr std::uint32_t kStride = 6;
  std::vector<render::LinePoint> points;
  for (const render::RibbonEdges& point : scatteredPoints(300 * kStride, 64))
    points.push_back({point.left_x, point.left_y, point.depth, point.coverage});
  const std::vector<std::uint32_t> counts(300, kStride);
  const auto drawn = [&](int bands) {
    render::OpacityTile tile;
    tile.side = 64;
    render::rasterizeLines({counts, points, kStride}, tile, bands);
    return tile;
  };
  const render::OpacityTile whole = drawn(1);
  EXPECT_GT(std::count_if(whole.far.begin(), whole.far.end(), [](const auto& far) { return far[3] > 0; }), 64 * 32);
  for (const int bands : {2, 3, 8}) {
    const render::OpacityTile tile = drawn(bands);
    EXPECT_EQ(tile.depth, whole.depth);
    EXPECT_EQ(tile.near, whole.near);
    EXPECT_EQ(tile.far, whole.far);
  }
}

}  // namespace raster_test
