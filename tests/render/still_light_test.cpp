// Light on hair keeps still where nothing moves: neither shadow maps nor the lattice of hair density follow single
// tips.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <set>
#include <vector>

#include "render/renderer.h"
#include "render/stage.h"
#include "tests/gl_fixture.h"
#include "tests/synthetic_hair.h"

namespace still_light_test {

constexpr int kWidth = 320, kHeight = 180;

class StillLight : public gl_fixture::GlTest {};

// Pixels that a change of `first`'s column may reach: around its own hair, and where that casts shadow.
std::vector<bool> nearColumn(const synthetic::Hair& hair, const render::FrameInput& frame, int first) {
  const Eigen::Matrix4f view = render::viewProjection(frame.camera, kWidth, kHeight);
  const Eigen::Vector3f to_light = render::directionOr(frame.light.to_light, Eigen::Vector3f::UnitY());
  std::vector<bool> near(static_cast<std::size_t>(kWidth * kHeight), false);
  constexpr int kReach = 9;  // pixels
  const auto mark = [&](const Eigen::Vector3f& at) {
    const Eigen::Vector4f clip = view * at.homogeneous();
    const int x = static_cast<int>((0.5f + 0.5f * clip.x() / clip.w()) * kWidth);
    const int y = static_cast<int>((0.5f - 0.5f * clip.y() / clip.w()) * kHeight);
    for (int j = std::max(y - kReach, 0); j <= std::min(y + kReach, kHeight - 1); ++j) {
      for (int i = std::max(x - kReach, 0); i <= std::min(x + kReach, kWidth - 1); ++i)
        near[static_cast<std::size_t>(j * kWidth + i)] = true;
    }
  };
  // A vertex bends the patches of the faces around it, and by their columns' gradients those of the next faces. Strands
  // of its own faces may be drawn by more or fewer segments from their roots on.
  const auto has = [](const render::HairFace& face, int column) {
    return std::find(face.first_vertex.begin(), face.first_vertex.end(), column) != face.first_vertex.end();
  };
  std::set<int> around;
  for (const render::HairFace& face : hair.faces) {
    if (has(face, first)) around.insert(face.first_vertex.begin(), face.first_vertex.end());
  }
  for (const render::HairFace& face : hair.faces) {
    if (std::none_of(around.begin(), around.end(), [&](int column) { return column >= 0 && has(face, column); }))
      continue;
    for (int edge = 0; edge < 16; ++edge) {
      const int from = face.first_vertex[edge / 4], to = face.first_vertex[edge % 4];
      for (int layer = has(face, first) ? 0 : hair.layers - 4; from >= 0 && to >= 0 && layer < hair.layers; ++layer) {
        const auto at = [&](int corner) {
          return Eigen::Vector3f(&hair.positions[3 * static_cast<std::size_t>(corner + layer)]);
        };
        for (int step = 0; step <= 30; ++step) {
          const float share = static_cast<float>(step % 4) / 4;
          mark((1 - share) * at(from) + share * at(to) - 0.01f * static_cast<float>(step) * to_light);
        }
      }
    }
  }
  return near;
}

TEST_F(StillLight, OneTipThatMovesChangesItsOwnHairAndShadowOnly) {
  synthetic::Hair hair = synthetic::makeHair();
  const synthetic::Body body = synthetic::makeBody();
  std::vector<render::HairInput> hairs{synthetic::hairInput(hair, 3000)};
  const std::vector<render::BodyInput> bodies{synthetic::bodyInput(body)};
  const render::FrameInput frame = synthetic::frameInput(hairs, bodies, kWidth, kHeight);
  render::Renderer renderer(gl_fixture::kShaderDir);
  std::vector<unsigned char> before, after;
  int marked = 0;
  // Every fourth tip of the outermost ring: some of them bound the hair.
  for (std::size_t column = 31; column < 41; column += 4) {
    const int first = static_cast<int>(column) * hair.layers;
    for (int axis = 0; axis < 3; ++axis) {
      renderer.renderImage(frame, before);
      const std::vector<bool> near = nearColumn(hair, frame, first);
      const std::size_t tip = 3 * static_cast<std::size_t>(first + hair.layers - 1) + static_cast<std::size_t>(axis);
      hair.positions[tip] += axis == 1 ? -0.005f : 0.005f;
      ++hairs[0].position_revision;
      renderer.renderImage(frame, after);
      int worst = 0, changed = 0;
      for (std::size_t pixel = 0; pixel < near.size(); ++pixel) {
        marked += near[pixel];
        int off = 0;
        for (std::size_t c = 0; c < 3 && !near[pixel]; ++c)
          off = std::max(off, std::abs(before[4 * pixel + c] - after[4 * pixel + c]));
        worst = std::max(worst, off);
        changed += off > 2;
      }
      std::printf("column %zu axis %d: %d levels beside, %d pixels by more than 2\n", column, axis, worst, changed);
      EXPECT_LE(worst, 2) << "column " << column << ", axis " << axis;
      EXPECT_EQ(changed, 0) << "column " << column << ", axis " << axis;
    }
  }
  EXPECT_LT(marked, 9 * kWidth * kHeight / 3) << "the test looks past too much of the picture";
}

}  // namespace still_light_test
