// Colours that a body's mesh brings along.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "render/renderer.h"
#include "tests/gl_fixture.h"
#include "tests/synthetic_hair.h"

namespace materials_test {

constexpr int kSide = 32;

// A square before the camera, its left half of one material, its right half of another.
struct Wall {
  synthetic::Body body;
  std::vector<float> places;
  std::vector<std::vector<std::uint32_t>> materials{std::vector<std::uint32_t>(4, 0xff0000ffu),   // red
                                                    std::vector<std::uint32_t>(4, 0xff00ff00u)};  // green
  std::vector<render::BodyInput> bodies;

  Wall() {
    for (const int half : {0, 1}) {
      const auto base = static_cast<std::uint32_t>(body.positions.size() / 3);
      for (const float y : {-0.5f, 0.5f}) {
        for (const float x : {half - 1.0f, half + 0.0f}) {
          body.positions.insert(body.positions.end(), {x, y, 0});
          body.normals.insert(body.normals.end(), {0, 0, 1});
          body.joints.insert(body.joints.end(), {0, 0, 0, 0});
          body.weights.insert(body.weights.end(), {1, 0, 0, 0});
          places.insert(places.end(), {x, y, static_cast<float>(half)});
        }
      }
      for (const std::uint32_t corner : {0u, 1u, 2u, 2u, 1u, 3u}) body.triangles.push_back(base + corner);
    }
    bodies.push_back(synthetic::bodyInput(body));
    bodies[0].color = {0, 0, 1};
    bodies[0].material_places = places;
    bodies[0].materials = materials;
  }

  // Red, green and blue of a pixel in the middle of the left and of the right half.
  std::vector<unsigned char> drawn() {
    render::Renderer renderer(gl_fixture::kShaderDir);
    render::FrameInput frame = synthetic::frameInput({}, bodies, kSide, kSide);
    frame.camera.eye = {0, 0, 3};
    frame.camera.target = {0, 0, 0};
    frame.light.shadows = false;
    frame.skips.body_detail = false;
    std::vector<unsigned char> rgba, pixels;
    renderer.renderImage(frame, rgba);
    for (const int x : {kSide / 2 - 3, kSide / 2 + 3}) {
      const std::size_t at = 4 * (static_cast<std::size_t>(kSide / 2) * kSide + static_cast<std::size_t>(x));
      pixels.insert(pixels.end(), {rgba[at], rgba[at + 1], rgba[at + 2]});
    }
    return pixels;
  }
};

void expectBlue(const std::vector<unsigned char>& pixels) {
  for (const std::size_t half : {0, 3}) {
    EXPECT_GT(pixels[half + 2], 2 * pixels[half]);
    EXPECT_GT(pixels[half + 2], 2 * pixels[half + 1]);
  }
}

class Materials : public gl_fixture::GlTest {};

TEST_F(Materials, EachShowsOnItsVertices) {
  Wall wall;
  const std::vector<unsigned char> pixels = wall.drawn();
  EXPECT_GT(pixels[0], 2 * pixels[1]);
  EXPECT_GT(pixels[0], 2 * pixels[2]);
  EXPECT_GT(pixels[4], 2 * pixels[3]);
  EXPECT_GT(pixels[4], 2 * pixels[5]);
}

TEST_F(Materials, AreLeftOutWhereNotWantedOrUnsound) {
  Wall unwanted, short_places, unequal, no_square, endless;
  unwanted.bodies[0].own_materials = false;
  expectBlue(unwanted.drawn());
  short_places.bodies[0].material_places = std::span(short_places.places).first(9);
  expectBlue(short_places.drawn());
  unequal.materials[1].resize(1);
  expectBlue(unequal.drawn());
  for (auto& picture : no_square.materials) picture.resize(3);
  expectBlue(no_square.drawn());
  endless.places[1] = std::numeric_limits<float>::quiet_NaN();
  expectBlue(endless.drawn());
}

}  // namespace materials_test
