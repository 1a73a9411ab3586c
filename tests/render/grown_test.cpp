// Strands that compute shaders have grown are drawn as those of the geometry stage.
#include "render/grown/grown_strands.h"

#include <gtest/gtest.h>

#include <vector>

#include "render/renderer.h"
#include "tests/gl_fixture.h"
#include "tests/golden_compare.h"
#include "tests/synthetic_hair.h"

namespace grown_test {

constexpr int kWidth = 320, kHeight = 180;

class Grown : public gl_fixture::GlTest {
 protected:
  // How the pictures of both ways differ.
  static golden::Difference differenceOf(render::FrameInput frame) {
    render::Renderer renderer(gl_fixture::kShaderDir);
    app::Image geometry{kWidth, kHeight, {}}, compute = geometry;
    frame.view.strand_path = render::StrandPath::kGeometry;
    renderer.renderImage(frame, geometry.rgba);
    frame.view.strand_path = render::StrandPath::kCompute;
    renderer.renderImage(frame, compute.rgba);
    return golden::compare(geometry, compute, 8);
  }
};

struct Scene {
  synthetic::Hair hair = synthetic::makeHair();
  synthetic::Body body = synthetic::makeBody();
  std::vector<render::HairInput> hairs;
  std::vector<render::BodyInput> bodies{synthetic::bodyInput(body)};

  explicit Scene(int strands) : hairs{synthetic::hairInput(hair, strands)} {}
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;

  render::FrameInput frame() const { return synthetic::frameInput(hairs, bodies, kWidth, kHeight); }
};

TEST_F(Grown, StrandsAreTheGeometryStages) {
  const Scene scene(800);
  const golden::Difference difference = differenceOf(scene.frame());
  EXPECT_LT(difference.outliers, kWidth * kHeight / 500);
  EXPECT_LT(difference.mean, 0.05);
}

// More strands than lie in the buffers at a time, in the picture and in its shadows.
TEST_F(Grown, StrandsOfManyBatchesToo) {
  const Scene scene(50000);
  render::FrameInput frame = scene.frame();
  frame.light.shadow_strands = 0;
  frame.skips.strands = frame.skips.segments = frame.skips.shadow_detail = false;
  const golden::Difference difference = differenceOf(frame);
  EXPECT_LT(difference.outliers, kWidth * kHeight / 500);
  EXPECT_LT(difference.mean, 0.05);
}

}  // namespace grown_test
