// Drawn strands are lifted out of the skin, alike on CPU and GPU, and none pops.
#include "render/strands/skin_lift.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "render/hair/hair_store.h"
#include "render/strands/strand_growth.h"
#include "shaders/shared.h"
#include "tests/gl_fixture.h"
#include "tests/strand_capture.h"
#include "tests/synthetic_hair.h"

namespace skin_lift_test {

using Eigen::Vector3f;
using render::CurvePoint;
using render::SkinEllipsoid;
using render::SkinGrid;
using render::shared::kSkinBlend, render::shared::kSkinGap;

// Turned, with radii of 4, 7 and 10 cm, at the origin.
SkinEllipsoid turnedEllipsoid() {
  const Eigen::Matrix3f turn = Eigen::AngleAxisf(0.7f, Vector3f(1, 2, -1).normalized()).toRotationMatrix();
  SkinEllipsoid skin;
  const Vector3f radii(0.04f, 0.07f, 0.10f);
  for (int k = 0; k < 3; ++k) {
    for (int axis = 0; axis < 3; ++axis) skin.to_ball[k][axis] = turn(axis, k) / radii[k];
  }
  return skin;
}

Vector3f inBall(const SkinEllipsoid& skin, const Vector3f& p) {
  Vector3f ball;
  for (int k = 0; k < 3; ++k)
    ball[k] = Vector3f(skin.to_ball[k][0], skin.to_ball[k][1], skin.to_ball[k][2]).dot(p) + skin.to_ball[k][3];
  return ball;
}

// m, of first order.
float gapOf(const SkinEllipsoid& skin, const Vector3f& p) {
  const Vector3f ball = inBall(skin, p);
  Vector3f slope = Vector3f::Zero();
  for (int k = 0; k < 3; ++k) slope += ball[k] * Vector3f(skin.to_ball[k].data());
  return ball.norm() * (ball.norm() - 1) / slope.norm();
}

Vector3f lifted(std::span<const SkinEllipsoid> skin, float s, Vector3f p) {
  Vector3f tangent = Vector3f::UnitY();
  render::SkinLift first;
  render::leaveSkin(skin, {}, s, first, p, tangent);
  return p;
}

TEST(SkinLift, PointsInsideComeToTheBoundAndThoseOutsideStay) {
  const SkinEllipsoid skin = turnedEllipsoid();
  int inside = 0, outside = 0;
  for (float x = -0.1f; x < 0.1f; x += 0.007f) {
    for (float y = -0.1f; y < 0.1f; y += 0.007f) {
      for (float z = -0.1f; z < 0.1f; z += 0.007f) {
        const Vector3f p(x, y, z), after = lifted({&skin, 1}, 2, p);
        const float before = gapOf(skin, p);
        if (before > kSkinGap + kSkinBlend) {
          ++outside;
          ASSERT_EQ(after, p);
        } else if (before > -0.03f && inBall(skin, p).squaredNorm() > render::shared::kSkinWhole) {
          ++inside;
          ASSERT_GT(gapOf(skin, after), 0) << "from " << before;
          ASSERT_LT(gapOf(skin, after), kSkinGap + kSkinBlend + 0.1f * std::abs(before)) << "from " << before;
        }
      }
    }
  }
  EXPECT_GT(inside, 500);
  EXPECT_GT(outside, 500);
}

TEST(SkinLift, RootsStayAndTheFirstLayerLeadsUp) {
  const SkinEllipsoid skin = synthetic::skinBall({0, 0, 0}, 0.1f);
  const Vector3f p(0, 0.09f, 0);
  EXPECT_EQ(lifted({&skin, 1}, 0, p), p);
  float last = 0;
  for (const float s : {0.2f, 0.5f, 0.8f, 1.0f}) {
    const float rise = (lifted({&skin, 1}, s, p) - p).norm();
    EXPECT_GT(rise, last);
    last = rise;
  }
  EXPECT_NEAR(last, 0.01f + kSkinGap, 5e-4f);
}

constexpr float kStep = 0.001f;  // m, that the skin moves in a frame, through points that do not

// m a frame, the most that points move by: those at most 8 mm inside, and all.
struct Moves {
  float outer = 0, all = 0;
};

Moves movesOf(const std::vector<SkinEllipsoid>& skin) {
  const auto at = [&](float shift) {
    std::vector<SkinEllipsoid> moved = skin;
    for (SkinEllipsoid& e : moved) {
      for (auto& row : e.to_ball) row[3] -= row[0] * shift;
    }
    return moved;
  };
  Moves moves;
  for (float y = -0.12f; y < 0.12f; y += 0.006f) {
    for (float z = -0.12f; z < 0.12f; z += 0.006f) {
      Vector3f before = lifted(at(-0.2f), 2, {0, y, z});
      for (float shift = -0.2f; shift < 0.2f; shift += kStep) {
        const auto moved = at(shift);
        const Vector3f after = lifted(moved, 2, {0, y, z});
        const bool deep = std::ranges::any_of(moved, [&](const SkinEllipsoid& e) {
          return gapOf(e, {0, y, z}) < -0.008f;
        });
        const float way = (after - before).norm();
        if (!deep) moves.outer = std::max(moves.outer, way);
        moves.all = std::max(moves.all, way);
        before = after;
      }
    }
  }
  return moves;
}

TEST(SkinLift, NoPointPopsAsTheSkinMoves) {
  const Moves one = movesOf({turnedEllipsoid()});
  EXPECT_LT(one.outer, 2 * kStep);
  EXPECT_LT(one.all, 12 * kStep);  // near the middle, where the lift fades out
  EXPECT_GT(one.outer, 0);
  // Where two meet, the crease runs ahead of them.
  EXPECT_LT(movesOf({turnedEllipsoid(), synthetic::skinBall({0.03f, 0.05f, 0}, 0.05f)}).outer, 5 * kStep);
}

// Behind a shoulder, where ellipsoids of chest, shoulder blade and skin meet about a place: each leads a point into the
// next.
std::vector<SkinEllipsoid> ellipsoidsThatPushRound(const Vector3f& place) {
  std::vector<SkinEllipsoid> skin{
      {{{{3.519f, 1.558f, -4.621f, 0.9679f}, {-1.974f, 5.460f, 0.338f, 0.1709f}, {6.059f, 1.866f, 5.242f, 0.2073f}}},
       {0.064f, 2.938f, 0.601f}},
      {{{{5.319f, 1.305f, 0.406f, 0.5274f}, {-1.781f, 7.004f, 0.825f, -0.1818f}, {-0.387f, -1.120f, 8.674f, -0.9015f}}},
       {-0.015f, 2.990f, 0.245f}},
      {{{{4.863f, 1.079f, 0.435f, 0.4678f},
         {-2.850f, 12.457f, 0.971f, -1.2708f},
         {-0.812f, -1.108f, 11.835f, -1.2591f}}},
       {-0.046f, 2.974f, 0.390f}},
      {{{{12.554f, 2.219f, 5.158f, 0.1707f},
         {-2.166f, 9.435f, 1.212f, -0.0491f},
         {-8.274f, -4.748f, 22.180f, -1.0753f}}},
       {-0.484f, 2.389f, 1.749f}},
      {{{{-55.418f, -46.787f, 55.146f, 0.1955f},
         {-29.187f, 37.440f, 2.434f, 0.4018f},
         {-7.291f, -4.936f, -11.515f, 0.6901f}}},
       {0.000f, 0.000f, -0.000f}},
      {{{{72.980f, 37.825f, -102.385f, -0.3889f},
         {-11.866f, 27.113f, 1.559f, 0.1599f},
         {19.492f, 7.571f, 16.691f, 0.0687f}}},
       {-0.000f, 0.000f, 0.000f}}};
  for (SkinEllipsoid& e : skin)
    for (auto& row : e.to_ball) row[3] -= Vector3f(row.data()).dot(place);
  return skin;
}

TEST(SkinLift, PointsThatEllipsoidsPushRoundLeaveAllAlongOneLine) {
  const std::vector<SkinEllipsoid> skin = ellipsoidsThatPushRound(Vector3f::Zero());
  int left = 0, all = 0;
  for (float x = -0.01f; x < 0.0101f; x += 0.002f) {
    for (float y = -0.01f; y < 0.0101f; y += 0.002f) {
      for (float z = -0.01f; z < 0.0101f; z += 0.002f) {
        const Vector3f after = lifted(skin, 2, {x, y, z});
        ++all;
        left += std::ranges::any_of(skin, [&](const SkinEllipsoid& e) { return gapOf(e, after) < -0.001f; });
      }
    }
  }
  EXPECT_EQ(all, 1331);
  EXPECT_LT(left, 0.01 * all);  // a seventh, each along its own way
}

// A lock that hangs on both sides of a shoulder: its strands cross the middle of the ellipsoid, or pass below it.
TEST(SkinLift, WhatRunsThroughTheMiddleIsLedOverTheSideThatHairComesFrom) {
  SkinEllipsoid skin = synthetic::skinBall({0, 0, 0}, 0.1f);
  skin.home = {0, 3, 0};
  for (const float y : {0.05f, 0.0f, -0.03f, -0.05f}) {
    Vector3f before(-0.15f, y, 0);
    for (float x = -0.15f; x < 0.15f; x += kStep) {
      const Vector3f after = lifted({&skin, 1}, 2, {x, y, 0});
      EXPECT_GT(gapOf(skin, after), 0) << x << " " << y;
      EXPECT_LT((after - before).norm(), 12 * kStep) << x << " " << y;
      before = after;
    }
    EXPECT_NEAR(lifted({&skin, 1}, 2, {0, y, 0}).y(), 0.1f + kSkinGap, 1e-4f);
  }
}

// Straight down through a body, and out of it below; what is lifted for itself stays inside there, or lies below.
TEST(SkinLift, AStrandThatGoesThroughStaysOnTheSideThatItComesFrom) {
  SkinEllipsoid skin = synthetic::skinBall({0, 0, 0}, 0.1f);
  skin.home = {0, 3, 0};
  render::SkinLift lift;
  float deepest_alone = 0;
  for (float y = 0.15f; y > -0.15f; y -= 0.004f) {
    Vector3f p(0.01f, y, 0), tangent = -Vector3f::UnitY();
    render::leaveSkin({&skin, 1}, {}, 2, lift, p, tangent);
    EXPECT_GT(gapOf(skin, p), 0) << y;
    EXPECT_GT(p.y(), 0) << y;
    deepest_alone = std::min(deepest_alone, gapOf(skin, lifted({&skin, 1}, 2, {0.01f, y, 0})));
  }
  EXPECT_LT(deepest_alone, -0.004f);
}

// Points of a strand far apart: the second lies in the middle, where no side is nearer, and follows the first.
TEST(SkinLift, APointInTheMiddleGoesTheWayOfTheOneBeforeIt) {
  const SkinEllipsoid skin = synthetic::skinBall({0, 0, 0}, 0.056f);
  render::SkinLift lift;
  Vector3f first(0.003f, 0.035f, 0), second(0.003f, -0.02f, 0), tangent = -Vector3f::UnitY();
  render::leaveSkin({&skin, 1}, {}, 2, lift, first, tangent);
  EXPECT_GT(lift.by.y(), 0.02f);
  tangent = -Vector3f::UnitY();
  render::leaveSkin({&skin, 1}, {}, 2, lift, second, tangent);
  EXPECT_GT(gapOf(skin, second), 0);
  EXPECT_GT(second.y(), 0.05f);
}

// Free again, it returns, and its tangents are its direction on the way.
TEST(SkinLift, AStrandReturnsFromWhereItWasLifted) {
  const SkinEllipsoid skin = synthetic::skinBall({0, 0, 0}, 0.1f);
  constexpr float kApart = 0.001f;  // m
  render::SkinLift lift;
  Vector3f last(-0.2f, 0.08f, 0);
  for (float x = -0.2f; x < 0.5f; x += kApart) {
    Vector3f p(x, 0.08f, 0), tangent = Vector3f::UnitX();
    render::leaveSkin({&skin, 1}, {}, 2, lift, p, tangent);
    if (x > 0.1f) {
      EXPECT_GT((p - last).normalized().dot(tangent.normalized()), 0.999f) << x;
    }
    last = p;
  }
  EXPECT_GT(last.y(), 0.08f);
  EXPECT_LT(last.y(), 0.085f);
}

TEST(SkinLift, EllipsoidsOutOfReachAreLeftOut) {
  const std::vector<SkinEllipsoid> skin{synthetic::skinBall({0, 0, 0}, 0.1f), synthetic::skinBall({1, 0, 0}, 0.1f),
                                        turnedEllipsoid()};
  const auto near = render::skinNear(skin, {0.05f, -0.2f, -0.2f}, {0.3f, 0.2f, 0.2f});
  ASSERT_EQ(near.size(), 2u);
  EXPECT_EQ(near[0], skin[0]);
  EXPECT_EQ(near[1], skin[2]);
  EXPECT_EQ(render::skinNear(skin, {0.85f, -0.1f, -0.1f}, {0.9f, 0.1f, 0.1f}).size(), 1u);
}

// Signed distances of a turned box.
struct BoxGrid {
  static constexpr int kNodes = 40;  // even: none in the middle, where a thin box has a cell without a slope
  static constexpr float kSpacing = 0.006f;
  Eigen::Matrix3f turn = Eigen::AngleAxisf(0.7f, Vector3f(1, 2, -1).normalized()).toRotationMatrix();
  Vector3f middle, half;
  std::vector<float> distances;
  SkinGrid grid;

  explicit BoxGrid(const Vector3f& at, const Vector3f& half_sides = {0.06f, 0.04f, 0.08f})
      : middle(at), half(half_sides) {
    const Vector3f low = Vector3f::Constant(-0.5f * kSpacing * (kNodes - 1));
    for (int k = 0; k < kNodes; ++k)
      for (int j = 0; j < kNodes; ++j)
        for (int i = 0; i < kNodes; ++i) distances.push_back(boxDistance(low + kSpacing * Vector3f(i, j, k)));
    grid.id = 7;
    grid.nodes = {kNodes, kNodes, kNodes};
    grid.distances = distances;
    for (int k = 0; k < 3; ++k) {
      const Vector3f row = turn.col(k) / kSpacing;
      grid.to_nodes[k] = {row.x(), row.y(), row.z(), -row.dot(middle) - low[k] / kSpacing};
    }
  }
  float boxDistance(const Vector3f& p) const {
    const Vector3f q = p.cwiseAbs() - half;
    return q.cwiseMax(0).norm() + std::min(q.maxCoeff(), 0.0f);
  }
  float distanceTo(const Vector3f& p) const { return boxDistance(turn.transpose() * (p - middle)); }
};

// Points of both ends of the first layer: a root comes out of a grid, where it stays in an ellipsoid.
TEST(SkinLift, PointsLeaveAGrid) {
  const BoxGrid box({0.3f, -0.2f, 0.1f});
  std::mt19937 random(3);
  std::uniform_real_distribution<float> even(-0.11f, 0.11f);
  int inside = 0, outside = 0;
  for (int n = 0; n < 3000; ++n) {
    const Vector3f from = box.middle + Vector3f(even(random), even(random), even(random));
    const float before = box.distanceTo(from);
    if (before < -0.03f) continue;  // about the middle all ways out are as long
    for (const float s : {0.0f, 3.0f}) {
      Vector3f p = from, tangent = Vector3f::UnitY();
      render::SkinLift lift;
      render::leaveSkin({}, {&box.grid, 1}, s, lift, p, tangent);
      if (before > kSkinGap + kSkinBlend + BoxGrid::kSpacing) {
        EXPECT_EQ(p, from);
        ++outside;
      } else {
        EXPECT_GT(box.distanceTo(p), 0) << from.transpose() << ", " << before;
        EXPECT_LT((p - from).norm(), std::max(-before, 0.0f) + 2 * BoxGrid::kSpacing);
        ++inside;
      }
    }
  }
  EXPECT_GT(inside, 1000);
  EXPECT_GT(outside, 500);
}

// In the middle of a plate of 1 cm neither side is nearer: a strand leaves it to where it came from.
TEST(SkinLift, PointsInTheMiddleOfAPlateGoBackAlongTheStrand) {
  const BoxGrid plate({0.3f, -0.2f, 0.1f}, {0.08f, 0.08f, 0.005f});
  const Vector3f normal = plate.turn.col(2);
  std::mt19937 random(5);
  std::uniform_real_distribution<float> even(-1, 1);
  for (int n = 0; n < 1000; ++n) {
    const Vector3f aside = plate.turn * Vector3f(0.05f * even(random), 0.05f * even(random), 0.002f * even(random));
    const Vector3f from = plate.middle + aside;
    const float side = n % 2 == 0 ? 1 : -1;
    const Vector3f heading = (side * normal + 0.5f * even(random) * plate.turn.col(0)).normalized();
    Vector3f p = from, tangent = heading;
    render::SkinLift lift;
    render::leaveSkin({}, {&plate.grid, 1}, 3, lift, p, tangent);
    EXPECT_LT(side * normal.dot(p - plate.middle), -0.005f) << aside.transpose();
  }
}

class SkinLiftOnGpu : public gl_fixture::GlTest {};

// Of more the block of uniforms holds no rows: drivers read there what they like.
TEST_F(SkinLiftOnGpu, ShadersLookAtNoSkinThatIsNotThere) {
  const synthetic::Hair hair = synthetic::makeHair();
  render::HairInput input = synthetic::hairInput(hair, 100);
  for (const std::size_t given : {std::size_t{1}, std::size_t{3}, std::size_t{render::shared::kMaxSkin} + 9}) {
    const std::vector<SkinEllipsoid> skin(given,
                                          synthetic::skinBall({0, synthetic::kHeadHeight, 0}, synthetic::kHeadRadius));
    input.skin = skin;
    const std::size_t most = std::min<std::size_t>(given, render::shared::kMaxSkin);
    for (const bool skip : {false, true}) {
      render::DrawSkips skips;
      skips.skin = skip;
      render::HairStore store;
      store.update({&input, 1}, {}, skips);
      const render::HairResources& drawn = store.hairs()[0];
      ASSERT_EQ(drawn.skin.size(), most);
      ASSERT_FALSE(drawn.skin_reached.empty());
      std::uint64_t bits = 0;
      for (const std::uint64_t reached : drawn.skin_reached) bits |= reached;
      EXPECT_EQ(bits, (std::uint64_t{1} << most) - 1) << given << ", " << skip;
    }
  }
}

// Strands of 2,000 that end elsewhere on the GPU than on the CPU, and those that are lifted.
struct Compared {
  int other = 0, moved = 0;
};

void compareLifts(render::HairInput input, Compared& compared) {
  const auto drawn = strand_capture::capture(input, gl_fixture::kShaderDir);
  render::StrandGrowth growth(input.faces, input.positions, input.strands, input.segments_per_layer, input.look);
  growth.setSkin(input.skin, input.skin_grids);
  input.skin = {};
  input.skin_grids = {};
  const auto bare = strand_capture::capture(input, gl_fixture::kShaderDir);
  std::vector<CurvePoint> points(static_cast<std::size_t>(growth.maxPoints()));
  for (int number = 0; number < growth.strandCount(); ++number) {
    const auto n = static_cast<std::size_t>(number);
    const int count = growth.growDrawn(growth.strand(number), points);
    ASSERT_EQ(static_cast<std::size_t>(count), drawn[n].size());
    float worst = 0, rise = 0;
    for (int i = 0; i < count; ++i) {
      const auto k = static_cast<std::size_t>(i);
      worst = std::max(worst, (points[k].position - drawn[n][k]).norm());
      rise = std::max(rise, (bare[n][k] - drawn[n][k]).norm());
      EXPECT_NEAR(points[k].tangent.norm(), 1, 1e-5f);
    }
    compared.other += worst > 1e-5f;  // m
    compared.moved += rise > 1e-3f;
  }
}

// A hair half of whose strands run through two bodies.
TEST_F(SkinLiftOnGpu, ShadersLiftAsTheCpuDoes) {
  const synthetic::Hair hair = synthetic::makeHair();
  render::HairInput input = synthetic::hairInput(hair, 2000);
  input.look.curl_radius = 0.004f;
  SkinEllipsoid shoulder = turnedEllipsoid();
  for (auto& row : shoulder.to_ball)
    row[3] = -Vector3f(row.data()).dot(Vector3f(0.06f, synthetic::kHeadHeight - 0.15f, -0.05f));
  shoulder.home = {-0.5f, 2.5f, 0.8f};
  const std::vector<SkinEllipsoid> skin{
      synthetic::skinBall({0, synthetic::kHeadHeight, 0}, synthetic::kHeadRadius + 0.004f), shoulder};
  input.skin = skin;
  Compared compared;
  compareLifts(input, compared);
  EXPECT_LE(compared.other, 3);  // roots on the border of two clumps, where the last bit decides
  EXPECT_GT(compared.moved, 500);
  EXPECT_LT(compared.moved, 1990);
}

TEST_F(SkinLiftOnGpu, ShadersLeaveEllipsoidsThatPushRoundAsTheCpuDoes) {
  const synthetic::Hair hair = synthetic::makeHair();
  render::HairInput input = synthetic::hairInput(hair, 2000);
  const std::vector<SkinEllipsoid> skin = ellipsoidsThatPushRound({0.06f, synthetic::kHeadHeight - 0.12f, -0.05f});
  input.skin = skin;
  Compared compared;
  compareLifts(input, compared);
  EXPECT_LE(compared.other, 3);
  EXPECT_GT(compared.moved, 500);
}

TEST_F(SkinLiftOnGpu, ShadersLiftOutOfGridsAsTheCpuDoes) {
  const synthetic::Hair hair = synthetic::makeHair();
  render::HairInput input = synthetic::hairInput(hair, 2000);
  const std::vector<SkinEllipsoid> skin{
      synthetic::skinBall({0, synthetic::kHeadHeight, 0}, synthetic::kHeadRadius + 0.004f)};
  const BoxGrid box({-0.07f, synthetic::kHeadHeight - 0.1f, -0.05f}), far({5, 5, 5}),
      plate({0.09f, synthetic::kHeadHeight - 0.12f, 0}, {0.1f, 0.1f, 0.005f});
  std::vector<SkinGrid> grids{far.grid, box.grid, plate.grid};
  grids[0].id = 8;
  grids[2].id = 9;
  input.skin = skin;
  input.skin_grids = grids;
  Compared compared;
  compareLifts(input, compared);
  EXPECT_LE(compared.other, 40);  // and points as deep on two sides of a box
  EXPECT_GT(compared.moved, 300);
  EXPECT_LT(compared.moved, 1990);
}

}  // namespace skin_lift_test
