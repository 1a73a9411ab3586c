// Strands grown on the CPU against those of the geometry stage, read back by transform feedback, with every variation
// on.
#include "render/strands/strand_growth.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "app/scene/sim_to_render.h"
#include "app/styles/hair_styles.h"
#include "render/gl/driver.h"
#include "tests/analytic_head.h"
#include "tests/gl_fixture.h"
#include "tests/strand_capture.h"
#include "tests/synthetic_hair.h"

namespace strand_growth_test {

using Eigen::Vector3f;
using render::CurvePoint;
using render::StrandGrowth;
using strand_capture::Polyline;

// Every variation at once, each larger than its default.
render::HairLook variedLook() {
  render::HairLook look;
  look.length_variation = 0.2f;
  look.offset = 0.0013f;
  look.clump = 0.8f;
  look.curl_radius = 0.003f;
  look.curl_pitch = 0.06f;
  look.lock = look.wisp = 0.6f;
  look.drift = 0.004f;
  look.wave_height = 0.005f;
  look.wave_length = 0.08f;
  look.hairline = 0.015f;
  look.frizz = 0.0015f;
  look.flyaways = 0.1f;
  look.seed = 7;
  return look;
}

// A hair at rest and in a pose, both at the height of a head.
struct PosedHair {
  std::vector<render::HairFace> faces;
  std::vector<float> rest, posed;
  float length = 0;  // m, of the longest column at rest

  render::HairInput input(int strands) const {
    render::HairInput hair;
    hair.id = hair.layout_revision = hair.position_revision = 1;
    hair.faces = faces;
    hair.positions = posed;
    hair.rest = rest;
    hair.strands = strands;
    hair.look = variedLook();
    return hair;
  }
};

PosedHair posedStyle(app::Style style, app::Resolution resolution) {
  const sim::HairMesh mesh =
      sim::buildHairMesh(app::makeStyle(style, resolution, tests::analyticScalp(), tests::bodyDistance));
  PosedHair hair;
  hair.faces = app::renderFaces(mesh);
  for (std::size_t f = 0; f < hair.faces.size(); f += 3) hair.faces[f].covered = true;
  for (const sim::Vec3& p : mesh.shape.positions) {
    const Vector3f q = p.cast<float>();
    hair.rest.insert(hair.rest.end(), {q.x(), q.y() + 1.6f, q.z()});
    // Swept aside and lifted by the square of the depth, as hair in motion.
    const float deep = std::max(0.05f - q.y(), 0.0f);
    hair.posed.insert(hair.posed.end(), {q.x() + 1.5f * deep * deep, q.y() + 1.6f + 0.8f * deep * deep,
                                         q.z() - 0.3f * deep + 0.02f * std::sin(20 * q.x())});
  }
  for (int c = 0; c < mesh.columnCount(); ++c) {
    double length = 0;
    for (int v = mesh.shape.column_first[c] + 1; v < mesh.shape.column_first[c + 1]; ++v)
      length += (mesh.shape.positions[v] - mesh.shape.positions[v - 1]).norm();
    hair.length = std::max(hair.length, static_cast<float>(length));
  }
  return hair;
}

StrandGrowth growthOf(const render::HairInput& input) {
  StrandGrowth growth(input.faces, input.rest, input.strands, input.segments_per_layer, input.look);
  EXPECT_TRUE(growth.setPositions(input.positions));
  return growth;
}

std::vector<CurvePoint> grown(const StrandGrowth& growth, int number) {
  std::vector<CurvePoint> points(static_cast<std::size_t>(growth.maxPoints()));
  points.resize(static_cast<std::size_t>(growth.growDrawn(growth.strand(number), points)));
  return points;
}

struct Comparison {
  float worst = 0;  // m, of the strands that agree in their clump
  int other = 0;    // strands that do not: roots on the border of two clumps, where the last bit decides
  int differ = 0;   // in their number of points
};

Comparison compare(const StrandGrowth& growth, const std::vector<Polyline>& captured) {
  constexpr float kOtherClump = 1e-4f;  // m
  Comparison result;
  for (int number = 0; number < growth.strandCount(); ++number) {
    const std::vector<CurvePoint> mine = grown(growth, number);
    const Polyline& theirs = captured[static_cast<std::size_t>(number)];
    result.differ += mine.size() != theirs.size();
    if (mine.size() != theirs.size()) continue;
    float worst = 0;
    for (std::size_t i = 0; i < mine.size(); ++i) {
      worst = std::max(worst, (mine[i].position - theirs[i]).norm());
    }
    if (worst > kOtherClump)
      ++result.other;
    else
      result.worst = std::max(result.worst, worst);
  }
  return result;
}

class StrandGrowthOnGpu : public gl_fixture::GlTest {};

TEST_F(StrandGrowthOnGpu, AgreesWithTheShadersForEveryStyle) {
  using enum app::Style;
  using enum app::Resolution;
  for (const app::Style style : {kShort, kShoulder, kLong, kBob, kPixie}) {
    for (const app::Resolution resolution : {kMinimal, kLow, kMedium, kHigh, kUltra}) {
      SCOPED_TRACE(std::string(app::styleName(style)) + " " + std::to_string(static_cast<int>(resolution)));
      const PosedHair hair = posedStyle(style, resolution);
      const render::HairInput input = hair.input(3000);
      const Comparison result = compare(growthOf(input), strand_capture::capture(input, gl_fixture::kShaderDir));
      // Where a strand runs along its frame's side a last bit turns what it leaves its guide by: 7.8e-5 for one strand of
      // 75,000 on a GPU, of the bob's at minimal, 4.7e-5 for one in software, of the pixie's at low.
      const float bound = !render::rasterizesInSoftware() ? 1e-4f : style == kPixie ? 5e-5f : 1e-5f;
      EXPECT_LT(result.worst, bound * hair.length);
      EXPECT_LE(result.other, 3);
      EXPECT_EQ(result.differ, 0);
    }
  }
}

TEST_F(StrandGrowthOnGpu, AgreesWithTheShadersOverTrianglesAndShortBundles) {
  PosedHair hair;
  synthetic::Hair source = synthetic::makeHair(18);
  for (std::size_t face = 30; face < source.faces.size(); face += 2) source.faces[face].layers -= 3;
  hair.faces = source.faces;
  hair.rest = hair.posed = source.positions;
  render::HairInput input = hair.input(4000);
  for (const int segments : {1, 3, 8}) {
    input.segments_per_layer = segments;
    const Comparison result = compare(growthOf(input), strand_capture::capture(input, gl_fixture::kShaderDir));
    EXPECT_LT(result.worst, 1e-5f * 0.3f) << segments;
    EXPECT_LE(result.other, 4);
    EXPECT_EQ(result.differ, 0);
  }
}

TEST(StrandGrowth, GrowsASubsetInAnyOrderToTheSameBits) {
  const PosedHair hair = posedStyle(app::Style::kShoulder, app::Resolution::kLow);
  const StrandGrowth growth = growthOf(hair.input(500));
  std::vector<int> order(500);
  std::iota(order.begin(), order.end(), 0);
  const auto tip = [&](int number) {
    const std::vector<CurvePoint> points = grown(growth, number);
    return points.empty() ? Vector3f::Zero().eval() : points.back().position;  // none where the hairline thins out
  };
  std::vector<Vector3f> forward(500), backward(500);
  for (const int n : order) forward[static_cast<std::size_t>(n)] = tip(n);
  std::reverse(order.begin(), order.end());
  for (const int n : order) backward[static_cast<std::size_t>(n)] = tip(n);
  EXPECT_EQ(forward, backward);
}

TEST(StrandGrowth, EvenPointsLieOnTheDrawnCurveFromRootToTip) {
  const PosedHair hair = posedStyle(app::Style::kLong, app::Resolution::kLow);
  render::HairInput input = hair.input(300);
  input.look.length_variation = input.look.flyaways = input.look.hairline = 0;
  const StrandGrowth growth = growthOf(input);
  for (int number = 0; number < growth.strandCount(); ++number) {
    const render::Strand strand = growth.strand(number);
    const std::vector<CurvePoint> drawn = grown(growth, number);
    std::vector<CurvePoint> even(16);
    growth.growEven(strand, even);
    EXPECT_EQ(even.front().position, drawn.front().position);
    EXPECT_LT((even.back().position - drawn.back().position).norm(), 1e-5f * hair.length);
    EXPECT_EQ(even.front().along, 0);
    EXPECT_EQ(even.back().along, 1);
    // Twice as many intervals pass through the same points.
    std::vector<CurvePoint> finer(31);
    growth.growEven(strand, finer);
    for (std::size_t i = 0; i < even.size(); ++i)
      ASSERT_LT((even[i].position - finer[2 * i].position).norm(), 1e-5f * hair.length);
  }
}

TEST(StrandGrowth, TangentsAreTheDirectionsOfTheCurve) {
  const PosedHair hair = posedStyle(app::Style::kLong, app::Resolution::kMedium);
  const StrandGrowth growth = growthOf(hair.input(200));
  double sum = 0;
  long count = 0;
  for (int number = 0; number < growth.strandCount(); ++number) {
    std::vector<CurvePoint> points(400);
    growth.growEven(growth.strand(number), points);
    for (std::size_t i = 1; i + 1 < points.size(); ++i) {
      const Vector3f along = (points[i + 1].position - points[i - 1].position).normalized();
      sum += along.dot(points[i].tangent);
      ++count;
    }
  }
  EXPECT_GT(sum / static_cast<double>(count), 0.997);
}

TEST(StrandGrowth, RadiusTapersAndStandsForAllHairs) {
  const PosedHair hair = posedStyle(app::Style::kShort, app::Resolution::kLow);
  render::HairInput input = hair.input(1000);
  input.look.width_compensation = 1;
  input.look.hairline = 0;  // there hairs are finer
  StrandGrowth growth = growthOf(input);
  const render::Strand strand = growth.strand(10);
  const float expected = input.look.strand_radius * input.look.strands_represented / 1000;
  EXPECT_NEAR(growth.radius(strand, 0), expected, 1e-4f * expected);
  EXPECT_NEAR(growth.radius(strand, 1), expected * input.look.taper, 1e-4f * expected);
  // Half the strands leave, the others are twice as wide.
  growth.setFade({0.5f, 0.51f, 2});
  int left = 0;
  for (int number = 0; number < 1000; ++number) {
    const float gain = growth.strand(number).gain;
    left += gain == 0;
    EXPECT_LE(gain, 2);
    EXPECT_EQ(growth.drawnPoints(growth.strand(number)) == 0, gain == 0);
  }
  EXPECT_NEAR(left, 490, 40);
}

TEST(StrandGrowth, PositionsThatDoNotFitAreRefused) {
  const PosedHair hair = posedStyle(app::Style::kShort, app::Resolution::kLow);
  StrandGrowth growth = growthOf(hair.input(100));
  const Vector3f before = grown(growth, 3).back().position;
  std::vector<float> wrong = hair.posed;
  wrong[17] = NAN;
  EXPECT_FALSE(growth.setPositions(wrong));
  wrong.pop_back();
  EXPECT_FALSE(growth.setPositions(wrong));
  EXPECT_EQ(grown(growth, 3).back().position, before);
  EXPECT_EQ(StrandGrowth({}, {}, 100, 3, {}).strandCount(), 0);
}

}  // namespace strand_growth_test
