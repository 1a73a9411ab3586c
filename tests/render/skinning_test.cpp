// Skinning: what the shaders draw, and the girth of a bent elbow.
#include "render/body/skinning.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <vector>

#include "render/body/body_store.h"
#include "render/gl/render_target.h"
#include "render/gl/shader.h"
#include "shaders/shared.h"
#include "tests/gl_fixture.h"

namespace skinning_test {

using Eigen::Vector3f;

constexpr int kRing = 16, kRows = 41;
constexpr float kRadius = 0.033f, kHalf = 0.2f;  // m

// A tube along x, its half at +x on joint 1; weights go over within 3 cm about the joint at the origin.
struct Arm {
  std::vector<float> positions, normals, weights;
  std::vector<std::uint16_t> joints;
  std::vector<std::uint32_t> triangles{0, 1, 2};
  std::array<render::Mat4, 2> matrices{};

  explicit Arm(const Eigen::Affine3f& fore) {
    for (int row = 0; row < kRows; ++row) {
      const float x = kHalf * (2.0f * row / (kRows - 1) - 1), fore_share = std::clamp(0.5f + x / 0.06f, 0.0f, 1.0f);
      for (int k = 0; k < kRing; ++k) {
        const float turn = 2 * EIGEN_PI * k / kRing;
        const Vector3f normal(0, std::cos(turn), std::sin(turn));
        positions.insert(positions.end(), {x, kRadius * normal.y(), kRadius * normal.z()});
        normals.insert(normals.end(), normal.begin(), normal.end());
        joints.insert(joints.end(), {0, 1, 0, 0});
        weights.insert(weights.end(), {1 - fore_share, fore_share, 0, 0});
      }
    }
    const Eigen::Affine3f still = Eigen::Affine3f::Identity();
    std::copy_n(still.data(), 16, matrices[0].begin());
    std::copy_n(fore.data(), 16, matrices[1].begin());
  }
  render::BodyInput input() const {
    render::BodyInput body;
    body.id = body.mesh_id = body.pose_revision = 1;
    body.positions = positions;
    body.normals = normals;
    body.triangles = triangles;
    body.joints = joints;
    body.weights = weights;
    body.joint_matrices = matrices;
    return body;
  }
};

// m from the joint to the nearest vertex of the ring around it.
float girth(const Arm& arm) {
  const std::vector<Vector3f> world = render::skinnedPositions(arm.input());
  float least = 1;
  for (int k = 0; k < kRing; ++k) least = std::min(least, world[(kRows / 2) * kRing + k].norm());
  return least;
}

Eigen::Affine3f bent(float degrees) {
  return Eigen::Affine3f(Eigen::AngleAxisf(degrees * static_cast<float>(EIGEN_PI) / 180, Vector3f::UnitZ()));
}

TEST(Skinning, ABentElbowKeepsItsGirth) {
  for (const float angle : {0.0f, 60.0f, 120.0f, 150.0f, -150.0f})
    EXPECT_GT(girth(Arm(bent(angle))), 0.99f * kRadius) << angle;
  // A blend of matrices, taken where a joint scales, pinches it.
  EXPECT_LT(girth(Arm(bent(150) * Eigen::Scaling(1.01f))), 0.5f * kRadius);
}

TEST(Skinning, OnlyRigidMotionsBecomeDualQuaternions) {
  const auto motions = [](const Eigen::Affine3f& fore) { return render::rigidMotions(Arm(fore).matrices).size(); };
  EXPECT_EQ(motions(Eigen::Translation3f(3, 4, 5) * bent(200)), 2U);
  EXPECT_EQ(motions(bent(20) * Eigen::Scaling(1.01f)), 0U);
  EXPECT_EQ(motions(Eigen::Affine3f(Eigen::Scaling(1.0f, 1.0f, -1.0f))), 0U) << "a mirror image";
}

class SkinningShader : public gl_fixture::GlTest {
 protected:
  // What the shader makes of the vertices.
  static std::vector<Vector3f> drawn(const render::BodyInput& input) {
    const render::ShaderProgram program(gl_fixture::kShaderDir, {{"body.vert"}, {}, {"world"}});
    render::BodyStore store;
    store.update({&input, 1});
    const std::size_t count = input.positions.size() / 3;
    render::Buffer result = render::makeBuffer();
    glNamedBufferStorage(result.id(), static_cast<GLsizeiptr>(count * 12), nullptr, 0);
    render::ImageTarget target;
    target.prepare(4, 4);
    glBindFramebuffer(GL_FRAMEBUFFER, target.framebuffer());
    program.use();
    store.bind(store.bodies()[0], store.meshOf(store.bodies()[0]));
    glEnable(GL_RASTERIZER_DISCARD);
    glBindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, result.id());
    glBeginTransformFeedback(GL_POINTS);
    glDrawArrays(GL_POINTS, 0, static_cast<GLsizei>(count));
    glEndTransformFeedback();
    glDisable(GL_RASTERIZER_DISCARD);
    std::vector<Vector3f> world(count);
    glGetNamedBufferSubData(result.id(), 0, static_cast<GLsizeiptr>(count * 12), world.data());
    return world;
  }
};

TEST_F(SkinningShader, IsWhatTheProcessorComputes) {
  for (const float scale : {1.0f, 1.2f}) {
    const Arm arm(Eigen::Translation3f(0.1f, -2, 0.3f) * bent(130) * Eigen::Scaling(scale));
    const std::vector<Vector3f> expected = render::skinnedPositions(arm.input()), found = drawn(arm.input());
    float most = 0;
    for (std::size_t v = 0; v < found.size(); ++v) most = std::max(most, (found[v] - expected[v]).norm());
    EXPECT_LT(most, 2e-6f) << "m, scale " << scale;
    EXPECT_GT((found.front() - found.back()).norm(), 0.1f);
  }
}

}  // namespace skinning_test
