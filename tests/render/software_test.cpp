// Strands in software: the picture of the shader stages, whatever the view, the samples and the order of the frames;
// and what it leaves out.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include "app/files/data_path.h"
#include "app/scene/demo.h"
#include "render/gl/driver.h"
#include "render/renderer.h"
#include "render/software/software_strands.h"
#include "shaders/shared.h"
#include "tests/bench/cpu_clock.h"
#include "tests/draw_skips.h"
#include "tests/gl_fixture.h"
#include "tests/golden_compare.h"
#include "tests/synthetic_hair.h"

namespace software_test {

using draw_skips::draw;

using render::StrandPath;

constexpr int kWidth = 320, kHeight = 180;

struct Scene {
  synthetic::Hair hair = synthetic::makeHair();
  synthetic::Body body = synthetic::makeBody();
  std::vector<render::SkinEllipsoid> skin;
  std::vector<std::vector<float>> positions;
  std::vector<render::HairInput> hairs;
  std::vector<render::BodyInput> bodies;

  // balls: their radii over the usual ones.
  explicit Scene(int count = 1, int strands = 1500, float balls = 1)
      : positions(static_cast<std::size_t>(count), hair.positions) {
    // A head that reaches into the hair, and two balls: one in the hair, one far from it.
    for (const auto& [x, y, z, radius] :
         {std::array{0.0f, 1.6f, 0.0f, 0.1f}, {0.1f, 1.45f, 0.05f, 0.04f}, {0.0f, 0.5f, 0.0f, 0.2f}}) {
      const float scale = 1 / (balls * radius);
      skin.push_back({{{{scale, 0, 0, -scale * x}, {0, scale, 0, -scale * y}, {0, 0, scale, -scale * z}}}});
    }
    for (int i = 0; i < count; ++i) {
      std::vector<float>& placed = positions[static_cast<std::size_t>(i)];
      for (std::size_t v = 0; v < placed.size(); v += 3) placed[v] += 0.3f * static_cast<float>(i);
      hairs.push_back(synthetic::hairInput(hair, strands));
      hairs.back().id = static_cast<std::uint64_t>(i + 1);
      hairs.back().positions = placed;
      hairs.back().skin = skin;
    }
    bodies.push_back(synthetic::bodyInput(body));
  }
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;

  render::FrameInput frame(StrandPath path) const {
    render::FrameInput input = synthetic::frameInput(hairs, bodies, kWidth, kHeight);
    input.view.strand_path = path;
    return input;
  }
};

class Software : public gl_fixture::GlTest {
 protected:
  // Drivers place the edges of triangles to within a 256th of a pixel, and lines by rules of their own; and the shader
  // stages carry light on past a segment's end to a pixel's middle.
  static void expectAlike(const app::Image& a, const app::Image& b, const std::string& what) {
    const golden::Difference difference = golden::compare(a, b, 12);
    std::printf("%s: %ld pixels off by more than 12 levels, mean %.3f\n", what.c_str(), difference.outliers,
                difference.mean);
    EXPECT_LT(difference.outliers, static_cast<long>(a.rgba.size()) / 4 / 300) << what;
    EXPECT_LT(difference.mean, 0.2) << what;
  }
};

TEST_F(Software, DrawsThePictureOfTheShaderStages) {
  render::Renderer renderer(gl_fixture::kShaderDir);
  struct View {
    const char* name;
    render::Float3 eye;
    int samples, hairs;
  };
  for (const View& view : {View{"front", {0.25f, 1.6f, 0.85f}, 4, 1}, View{"one sample", {0.85f, 1.62f, 0.1f}, 1, 1},
                           View{"two samples", {0.85f, 1.62f, 0.1f}, 2, 1}, View{"near", {0.1f, 1.65f, 0.25f}, 4, 1},
                           View{"far", {0.5f, 1.6f, 4.0f}, 4, 1}, View{"three hairs", {0.25f, 1.7f, 1.2f}, 4, 3}}) {
    const Scene scene(view.hairs);
    render::FrameInput frame = scene.frame(StrandPath::kGeometry);
    frame.camera.eye = view.eye;
    frame.view.samples = view.samples;
    const app::Image stages = draw(renderer, frame);
    frame.view.strand_path = StrandPath::kSoftware;
    render::FrameReport report;
    const app::Image software = draw(renderer, frame, &report);
    expectAlike(stages, software, view.name);
    EXPECT_GT(report.strands_drawn, 100) << view.name;
    // Only what the picture shows is shaded, and what is left out is counted.
    EXPECT_GT(report.skip_counts.shading.skipped, 0) << view.name;
    EXPECT_LT(report.skip_counts.shading.skipped, report.skip_counts.shading.of) << view.name;
  }
}

// OpenGL promises 65,535 groups in a row.
TEST_F(Software, MorePointsThanARowOfGroupsTakesAreAllShaded) {
  render::Renderer renderer(gl_fixture::kShaderDir);
  Scene scene(1, 60000);
  scene.hairs[0].segments_per_layer = 8;
  render::FrameInput frame = scene.frame(StrandPath::kSoftware);
  const app::Image some = draw(renderer, frame);
  frame.skips.shading = frame.skips.segments = frame.skips.strands = false;
  render::FrameReport report;
  const app::Image all = draw(renderer, frame, &report);
  EXPECT_GT(report.strand_vertices / 2, 65535L * render::shared::kStrandGroup);
  const golden::Difference difference = golden::compare(some, all, 60);
  EXPECT_LT(difference.outliers, static_cast<long>(all.rgba.size()) / 4 / 100);
}

// Samples of an earlier picture leave no trace, nor does another size.
TEST_F(Software, EveryFrameIsWhatAFreshRendererDraws) {
  render::Renderer used(gl_fixture::kShaderDir);
  const Scene scene;
  render::FrameInput frame = scene.frame(StrandPath::kSoftware);
  frame.skips.shadow_detail = false;  // a map's size stays while it is off by little
  for (int turn = 0; turn < 4; ++turn) {
    frame.width = turn == 2 ? kWidth / 2 : kWidth;
    frame.camera.eye = {0.3f * static_cast<float>(turn), 1.6f, 0.9f};
    render::Renderer fresh(gl_fixture::kShaderDir);
    EXPECT_EQ(draw(used, frame).rgba, draw(fresh, frame).rgba) << turn;
  }
}

TEST_F(Software, AutoIsTheSoftwarePathOnLlvmpipeAlone) {
  EXPECT_EQ(render::pathFor(StrandPath::kGeometry), StrandPath::kGeometry);
  EXPECT_EQ(render::pathFor(StrandPath::kSoftware), StrandPath::kSoftware);
  const std::string name = render::rendererName();
  const bool llvmpipe = name.find("llvmpipe") != std::string::npos && name.find("zink") == std::string::npos;
  EXPECT_EQ(render::pathFor(StrandPath::kAuto),
            llvmpipe ? StrandPath::kSoftware : render::pathFor(StrandPath::kCompute));
}

TEST_F(Software, SkinOutOfReachAndHiddenPointsChangeNoByte) {
  const Scene scene(1, 1500, 0.4f);  // so small that lower layers are out of reach
  for (const StrandPath path : {StrandPath::kSoftware, StrandPath::kGeometry}) {
    render::FrameInput frame = scene.frame(path);
    frame.skips = draw_skips::none();
    render::Renderer plain(gl_fixture::kShaderDir), skipping(gl_fixture::kShaderDir);
    const app::Image all = draw(plain, frame);
    frame.skips.skin = frame.skips.shading = true;
    render::FrameReport report;
    EXPECT_EQ(all.rgba, draw(skipping, frame, &report).rgba);
    EXPECT_GT(report.skip_counts.skin.skipped, 0);
    EXPECT_LT(report.skip_counts.skin.skipped, report.skip_counts.skin.of);
  }
}

// The mannequin under its hair: by vertices against by pixels.
TEST_F(Software, HairLightAtVerticesStaysInItsBound) {
  app::Scene scene = app::loadScene(app::dataPath("assets/scenes/walk.json"));
  scene.camera.follow = false;
  scene.playback.settle = 0;
  app::Demo demo = app::openScene(std::move(scene), static_cast<double>(kWidth) / kHeight);
  for (int frame = 0; frame < 12; ++frame) app::advanceFrame(demo, 1.0 / 60, {});
  render::Renderer renderer(gl_fixture::kShaderDir);
  for (const float distance : {0.9f, 2.0f, 4.0f}) {
    render::FrameInput frame = app::frameInput(demo, kWidth, kHeight);
    frame.camera.target = {0, 1.4f, 0};
    frame.camera.eye = {0.3f * distance, 1.5f, 0.95f * distance};
    frame.skips = draw_skips::none();
    const app::Image pixels = draw(renderer, frame);
    frame.skips.hair_light = true;
    render::FrameReport report;
    const app::Image vertices = draw(renderer, frame, &report);
    frame.view.show_body = false;
    const double off = draw_skips::differenceOver(pixels, vertices, draw(renderer, frame));
    std::printf("at %.1f m: %.2f levels\n", distance, off);
    EXPECT_LE(off, draw_skips::kBodyBound) << distance << " m away";
    EXPECT_GT(report.skip_counts.hair_light.skipped, 0);
  }
}

// What the path is for. Processor time of all threads, in turns: other work beside slows both.
TEST_F(Software, IsSeveralTimesFasterOnASoftwareDriver) {
  if (render::pathFor(StrandPath::kAuto) != StrandPath::kSoftware) GTEST_SKIP() << "not on " << render::rendererName();
  render::Renderer renderer(gl_fixture::kShaderDir);
  const Scene scene(1, 6000);
  const auto seconds = [&](StrandPath path) {
    render::FrameInput frame = scene.frame(path);
    frame.skips.frame = frame.skips.shadows = false;
    const double start = bench::secondsOf(CLOCK_PROCESS_CPUTIME_ID);
    draw(renderer, frame);
    return bench::secondsOf(CLOCK_PROCESS_CPUTIME_ID) - start;
  };
  double stages = 1e9, software = 1e9;
  for (int run = 0; run < 4; ++run) {
    stages = std::min(stages, seconds(StrandPath::kGeometry));
    software = std::min(software, seconds(StrandPath::kSoftware));
  }
  std::printf("by shader stages %.2f times as long\n", stages / software);
  EXPECT_GT(stages, 1.5 * software);
}

}  // namespace software_test
