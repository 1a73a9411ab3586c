// Skin among roots that lies in the shadow of other hair: the darker of the two shades holds, and no light is taken
// twice.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "render/renderer.h"
#include "tests/gl_fixture.h"
#include "tests/synthetic_hair.h"

namespace root_shade_test {

constexpr int kSide = 48;
constexpr float kFloor = -0.3f;  // m

// A level slab of level hair around the origin, so wide (m).
struct Slab {
  std::vector<render::HairFace> faces;
  std::vector<float> positions;

  explicit Slab(float side) {
    constexpr int kCells = 4, kLayers = 5;
    for (int j = 0; j <= kCells; ++j) {
      for (int i = 0; i <= kCells; ++i) {
        for (int layer = 0; layer < kLayers; ++layer) {
          positions.insert(positions.end(), {side * (layer / (kLayers - 1.0f) - 0.5f), 0.04f * (0.5f - j / 4.0f),
                                             side * (i / float(kCells) - 0.5f)});
        }
      }
    }
    const auto at = [&](int row, int column) { return (row * (kCells + 1) + column) * kLayers; };
    for (int j = 0; j < kCells; ++j) {
      for (int i = 0; i < kCells; ++i)
        faces.push_back({{at(j, i), at(j, i + 1), at(j + 1, i + 1), at(j + 1, i)}, kLayers, 1});
    }
  }
};

// A square below it, that faces up.
synthetic::Body floorBody() {
  synthetic::Body body;
  for (const float z : {-0.3f, 0.3f}) {
    for (const float x : {-0.3f, 0.3f}) {
      body.positions.insert(body.positions.end(), {x, kFloor, z});
      body.normals.insert(body.normals.end(), {0, 1, 0});
      body.joints.insert(body.joints.end(), {0, 0, 0, 0});
      body.weights.insert(body.weights.end(), {1, 0, 0, 0});
    }
  }
  body.triangles = {0, 2, 1, 1, 2, 3};
  return body;
}

// The linear radiance that a byte shows: the sRGB curve and the film's (Narkowicz 2015), undone.
double radianceOf(unsigned char byte) {
  const double value = byte / 255.0;
  const double shown = value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4);
  double low = 0, high = 100;
  for (int k = 0; k < 100; ++k) {
    const double x = (low + high) / 2;
    (x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14) < shown ? low : high) = x;
  }
  return low;
}

struct RootShade : gl_fixture::GlTest {};

TEST_F(RootShade, TheDarkerShadeHolds) {
  const Slab slab(0.5f);
  const synthetic::Body floor = floorBody();
  const std::vector<float> cover{1, 0, 1, 0, 1, 0, 1, 0};
  // Of the floor's middle, seen from under the hair.
  const auto radiance = [&](bool roots, bool shadows, float strength) {
    render::HairInput hair;
    hair.id = 1;
    hair.faces = slab.faces;
    hair.positions = slab.positions;
    hair.strands = 4000;
    render::BodyInput body = synthetic::bodyInput(floor);
    body.color = {0.3f, 0.3f, 0.3f};
    body.roughness = 1;
    body.scalp_id = roots ? 7 : 0;
    body.root_cover = cover;
    body.root_color = {1, 1, 1};  // roots that shade and do not tint
    body.scalp_tint = 1;
    render::FrameInput frame = synthetic::frameInput({&hair, 1}, {&body, 1}, kSide, kSide);
    frame.camera.eye = {0, -0.1f, 0.35f};
    frame.camera.target = {0, kFloor, 0};
    frame.light.to_light = {0, 1, 0};
    frame.light.fill = frame.light.rim = frame.light.ambient_sky = frame.light.ambient_ground = {0, 0, 0};
    frame.light.shadows = shadows;
    frame.light.shadow_strength = strength;
    static render::Renderer renderer(gl_fixture::kShaderDir);
    std::vector<unsigned char> rgba;
    renderer.renderImage(frame, rgba);
    double sum = 0;
    for (int y = kSide / 2 - 2; y < kSide / 2 + 2; ++y) {
      for (int x = kSide / 2 - 2; x < kSide / 2 + 2; ++x) sum += radianceOf(rgba[4 * (y * kSide + x)]) / 16;
    }
    return sum;
  };
  const double open = radiance(false, false, 1), among_roots = radiance(true, false, 1) / open;
  EXPECT_LT(among_roots, 0.9);
  double darkest = 1;
  for (const float strength : {0.02f, 0.05f, 0.1f, 0.2f, 0.5f}) {
    const double in_shadow = radiance(false, true, strength) / open, both = radiance(true, true, strength) / open;
    EXPECT_NEAR(both, std::min(in_shadow, among_roots), 0.03) << "strength " << strength;
    darkest = std::min(darkest, in_shadow);
  }
  EXPECT_LT(darkest, among_roots - 0.1) << "either shade was the darker one";
}

}  // namespace root_shade_test
