// Soft light on hair: what the lattice of hair, the head and the body let through.
#include "render/light/sky_visibility.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <vector>

#include "render/light/density_grid.h"
#include "render/strands/hair_layout.h"
#include "tests/synthetic_hair.h"

namespace sky_visibility_test {

using Eigen::Vector3f;

TEST(SkyVisibility, FindsTheHeadAndDarkensWhatLiesDeep) {
  const synthetic::Hair hair = synthetic::makeHair();
  const render::HairLayout layout = render::makeHairLayout(hair.faces, hair.positions);
  const render::HeadBall head = render::fitHead(layout, hair.positions);
  EXPECT_NEAR(head.radius, synthetic::kHeadRadius, 1e-4f);
  EXPECT_LT((head.center - Vector3f(0, synthetic::kHeadHeight, 0)).norm(), 1e-4f);
  render::SkyVisibility sky_visibility;
  sky_visibility.compute(layout, hair.positions, 5.0f, 0.0f, Vector3f::UnitX(), -Vector3f::UnitZ());
  // The crown's column is outermost, the last ring's roots are covered by all that falls over them.
  const render::SoftLight outer = sky_visibility.values()[4],
                          inner = sky_visibility.values()[(hair.positions.size() / 3) - hair.layers];
  EXPECT_GT(outer.sky, inner.sky);
  for (const render::SoftLight& value : sky_visibility.values()) {
    ASSERT_TRUE(std::isfinite(value.sky));
    ASSERT_GE(value.sky, 0.0f);
    ASSERT_LE(value.sky, 1.0001f);
    for (const render::LightDepths& depths : {value.fill, value.rim}) {
      ASSERT_GE(depths.front, 0.0f);
      ASSERT_GE(depths.behind, 0.0f);
    }
  }
}

// Hair drawn into a tail: its surface is lit from its own side, though a cell of the lattice holds many depths of it,
// and what lies on the far side is dark.
TEST(SkyVisibility, TheSurfaceOfATailIsLit) {
  constexpr float kTail = 0.018f;  // m, radius
  synthetic::Hair hair = synthetic::makeHair();
  const render::HairLayout rest = render::makeHairLayout(hair.faces, hair.positions);
  for (const render::HairColumn& column : rest.columns) {
    const Vector3f across = kTail / synthetic::kHeadRadius * (column.rest - Vector3f(0, synthetic::kHeadHeight, 0));
    for (int layer = 1; layer < hair.layers; ++layer) {
      const Vector3f at(across.x(), synthetic::kHeadHeight - 0.03f * static_cast<float>(layer), across.z() - 0.15f);
      std::copy_n(at.data(), 3, hair.positions.begin() + 3 * (column.first_vertex + layer));
    }
  }
  const render::HairLayout layout = render::makeHairLayout(hair.faces, hair.positions);
  render::SkyVisibility light;
  light.compute(layout, hair.positions, 7.0f, 0.0f, Vector3f::UnitX(), -Vector3f::UnitX());
  int seen = 0;
  for (const render::HairColumn& column : layout.columns) {
    const int vertex = column.first_vertex + hair.layers / 2;
    const float side = hair.positions[3 * static_cast<std::size_t>(vertex)] / kTail;
    if (std::abs(side) < 0.8f) continue;
    const render::SoftLight& value = light.values()[static_cast<std::size_t>(vertex)];
    EXPECT_LT((side > 0 ? value.fill : value.rim).front, 2.0f);
    EXPECT_GT((side > 0 ? value.rim : value.fill).front, 6.0f);
    ++seen;
  }
  EXPECT_GT(seen, 3);
}

// A body part between hair and fill takes its light, and no other; not one behind the hair, far off or thin. One that
// comes nearer does so little by little.
TEST(SkyVisibility, TheBodyStandsInTheWay) {
  const synthetic::Hair hair = synthetic::makeHair();
  const render::HairLayout layout = render::makeHairLayout(hair.faces, hair.positions);
  const auto lightWith = [&](float x, float radius) {
    render::SkinEllipsoid part;
    for (std::size_t a = 0; a < 3; ++a) part.to_ball[a][a] = 1 / radius;
    part.to_ball[0][3] = -x / radius;
    part.to_ball[1][3] = -synthetic::kHeadHeight / radius;
    render::SkyVisibility light;
    light.compute(layout, hair.positions, 7.0f, 0.0f, Vector3f::UnitX(), -Vector3f::UnitZ(), {&part, 1});
    return std::vector<render::SoftLight>(light.values().begin(), light.values().end());
  };
  const auto open = lightWith(-0.4f, 0.2f), shaded = lightWith(0.4f, 0.2f), thin = lightWith(0.4f, 0.02f);
  int hidden = 0, beside = 0;
  for (std::size_t v = 0; v < open.size(); ++v) {
    const float up = hair.positions[3 * v + 1] - synthetic::kHeadHeight,
                miss = std::hypot(up, hair.positions[3 * v + 2]);
    EXPECT_EQ(shaded[v].rim.front, open[v].rim.front);
    EXPECT_EQ(thin[v].fill.front, open[v].fill.front);
    if (miss < 0.05f && hair.positions[3 * v] > 0) {
      ++hidden;
      EXPECT_GT(shaded[v].fill.front, open[v].fill.front + 4);
    } else if (miss > 0.19f) {
      ++beside;
      EXPECT_EQ(shaded[v].fill.front, open[v].fill.front);
    }
  }
  EXPECT_GT(hidden, 10);
  EXPECT_GT(beside, 20);
  auto before = lightWith(1.0f, 0.2f);
  for (std::size_t v = 0; v < open.size(); ++v) EXPECT_EQ(before[v].fill.front, open[v].fill.front);
  float largest = 0;
  for (float x = 1.0f; x > 0.4f; x -= 0.01f) {
    const auto nearer = lightWith(x, 0.2f);
    for (std::size_t v = 0; v < open.size(); ++v)
      largest = std::max(largest, std::abs(std::exp(-nearer[v].fill.front) - std::exp(-before[v].fill.front)));
    before = nearer;
  }
  EXPECT_LT(largest, 0.4f) << "of the light, in 10 mm";
  EXPECT_GT(largest, 0.01f);
}

// What comes through to a place from a direction, as bodies read it; 1 outside of the texture.
float openTo(const render::SkyVisibility& light, const Eigen::Isometry3f& head, const Vector3f& at,
             const Vector3f& direction) {
  const render::HairOpenness& openness = light.openness();
  const Eigen::Vector4f place = openness.from_head * (head.inverse() * at).homogeneous();
  std::array<int, 3> texel{};
  for (int a = 0; a < 3; ++a) {
    texel[a] = static_cast<int>(std::floor(place[a] * static_cast<float>(openness.size[a])));
    if (texel[a] < 0 || texel[a] >= openness.size[a]) return 1;
  }
  const auto& t = openness.texels[(texel[2] * openness.size[1] + texel[1]) * openness.size[0] + texel[0]];
  const Vector3f slope = (Vector3f(t[1], t[2], t[3]) - Vector3f::Constant(128)) / 127;
  return t[0] / 255.0f + slope.dot(direction);
}

// Behind the head under a layer of hair little comes from behind; outside of it all does, and the hair stands in the
// way from within. In front, where none grows, the face is open, though hair is behind it.
TEST(SkyVisibility, SurfacesUnderHairAreClosedToItsSideAlone) {
  const synthetic::Hair hair = synthetic::makeHair();
  const render::HairLayout layout = render::makeHairLayout(hair.faces, hair.positions);
  render::SkyVisibility light;
  light.compute(layout, hair.positions, 12.0f, 0.0f, Vector3f::UnitX(), -Vector3f::UnitZ());
  const Eigen::Isometry3f head = render::headFrame(layout, hair.positions);
  const Vector3f middle(0, synthetic::kHeadHeight, 0), back = -Vector3f::UnitZ(), front = Vector3f::UnitZ();
  const float radius = synthetic::kHeadRadius;
  const Vector3f under = middle + radius * back - Vector3f(0, 0.04f, 0), outside = under + 0.07f * back,
                 face = middle + 0.8f * radius * front - Vector3f(0, 0.03f, 0);
  EXPECT_LT(openTo(light, head, under, back), 0.4f);
  EXPECT_GT(openTo(light, head, outside, back), 0.9f);
  EXPECT_GT(openTo(light, head, face, front), 0.7f);
  EXPECT_LT(openTo(light, head, face, back), openTo(light, head, face, front) - 0.3f);
  EXPECT_EQ(openTo(light, head, middle + Vector3f(0, -2, 0), back), 1);
}

// Trilinear shares: what is added at a point keeps its sum and its centre.
TEST(DensityGrid, SpreadsAnExtinctionAboutItsPlace) {
  render::Bounds bounds;
  bounds.add(Vector3f(-0.05f, -0.04f, -0.03f));
  bounds.add(Vector3f(0.05f, 0.06f, 0.04f));
  for (const Vector3f& place : {Vector3f(0.013f, -0.021f, 0.008f), Vector3f(-0.0412f, 0.0301f, -0.0219f)}) {
    render::DensityGrid grid;
    grid.place(bounds);
    grid.add(place, 2);
    // Sampled linearly between nodes, a lattice of any finer spacing sums to the same.
    constexpr float kSpacing = 0.001f;
    double sum = 0;
    Eigen::Vector3d moment = Eigen::Vector3d::Zero();
    for (int i = -30; i <= 30; ++i) {
      for (int j = -30; j <= 30; ++j) {
        for (int k = -30; k <= 30; ++k) {
          const Vector3f at = place + kSpacing * Vector3f(i, j, k);
          const double value = grid.density(at) * kSpacing * kSpacing * kSpacing;
          sum += value;
          moment += value * at.cast<double>();
        }
      }
    }
    EXPECT_NEAR(sum, 2, 0.02);
    EXPECT_LT((moment / sum - place.cast<double>()).norm(), 2e-4) << "m";
  }
}

}  // namespace sky_visibility_test
