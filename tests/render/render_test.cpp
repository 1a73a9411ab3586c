// Laws of the picture: what is drawn, uploaded and kept, drawn offscreen on whatever OpenGL there is.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <stdexcept>

#include "render/gl/render_target.h"
#include "render/gl/shader.h"
#include "render/passes.h"
#include "render/renderer.h"
#include "render/stage.h"
#include "tests/draw_skips.h"
#include "tests/gl_fixture.h"
#include "tests/golden_compare.h"
#include "tests/synthetic_hair.h"

namespace render_test {

constexpr int kWidth = 320, kHeight = 180;

// A scene that owns what the frame's spans point to.
struct Scene {
  synthetic::Hair hair = synthetic::makeHair();
  synthetic::Body body = synthetic::makeBody();
  std::vector<render::HairInput> hairs;
  std::vector<render::BodyInput> bodies;

  explicit Scene(int strands = 800) : hairs{synthetic::hairInput(hair, strands)}, bodies{synthetic::bodyInput(body)} {}
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;

  render::FrameInput frame() const { return synthetic::frameInput(hairs, bodies, kWidth, kHeight); }
};

// Mean luminance (0..1) of a rectangle of the picture, in display values.
double meanLuminance(const app::Image& image, int left, int top, int right, int bottom) {
  double sum = 0;
  for (int y = top; y < bottom; ++y) {
    for (int x = left; x < right; ++x) {
      const unsigned char* pixel = &image.rgba[(static_cast<std::size_t>(y) * image.width + x) * 4];
      sum += (0.2126 * pixel[0] + 0.7152 * pixel[1] + 0.0722 * pixel[2]) / 255;
    }
  }
  return sum / ((right - left) * (bottom - top));
}

class RenderTest : public gl_fixture::GlTest {
 protected:
  static render::Renderer& renderer() {
    static render::Renderer shared(gl_fixture::kShaderDir);
    return shared;
  }
  static app::Image draw(const render::FrameInput& frame, render::FrameReport* report = nullptr) {
    app::Image image{frame.width, frame.height, {}};
    const render::FrameReport drawn = renderer().renderImage(frame, image.rgba);
    if (report != nullptr) *report = drawn;
    return image;
  }
  // Forgets what the shared renderer keeps of earlier tests' scenes, which reuse ids.
  void SetUp() override {
    GlTest::SetUp();
    if (IsSkipped()) return;
    render::FrameInput nothing;
    nothing.width = nothing.height = 16;
    draw(nothing);
  }
};

TEST_F(RenderTest, TheSameInputGivesTheSameBytes) {
  Scene scene;
  const app::Image first = draw(scene.frame()), second = draw(scene.frame());
  EXPECT_EQ(first.rgba, second.rgba);
  render::Renderer other(gl_fixture::kShaderDir);
  app::Image third{kWidth, kHeight, {}};
  other.renderImage(scene.frame(), third.rgba);
  EXPECT_EQ(first.rgba, third.rgba);
}

TEST_F(RenderTest, TheNumberOfStrandsLeavesTheColour) {
  std::vector<double> luminances;
  for (const int strands : {5000, 20000, 100000, 250000}) {
    Scene scene(strands);
    luminances.push_back(meanLuminance(draw(scene.frame()), 120, 30, 200, 90));
    std::printf("%d strands: luminance %.4f\n", strands, luminances.back());
  }
  EXPECT_LT(std::ranges::max(luminances), 1.03 * std::ranges::min(luminances));
}

struct View {
  const char* name;
  render::Float3 eye;
};
constexpr View kGoldenViews[] = {
    {"hair_front", {0.25f, 1.6f, 0.85f}}, {"hair_side", {0.85f, 1.62f, 0.1f}}, {"hair_back", {-0.35f, 1.75f, -0.8f}}};

TEST_F(RenderTest, EveryAngleMatchesItsGolden) {
  Scene scene(4000);
  for (const View& view : kGoldenViews) {
    render::FrameInput frame = scene.frame();
    frame.camera.eye = view.eye;
    golden::expectGolden(draw(frame), view.name, render::rendererName());
  }
}

// What the golden views show is the same with every exact skip as with none, also when the frame, its maps and its rows
// are those of the frame before; all skips stay within the bounds of the table of skips.
TEST_F(RenderTest, EveryGoldenAngleIsTheSameWithAndWithoutSkips) {
  Scene scene(4000);
  const auto at = [&](const View& view, const render::DrawSkips& skips) {
    render::FrameInput frame = scene.frame();
    frame.camera.eye = view.eye;
    frame.skips = skips;
    return frame;
  };
  std::vector<app::Image> without;
  for (const View& view : kGoldenViews) without.push_back(draw(at(view, draw_skips::none())));
  for (std::size_t i = 0; i < without.size(); ++i) {
    for (const char* again : {"", ", again"}) {
      EXPECT_EQ(draw(at(kGoldenViews[i], draw_skips::exact())).rgba, without[i].rgba) << kGoldenViews[i].name << again;
    }
  }
  for (std::size_t i = 0; i < without.size(); ++i) {
    render::FrameInput frame = at(kGoldenViews[i], {});
    const app::Image all = draw(frame);
    frame.view.show_strands = false;
    const double off = draw_skips::differenceOver(without[i], all, draw(frame));
    std::printf("%s: %.2f levels with all skips\n", kGoldenViews[i].name, off);
    EXPECT_LE(off, draw_skips::kDetailBound) << kGoldenViews[i].name;
  }
}

TEST_F(RenderTest, ASmallRealChangeIsCaught) {
  Scene scene;
  const app::Image image = draw(scene.frame());
  app::Image changed = image;
  for (int y = 60; y < 74; ++y) {
    for (int x = 150; x < 164; ++x) changed.rgba[(static_cast<std::size_t>(y) * kWidth + x) * 4] ^= 0x40;
  }
  const golden::Limits limits;
  EXPECT_EQ(golden::compare(image, image, limits.tolerance).outliers, 0);
  EXPECT_GT(golden::compare(image, changed, limits.tolerance).outliers, limits.outlier_share * kWidth * kHeight);
  scene.hairs[0].look.curl_radius = 0.006f;
  EXPECT_GT(golden::compare(image, draw(scene.frame()), limits.tolerance).outliers,
            limits.outlier_share * kWidth * kHeight);
}

TEST_F(RenderTest, EverySettingOfTheLookChangesThePicture) {
  Scene scene(300);
  // Close, so that even the frizz of single strands shows.
  render::FrameInput frame = scene.frame();
  frame.camera.eye = {0.25f, 1.6f, 0.45f};
  frame.light.shadow_size = 256;
  const app::Image before = draw(frame);
  using Look = render::HairLook;
  const std::vector<std::pair<const char*, void (*)(Look&)>> changes{
      {"strand_radius", [](Look& l) { l.strand_radius *= 2; }},
      {"taper", [](Look& l) { l.taper = 1; }},
      {"length_variation", [](Look& l) { l.length_variation = 0.5f; }},
      {"offset", [](Look& l) { l.offset = 0.01f; }},
      {"clump", [](Look& l) { l.clump = 1; }},
      {"clump_size", [](Look& l) { l.clump_size = 0.03f; }},
      {"lock", [](Look& l) { l.lock = 1; }},
      {"wisp", [](Look& l) { l.wisp = 1; }},
      {"drift", [](Look& l) { l.drift = 0.01f; }},
      {"root_spread", [](Look& l) { l.root_spread = 0.01f; }},
      {"curl_radius", [](Look& l) { l.curl_radius = 0.01f; }},
      {"wave_height", [](Look& l) { l.wave_height = 0.02f; }},
      {"frizz", [](Look& l) { l.frizz = 0.01f; }},
      {"flyaways", [](Look& l) { l.flyaways = 0.6f; }},
      {"flyaway_lift", [](Look& l) { l.flyaways = 0.6f, l.flyaway_lift = 0.03f; }},
      {"hairline", [](Look& l) { l.hairline = 0.03f; }},
      {"baby_hairs", [](Look& l) { l.baby_hairs = 0; }},
      {"eumelanin", [](Look& l) { l.eumelanin = 0.1f; }},
      {"pheomelanin", [](Look& l) { l.pheomelanin = 3; }},
      {"color",
       [](Look& l) {
         l.use_color = true, l.color = {0.1f, 0.2f, 0.7f};
       }},
      {"root_darkening", [](Look& l) { l.root_darkening = 1; }},
      {"tint_variation", [](Look& l) { l.tint_variation = 1; }},
      {"beta_m", [](Look& l) { l.beta_m = 0.7f; }},
      {"beta_n", [](Look& l) { l.beta_n = 0.8f; }},
      {"eta", [](Look& l) { l.eta = 1.9f; }},
      {"cuticle_angle", [](Look& l) { l.cuticle_angle = 0.25f; }},
      {"shine_variation", [](Look& l) { l.shine_variation = 0.8f; }},
      {"specular", [](Look& l) { l.specular = 4; }},
      {"diffuse", [](Look& l) { l.diffuse = 0; }},
      {"seed", [](Look& l) { l.seed = 77; }},
  };
  for (const auto& [name, change] : changes) {
    scene.hairs[0].look = Look{};
    change(scene.hairs[0].look);
    EXPECT_GT(golden::compare(before, draw(frame), 2).outliers, 50) << name;
  }
}

TEST_F(RenderTest, AHairKeepsLittleMemoryWhateverTheStrandCount) {
  Scene scene;
  ASSERT_GE(scene.hair.positions.size() / 3, 361u);
  render::FrameReport few, many;
  draw(scene.frame(), &few);
  scene.hairs[0].strands = 30000;
  scene.hairs[0].segments_per_layer = 1;
  render::FrameInput all_strands = scene.frame();
  all_strands.skips.strands = false;
  draw(all_strands, &many);
  EXPECT_GT(few.gpu_bytes_hair, static_cast<long>(scene.hair.positions.size() * sizeof(float)));
  EXPECT_LE(few.gpu_bytes_hair, 66 * 1024);
  EXPECT_EQ(few.gpu_bytes_hair, many.gpu_bytes_hair);
  EXPECT_EQ(many.strands_drawn, 30000);
}

TEST_F(RenderTest, OnlyWhatChangedIsUploaded) {
  Scene scene;
  render::FrameReport first, still, moved, recoloured;
  draw(scene.frame(), &first);
  draw(scene.frame(), &still);
  EXPECT_EQ(still.bytes_uploaded, 0);
  EXPECT_LT(still.draw_calls, first.draw_calls) << "shadows of a still scene are kept";
  scene.hair.positions[400] += 0.01f;
  ++scene.hairs[0].position_revision;
  draw(scene.frame(), &moved);
  EXPECT_GT(moved.bytes_uploaded, 0);
  EXPECT_LT(moved.bytes_uploaded, first.bytes_uploaded / 2) << "the body's mesh and the layout stay";
  scene.hairs[0].look.eumelanin = 3;
  draw(scene.frame(), &recoloured);
  EXPECT_GT(recoloured.bytes_uploaded, 0);
}

TEST_F(RenderTest, WhatIsNoLongerShownIsFreed) {
  Scene scene;
  scene.hairs.push_back(scene.hairs[0]);
  scene.hairs[1].id = 2;
  render::FrameReport both, one, swapped;
  draw(scene.frame(), &both);
  scene.hairs.erase(scene.hairs.begin());
  draw(scene.frame(), &one);
  EXPECT_GT(both.gpu_bytes_hair, one.gpu_bytes_hair);
  EXPECT_LE(one.bytes_uploaded, 16 * static_cast<long>(scene.hair.faces.size()))
      << "the second hair is recognised by its id; only its draw table moved";
}

TEST_F(RenderTest, PositionsThatAreNotFiniteLeaveTheLastGoodPicture) {
  Scene scene;
  const app::Image good = draw(scene.frame());
  scene.hair.positions[100] = std::numeric_limits<float>::quiet_NaN();
  ++scene.hairs[0].position_revision;
  EXPECT_EQ(draw(scene.frame()).rgba, good.rgba);
  scene.hairs[0].id = 9;  // a hair that never was finite is not drawn at all
  render::FrameReport report;
  draw(scene.frame(), &report);
  EXPECT_EQ(report.strands_drawn, 0);
}

TEST_F(RenderTest, EmptyAndBrokenInputsDrawWhatTheyCan) {
  Scene scene;
  render::FrameInput frame = scene.frame();
  frame.hairs = {};
  frame.bodies = {};
  EXPECT_EQ(draw(frame).rgba.size(), static_cast<std::size_t>(kWidth * kHeight * 4));
  frame.width = 0;
  EXPECT_TRUE(draw(frame).rgba.empty());
  scene.hairs[0].strands = 0;
  scene.body.triangles[5] = 1u << 30;
  scene.bodies[0].mesh_id = 77;
  render::FrameReport report;
  draw(scene.frame(), &report);
  EXPECT_EQ(report.strands_drawn, 0);
}

TEST_F(RenderTest, BodiesFollowTheirJoints) {
  Scene scene;
  scene.hairs.clear();
  const app::Image before = draw(scene.frame());
  scene.body.joint_matrices[0][12] = 0.2f;
  EXPECT_EQ(draw(scene.frame()).rgba, before.rgba) << "the revision says that nothing changed";
  scene.bodies[0].joint_matrices = scene.body.joint_matrices;
  ++scene.bodies[0].pose_revision;
  EXPECT_GT(golden::compare(before, draw(scene.frame()), 12).outliers, kWidth * kHeight / 20);
}

TEST_F(RenderTest, HairShadesTheBodyAndTheBodyShadesTheGround) {
  Scene scene(3000);
  render::FrameInput frame = scene.frame();
  frame.view.show_strands = true;
  const app::Image shadowed = draw(frame);
  frame.light.shadows = false;
  const app::Image bright = draw(frame);
  EXPECT_LT(meanLuminance(shadowed, 164, 72, 172, 92), 0.9 * meanLuminance(bright, 164, 72, 172, 92));
  frame = scene.frame();
  frame.camera.eye = {1.5f, 2.5f, 3.0f};
  frame.camera.target = {-0.4f, 0, -0.5f};
  const app::Image ground = draw(frame);
  frame.light.shadows = false;
  EXPECT_GT(golden::compare(ground, draw(frame), 12).outliers, kWidth * kHeight / 200);
}

TEST_F(RenderTest, DebugShapesAreSeenAndFaintWhereHidden) {
  Scene scene;
  render::FrameInput frame = scene.frame();
  const app::Image plain = draw(frame);
  const std::vector<render::LineVertex> line{{{-0.3f, 1.52f, 0.3f}, {1, 0.1f, 0.1f, 1}},
                                             {{0.3f, 1.52f, 0.3f}, {1, 0.1f, 0.1f, 1}}};
  const std::vector<render::LineVertex> behind{{{-0.12f, 1.53f, -0.23f}, {0.1f, 1, 0.1f, 1}},
                                               {{-0.06f, 1.53f, -0.25f}, {0.1f, 1, 0.1f, 1}}};
  frame.debug_lines = line;
  EXPECT_GT(golden::compare(plain, draw(frame), 40).outliers, 60);
  frame.debug_lines = behind;
  const golden::Difference hidden = golden::compare(plain, draw(frame), 3);
  EXPECT_GT(hidden.outliers, 10);
  EXPECT_LT(hidden.largest, 110);
}

// A slab of evenly strewn, straight, level strands under a light from straight above.
struct Slab {
  static constexpr float kSide = 0.2f, kThickness = 0.04f;
  std::vector<render::HairFace> faces;
  std::vector<float> positions;

  Slab() {
    constexpr int kCells = 4, kLayers = 5;
    for (int j = 0; j <= kCells; ++j) {
      for (int i = 0; i <= kCells; ++i) {
        for (int layer = 0; layer < kLayers; ++layer) {
          positions.insert(positions.end(),
                           {kSide * layer / (kLayers - 1), -kThickness * j / kCells, kSide * i / kCells});
        }
      }
    }
    for (int j = 0; j < kCells; ++j) {
      for (int i = 0; i < kCells; ++i) {
        const auto at = [&](int row, int column) { return (row * (kCells + 1) + column) * kLayers; };
        render::HairFace face;
        face.layers = kLayers;
        face.area = 1;
        face.first_vertex = {at(j, i), at(j, i + 1), at(j + 1, i + 1), at(j + 1, i)};
        faces.push_back(face);
      }
    }
  }
};

constexpr int kDepths = 33;
constexpr float kTop = 0.004f, kReach = Slab::kThickness + 0.008f;  // m: probes start above the slab and end below it

// Optical depth down the slab, averaged over many places. The shadow maps are bound.
std::array<double, kDepths> meanOpticalDepth(const std::string& shaders) {
  constexpr int kPlaces = 64;
  const render::ShaderProgram probe(shaders, {{"probe.vert"}, {}, {"tau"}});
  render::Buffer result = render::makeBuffer();
  glNamedBufferStorage(result.id(), kDepths * 4, nullptr, 0);
  render::ImageTarget target;
  target.prepare(4, 4);
  glBindFramebuffer(GL_FRAMEBUFFER, target.framebuffer());
  render::VertexArray none = render::makeVertexArray();
  glBindVertexArray(none.id());
  std::array<double, kDepths> mean{};
  probe.use();
  glEnable(GL_RASTERIZER_DISCARD);
  for (int place = 0; place < kPlaces; ++place) {
    const float x = Slab::kSide * (0.2f + 0.6f * static_cast<float>(place % 8) / 7.1f);
    const float z = Slab::kSide * (0.2f + 0.6f * static_cast<float>(place / 8) / 7.1f);
    glUniform4f(0, x, kTop, z, 0);
    glUniform4f(1, 0, -kReach / (kDepths - 1), 0, 0);
    glBindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, result.id());
    glBeginTransformFeedback(GL_POINTS);
    glDrawArrays(GL_POINTS, 0, kDepths);
    glEndTransformFeedback();
    std::array<float, kDepths> tau{};
    glGetNamedBufferSubData(result.id(), 0, sizeof(tau), tau.data());
    for (int i = 1; i < kDepths; ++i) EXPECT_GE(tau[i], tau[i - 1] - 1e-3f) << "light cannot return";
    for (int i = 0; i < kDepths; ++i) mean[i] += tau[i] / kPlaces;
  }
  glDisable(GL_RASTERIZER_DISCARD);
  return mean;
}

TEST_F(RenderTest, DeepOpacityFallsMonotonicallyAndMatchesTheHairCrossed) {
  const std::string folder = gl_fixture::copyShaders("probe_shaders");
  std::ofstream(folder + "/probe.vert") << R"(#include "shared.h"
#include "common/shadow.glsl"
layout(location = 0) uniform vec4 first;
layout(location = 1) uniform vec4 step;
out float tau;
void main() { tau = hairOpticalDepths(0, hairShadowCoordinates(0, first.xyz + float(gl_VertexID) * step.xyz)).x; }
)";
  const Slab slab;
  render::HairInput hair;
  hair.layout_revision = hair.position_revision = 1;
  hair.faces = slab.faces;
  hair.positions = slab.positions;
  hair.strands = 40000;
  hair.look = synthetic::plainLook();
  hair.look.taper = 1;
  hair.look.strands_represented = 40000;
  render::FrameInput input;
  input.hairs = {&hair, 1};
  input.light.to_light = {0, 1, 0};
  input.light.shadow_strands = 0;
  input.light.layer_thickness = 0.002f;
  input.light.shadow_size = 256;
  input.skips = draw_skips::none();

  render::Stage stage;
  render::FrameReport report;
  stage.update(input, report);
  const std::initializer_list<render::PassMaker> makers{render::makePass<render::PlanPass>,
                                                        render::makePass<render::HairShadowPass>};
  for (const render::PassMaker make : makers) {
    const render::PassEntry pass = make(folder);
    pass.update(pass.pass.get(), input);
    pass.draw(pass.pass.get(), stage, report);
  }
  stage.shadows.bindMaps();

  const std::array<double, kDepths> mean = meanOpticalDepth(folder);
  // Even hairs stop light by diameter x count / (width x thickness) per metre.
  const double extinction =
      static_cast<double>(hair.strands) * 2 * hair.look.strand_radius / (Slab::kSide * Slab::kThickness);
  EXPECT_LT(mean[0], 1e-3);
  for (int i = 0; i < kDepths; ++i) {
    const double depth = std::clamp<double>(kReach * i / (kDepths - 1) - kTop, 0, Slab::kThickness);
    const double expected = std::exp(-extinction * depth);
    EXPECT_NEAR(std::exp(-mean[i]), expected, 0.06) << "at depth " << depth;
  }
}

TEST_F(RenderTest, ABrokenShaderNamesItsFileAndLine) {
  const std::string folder = gl_fixture::copyShaders("broken_shaders");
  {
    std::ofstream include(folder + "/common/film.glsl", std::ios::app);
    include << "\nvec3 broken() { return nonsense; }\n";
  }
  std::ifstream whole(folder + "/common/film.glsl");
  const auto lines = std::count(std::istreambuf_iterator<char>(whole), {}, '\n');
  try {
    render::Renderer broken(folder);
    FAIL() << "a broken shader was accepted";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("common/film.glsl:" + std::to_string(lines)), std::string::npos)
        << error.what();
  }
  std::filesystem::remove(folder + "/common/film.glsl");
  try {
    render::Renderer missing(folder);
    FAIL() << "a missing shader was accepted";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("film.glsl"), std::string::npos) << error.what();
  }
}

TEST_F(RenderTest, TenThousandStrandsAreReportedWithTheirTimes) {
  Scene scene(10000);
  render::FrameInput frame = scene.frame();
  frame.width = 640;
  frame.height = 360;
  app::Image image{640, 360, {}};
  renderer().renderImage(frame, image.rgba);
  scene.hair.positions[400] += 0.001f;
  ++scene.hairs[0].position_revision;
  const auto start = std::chrono::steady_clock::now();
  const render::FrameReport report = renderer().renderImage(frame, image.rgba, true);
  const double wall = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  double stages = 0;
  for (const render::StageTime& stage : report.stages) {
    stages += stage.milliseconds;
    std::printf("%s %.1f ms, ", stage.name, stage.milliseconds);
  }
  std::printf("in all %.0f ms for 640x360, 10,000 strands\n", wall);
  EXPECT_EQ(report.strands_drawn, 10000);
  EXPECT_GT(stages, 0);
  EXPECT_LE(stages, wall * 1.05 + 1);
}

}  // namespace render_test
