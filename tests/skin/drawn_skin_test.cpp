#include "tests/skin/drawn_skin.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>

namespace drawn_skin_test {

using Eigen::Vector3f;

// Boxes as one rigid body.
struct Boxes {
  std::vector<float> positions, normals, weights;
  std::vector<std::uint32_t> triangles;
  std::vector<std::uint16_t> joints;
  std::array<render::Mat4, 1> matrix{{{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}}};

  void add(const Vector3f& low, const Vector3f& high) {
    const auto base = static_cast<std::uint32_t>(positions.size() / 3);
    for (int k = 0; k < 8; ++k) {
      for (int a = 0; a < 3; ++a) {
        positions.push_back((k >> a & 1) ? high[a] : low[a]);
        normals.push_back(0);
        weights.push_back(a == 0);
      }
      weights.push_back(0);
      joints.insert(joints.end(), 4, 0);
    }
    for (const auto& face : {std::array<std::uint32_t, 4>{0, 4, 6, 2},
                             {1, 3, 7, 5},
                             {0, 1, 5, 4},
                             {2, 6, 7, 3},
                             {0, 2, 3, 1},
                             {4, 5, 7, 6}}) {
      for (const int corner : {0, 1, 2, 0, 2, 3}) triangles.push_back(base + face[static_cast<std::size_t>(corner)]);
    }
  }
  render::BodyInput body() const {
    render::BodyInput input;
    input.positions = positions;
    input.normals = normals;
    input.triangles = triangles;
    input.joints = joints;
    input.weights = weights;
    input.joint_matrices = matrix;
    return input;
  }
};

// A unit cube.
TEST(DrawnSkin, DepthIsTheDistanceToTheNearestFaceWithinAndNoneWithout) {
  Boxes boxes;
  boxes.add({0, 0, 0}, {1, 1, 1});
  const skin::DrawnSkin skin(boxes.body());
  EXPECT_NEAR(skin.depth({0.5f, 0.5f, 0.5f}), 0.5f, 1e-6f);
  EXPECT_NEAR(skin.depth({0.1f, 0.4f, 0.8f}), 0.1f, 1e-6f);
  EXPECT_NEAR(skin.depth({0.5f, 0.999f, 0.5f}), 0.001f, 1e-6f);
  for (const Vector3f& p : {Vector3f(1.01f, 0.5f, 0.5f), Vector3f(-0.5f, 0.5f, 0.5f), Vector3f(0.5f, 3, -2)})
    EXPECT_EQ(skin.depth(p), 0);
}

// A small box through the face of a large one: its own faces are no way out of the large one.
TEST(DrawnSkin, PiecesWithinOneAnotherAreEachAskedAlone) {
  Boxes boxes;
  boxes.add({0, 0, 0}, {1, 1, 1});
  boxes.add({0.8f, 0.4f, 0.4f}, {1.2f, 0.6f, 0.6f});
  const skin::DrawnSkin skin(boxes.body());
  EXPECT_NEAR(skin.depth({0.5f, 0.5f, 0.5f}), 0.5f, 1e-6f);
  EXPECT_NEAR(skin.depth({0.81f, 0.5f, 0.5f}), 0.19f, 1e-6f);  // 0.01 in the small one
  EXPECT_NEAR(skin.depth({1.1f, 0.5f, 0.5f}), 0.1f, 1e-6f);
  EXPECT_EQ(skin.depth({1.1f, 0.7f, 0.5f}), 0);
}

}  // namespace drawn_skin_test
