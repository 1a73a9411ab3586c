// A body without a skeleton is a figure: its axis, unit, neck and facing are told by its outline.
#include "app/figure/still_body.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace {

struct Shape {
  std::vector<Eigen::Vector3f> positions;
  std::vector<std::uint32_t> triangles;

  void addEllipsoid(const Eigen::Vector3f& center, const Eigen::Vector3f& radii) {
    constexpr std::uint32_t kRings = 16, kSides = 24;
    const auto base = static_cast<std::uint32_t>(positions.size());
    for (std::uint32_t i = 0; i <= kRings; ++i) {
      for (std::uint32_t j = 0; j < kSides; ++j) {
        const double t = EIGEN_PI * i / kRings, p = 2 * EIGEN_PI * j / kSides;
        const Eigen::Vector3d unit(std::sin(t) * std::cos(p), std::cos(t), std::sin(t) * std::sin(p));
        positions.push_back(center + radii.cwiseProduct(unit.cast<float>()));
      }
    }
    for (std::uint32_t i = 0; i < kRings; ++i) {
      for (std::uint32_t j = 0; j < kSides; ++j) {
        const std::uint32_t a = base + i * kSides + j, b = base + i * kSides + (j + 1) % kSides;
        for (const std::uint32_t v : {a, b, a + kSides, b, b + kSides, a + kSides}) triangles.push_back(v);
      }
    }
  }
};

Shape standingBody() {
  Shape body;
  body.addEllipsoid({0, 1.57f, 0.02f}, {0.075f, 0.115f, 0.095f});  // skull
  body.addEllipsoid({0, 1.47f, 0.06f}, {0.04f, 0.04f, 0.05f});     // chin
  body.addEllipsoid({0, 1.42f, -0.02f}, {0.055f, 0.1f, 0.055f});   // neck
  body.addEllipsoid({0, 1.15f, 0}, {0.2f, 0.26f, 0.12f});
  for (const float side : {-1.0f, 1.0f}) {
    body.addEllipsoid({side * 0.1f, 0.5f, 0}, {0.085f, 0.5f, 0.09f});
    body.addEllipsoid({side * 0.35f, 1.33f, 0}, {0.3f, 0.05f, 0.05f});
  }
  return body;
}

TEST(StillBody, AxisUnitNeckAndFacingAreToldByTheOutline) {
  Shape z_up = standingBody();
  for (Eigen::Vector3f& p : z_up.positions) p = 100 * Eigen::Vector3f(p.x(), -p.z(), p.y());
  for (const Shape& body : {standingBody(), z_up}) {
    const auto found = app::measureStillBody(body.positions, body.triangles);
    ASSERT_TRUE(found);
    EXPECT_TRUE(found->whole);
    EXPECT_NEAR(found->neck.y(), 1.40, 0.05);
    const Eigen::Vector4d crown = body.positions[0].cast<double>().homogeneous();
    EXPECT_NEAR((found->to_metres * crown).y(), 1.685, 0.01);  // the crown
    double ahead = 0;
    for (const Eigen::Vector3f& p : body.positions) {
      const Eigen::Vector4d at = found->to_metres * p.cast<double>().homogeneous();
      if (at.y() > 1.45) ahead = std::max(ahead, at.z());
    }
    EXPECT_GT(ahead, 0.1);  // the face, ahead of the neck
  }
}

TEST(StillBody, WhatHasNoNeckIsNone) {
  Shape ball;
  ball.addEllipsoid({0, 1, 0}, {0.3f, 0.3f, 0.3f});
  EXPECT_FALSE(app::measureStillBody(ball.positions, ball.triangles));
}

}  // namespace
