// The table of skips, its drawing part: exact ones change no byte of the picture, approximate ones stay in their
// bound, and crowds are shadowed and small in memory.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string>
#include <string_view>
#include <vector>

#include "app/files/data_path.h"
#include "app/scene/demo.h"
#include "render/gl/driver.h"
#include "render/renderer.h"
#include "tests/draw_skips.h"
#include "tests/gl_fixture.h"
#include "tests/golden_compare.h"
#include "tests/synthetic_hair.h"

namespace skips_draw_test {

using draw_skips::draw;

constexpr int kWidth = 320, kHeight = 180;

using draw_skips::differenceOver, draw_skips::kBodyBound, draw_skips::kDetailBound, draw_skips::kExact,
    draw_skips::kSmallBodyBound, draw_skips::kSmallBound, draw_skips::NamedSkip, draw_skips::none;

// Figures in a row from (0, 0, 0) backwards, every other one a little aside.
struct Crowd {
  synthetic::Hair hair = synthetic::makeHair();
  synthetic::Body body = synthetic::makeBody();
  std::vector<std::vector<float>> positions;
  std::vector<std::array<render::Mat4, 1>> joints;
  std::vector<render::HairInput> hairs;
  std::vector<render::BodyInput> bodies;

  Crowd(int count, float gap, int strands) : positions(count), joints(count) {
    for (int i = 0; i < count; ++i) {
      joints[i] = body.joint_matrices;
      positions[i] = hair.positions;
      hairs.push_back(synthetic::hairInput(hair, strands));
      bodies.push_back(synthetic::bodyInput(body));
      hairs[i].id = bodies[i].id = static_cast<std::uint64_t>(i + 1);
      hairs[i].layout_id = 7;
      hairs[i].positions = positions[i];
      bodies[i].joint_matrices = joints[i];
      place(i, i % 2 ? 0.35f * gap : 0.0f, -gap * static_cast<float>(i));
    }
  }
  Crowd(const Crowd&) = delete;
  Crowd& operator=(const Crowd&) = delete;

  void place(int i, float x, float z) {
    const float dx = x - joints[i][0][12], dz = z - joints[i][0][14];
    for (std::size_t v = 0; v < positions[i].size(); v += 3) {
      positions[i][v] += dx;
      positions[i][v + 2] += dz;
    }
    joints[i][0][12] = x;
    joints[i][0][14] = z;
    ++hairs[i].position_revision;
    ++bodies[i].pose_revision;
  }
  render::FrameInput frame(const render::DrawSkips& skips) const {
    render::FrameInput input = synthetic::frameInput(hairs, bodies, kWidth, kHeight);
    input.skips = skips;
    return input;
  }
};

class SkipsDraw : public gl_fixture::GlTest {};

// A sequence in which hair, bodies, light and camera move and stand still in turn, seen near and partly outside.
TEST_F(SkipsDraw, ExactSkipsChangeNoByte) {
  std::vector<render::DrawSkips> sets{none(), draw_skips::exact()};
  for (const NamedSkip& skip : kExact) sets.push_back(none()), sets.back().*skip.on = true;
  std::vector<std::vector<app::Image>> pictures;
  std::vector<render::DrawSkipCounts> counts(sets.size());
  for (std::size_t s = 0; s < sets.size(); ++s) {
    render::Renderer renderer(gl_fixture::kShaderDir);
    Crowd crowd(3, 0.5f, 300);
    crowd.place(2, 6, 3);  // beside and behind the camera
    std::vector<app::Image>& images = pictures.emplace_back();
    render::FrameInput frame = crowd.frame(sets[s]);
    const auto show = [&] {
      render::FrameReport report;
      images.push_back(draw(renderer, frame, &report));
      for (const NamedSkip& skip : kExact) counts[s].*skip.count += report.skip_counts.*skip.count;
    };
    show();
    show();
    crowd.positions[0][400] += 0.02f;
    ++crowd.hairs[0].position_revision;
    show();
    frame.camera.eye = {0.1f, 1.66f, 0.32f};  // so near that bundles and body lie outside
    frame.camera.target = {0.02f, 1.62f, 0};
    show();
    crowd.place(1, 0.3f, -0.6f);
    show();
    frame.light.to_light = {-0.5f, 0.7f, 0.5f};
    show();
  }
  for (std::size_t s = 1; s < sets.size(); ++s) {
    // Where a map is left out the others lie elsewhere in their texture, and its filter rounds, on GPUs to a 256th of a
    // texel: a level or two in a few pixels, on GPUs 15 (seen on an H200).
    const int rounding = render::rasterizesInSoftware() ? 2 : 20;
    const bool moved = s == 1 || std::string_view(kExact[s - 2].name) == "shadow_view";
    for (std::size_t i = 0; i < pictures[0].size(); ++i) {
      const golden::Difference difference = golden::compare(pictures[s][i], pictures[0][i], 0);
      const char* name = s < 2 ? "all" : kExact[s - 2].name;
      EXPECT_LE(difference.outliers, moved ? 20 : 0) << name << ", picture " << i;
      EXPECT_LE(difference.largest, moved ? rounding : 0) << name << ", picture " << i;
    }
    if (s < 2) continue;
    const NamedSkip& skip = kExact[s - 2];
    EXPECT_GT((counts[s].*skip.count).skipped, 0) << skip.name << " left nothing out: the scene shows nothing of it";
    EXPECT_LE((counts[s].*skip.count).skipped, (counts[s].*skip.count).of) << skip.name;
    EXPECT_EQ((counts[0].*skip.count).skipped, 0) << skip.name;
  }
}

TEST_F(SkipsDraw, AStillFrameIsKeptAndAnyChangeSeen) {
  render::Renderer renderer(gl_fixture::kShaderDir);
  Crowd crowd(2, 0.4f, 300);
  render::DrawSkips skips = none();
  skips.frame = true;
  render::FrameInput frame = crowd.frame(skips);
  const auto isKept = [&] {
    render::FrameReport report;
    draw(renderer, frame, &report);
    return report.skip_counts.frame.skipped == 1;
  };
  EXPECT_FALSE(isKept());
  EXPECT_TRUE(isKept());
  frame.camera.fov_y += 0.01f;
  EXPECT_FALSE(isKept());
  EXPECT_TRUE(isKept());
  frame.light.key[0] += 0.1f;
  EXPECT_FALSE(isKept());
  frame.view.ground = false;
  EXPECT_FALSE(isKept());
  crowd.place(1, 0.5f, -0.4f);
  EXPECT_FALSE(isKept());
  crowd.hairs[0].look.eumelanin += 0.1f;
  EXPECT_FALSE(isKept());
  crowd.hairs[0].strands += 10;
  EXPECT_FALSE(isKept());
  crowd.bodies[0].color[0] += 0.1f;
  EXPECT_FALSE(isKept());
  EXPECT_TRUE(isKept());
  const std::vector<render::LineVertex> line(2);
  frame.debug_lines = line;
  EXPECT_FALSE(isKept());
  EXPECT_FALSE(isKept());
  frame.debug_lines = {};
  EXPECT_FALSE(isKept()) << "the lines are gone";
  frame.hairs = frame.hairs.first(1);
  EXPECT_FALSE(isKept());
  EXPECT_TRUE(isKept());
  frame.width -= 2;
  EXPECT_FALSE(isKept());
}

TEST_F(SkipsDraw, DetailStaysInItsBound) {
  struct Detail {
    const char* name;
    bool render::DrawSkips::*on;
  };
  for (const float distance : {0.9f, 3.0f, 8.0f, 20.0f}) {
    // The hair sways before the picture is taken, so that what is renewed now and then has become old.
    const auto picture = [&](const render::DrawSkips& skips, bool strands = true) {
      render::Renderer renderer(gl_fixture::kShaderDir);
      Crowd crowd(1, 1, 6000);
      crowd.hairs[0].rest = crowd.hair.positions;  // else it would be what is seen first
      render::FrameInput frame = crowd.frame(skips);
      frame.camera.eye = {0.25f * distance, 1.62f, 0.97f * distance};
      frame.view.show_strands = strands;
      app::Image image;
      for (int moment = 0; moment < (skips.sky_visibility ? 5 : 1); ++moment) {
        const float sway = skips.sky_visibility ? 0.05f * static_cast<float>(moment - 4) : 0;
        for (std::size_t v = 0; v < crowd.positions[0].size(); v += 3)
          crowd.positions[0][v] = crowd.hair.positions[v] + sway * (1.7f - crowd.hair.positions[v + 1]);
        ++crowd.hairs[0].position_revision;
        image = draw(renderer, frame);
      }
      return image;
    };
    const app::Image full = picture(none()), bald = picture(none(), false);
    for (const Detail& detail :
         {Detail{"strands", &render::DrawSkips::strands}, Detail{"segments", &render::DrawSkips::segments},
          Detail{"shadow detail", &render::DrawSkips::shadow_detail},
          Detail{"sky-visibility", &render::DrawSkips::sky_visibility}}) {
      render::DrawSkips skips = none();
      skips.*detail.on = true;
      const double off = differenceOver(full, picture(skips), bald);
      std::printf("%s at %.1f m: %.2f levels\n", detail.name, distance, off);
      EXPECT_LE(off, distance > 15 ? kSmallBound : kDetailBound) << detail.name << " at " << distance << " m";
    }
  }
}

// The bald mannequin walking, near and far: what differs is its rim and the light's interpolation over its skin. Mean
// of four views: of the 40 pixels that it has far away one view tells little.
TEST_F(SkipsDraw, BodyDetailStaysInItsBound) {
  app::Scene scene = app::loadScene(app::dataPath("assets/scenes/walk.json"));
  scene.camera.follow = false;
  scene.playback.settle = 0;
  app::Demo demo = app::openScene(std::move(scene), static_cast<double>(kWidth) / kHeight);
  for (int frame = 0; frame < 12; ++frame) app::advanceFrame(demo, 1.0 / 60, {});
  render::Renderer renderer(gl_fixture::kShaderDir);
  constexpr std::array kTurns{0.3f, 1.9f, 3.4f, 5.0f};  // rad
  for (const float distance : {6.0f, 12.0f, 25.0f}) {
    double off = 0;
    render::SkipCount count;
    for (const float turn : kTurns) {
      render::FrameInput frame = app::frameInput(demo, kWidth, kHeight);
      frame.camera.target = {0, 0.9f, 0};
      frame.camera.eye = {distance * std::sin(turn), 1.2f, distance * std::cos(turn)};
      frame.view.show_strands = false;
      frame.skips = none();
      const app::Image full = draw(renderer, frame);
      frame.skips.body_detail = true;
      render::FrameReport report;
      const app::Image merged = draw(renderer, frame, &report);
      frame.skips.body_detail = frame.view.show_body = false;
      off += differenceOver(full, merged, draw(renderer, frame)) / kTurns.size();
      count = report.skip_counts.body_detail;
    }
    std::printf("at %.0f m: %.2f levels, %ld of %ld triangles left out\n", distance, off, count.skipped, count.of);
    EXPECT_LE(off, distance > 10 ? kSmallBodyBound : kBodyBound) << distance << " m away";
    EXPECT_GT(count.skipped, count.of / 3) << distance << " m away";
  }
}

// A fifth hair and all further ones are as dark at their inside as the first.
TEST_F(SkipsDraw, CrowdsAllHaveShadows) {
  render::Renderer renderer(gl_fixture::kShaderDir);
  Crowd crowd(9, 0.45f, 400);
  for (int i = 0; i < 9; ++i) crowd.place(i, 0.5f * static_cast<float>(i - 4), 0);
  render::FrameInput frame = crowd.frame({});
  frame.camera.eye = {0, 1.6f, 5};
  frame.camera.target = {0, 1.5f, 0};
  const app::Image with = draw(renderer, frame);
  frame.light.shadow_strength = 0;
  const app::Image without = draw(renderer, frame);
  // The figures stand side by side: each one's column of the picture must have become darker.
  for (int i = 0; i < 9; ++i) {
    const double metre = kHeight / (2 * std::tan(0.3) * 5);
    const int middle = static_cast<int>(kWidth / 2 + 0.5 * (i - 4) * metre);
    long dark = 0;
    for (int y = kHeight / 4; y < 3 * kHeight / 4; ++y) {
      for (int x = middle - 6; x <= middle + 6; ++x) {
        const std::size_t p = 4 * (static_cast<std::size_t>(y) * kWidth + static_cast<std::size_t>(x));
        dark += int(without.rgba[p]) - int(with.rgba[p]);
      }
    }
    EXPECT_GT(dark, 300) << "figure " << i;
  }
}

TEST_F(SkipsDraw, AFurtherCharacterCostsLittleMemory) {
  render::Renderer renderer(gl_fixture::kShaderDir);
  const auto bytes = [&](int count) {
    Crowd crowd(count, 3, 20000);
    render::FrameReport report;
    draw(renderer, crowd.frame({}), &report);
    return report.gpu_bytes_hair + report.gpu_bytes_shadows;
  };
  const long ten = bytes(10), thirty = bytes(30);
  EXPECT_LE((thirty - ten) / 20, 100 * 1024);
}

// The crowd's places (assets/scenes/crowd.json): one near, ten to a row behind it. Shadow maps follow the sizes in
// the picture, which is all that is drawn of it here: a strip as narrow as there is, in which all hairs' shadows may
// fall.
TEST_F(SkipsDraw, AFurtherCharacterCostsLittleMemoryInTallPictures) {
  for (const int height : {144, 360, 720, 1080, 2160}) {
    const auto bytes = [&](int count) {
      render::Renderer renderer(gl_fixture::kShaderDir);
      Crowd crowd(count, 0, 100);
      for (int i = 1; i < count; ++i) {
        const int row = (i + 9) / 10, column = (i + 9) % 10;
        crowd.place(i, (1.05f + 0.1f * static_cast<float>(row)) * (static_cast<float>(column) - 4.5f),
                    0.7f - 2.9f * static_cast<float>(row));
      }
      render::FrameInput frame = crowd.frame({});
      frame.width = 16;
      frame.height = height;
      frame.view.samples = 1;
      frame.skips.view = frame.skips.shadow_view = false;
      frame.camera.eye = {0.25f, 1.72f, 1.15f};
      frame.camera.target = {0.1f, 1.5f, 0};
      render::FrameReport report;
      draw(renderer, frame, &report);
      return report.gpu_bytes_hair + report.gpu_bytes_shadows;
    };
    const long one = bytes(1), two = bytes(2), ten = bytes(10), hundred = bytes(100);
    std::printf("%d rows: %ld KB, then %ld, %ld and %ld for each further one of 2, 10 and 100\n", height, one / 1024,
                (two - one) / 1024, (ten - one) / 9 / 1024, (hundred - one) / 99 / 1024);
    for (const long more : {two - one, (ten - one) / 9, (hundred - one) / 99}) EXPECT_LE(more, 100 * 1024) << height;
  }
}

// Flicker: as the camera backs away, a frame differs from the next by no more with detail that follows than without.
TEST_F(SkipsDraw, BackingAwayDoesNotFlicker) {
  double change[2] = {0, 0};
  for (int with = 0; with < 2; ++with) {
    render::Renderer renderer(gl_fixture::kShaderDir);
    Crowd crowd(1, 1, 6000);
    app::Image before;
    for (int step = 0; step < 12; ++step) {
      render::FrameInput frame = crowd.frame(with ? render::DrawSkips{} : none());
      const float distance = 3.5f * std::pow(1.02f, static_cast<float>(step));
      frame.camera.eye = {0.25f * distance, 1.62f, 0.97f * distance};
      const app::Image image = draw(renderer, frame);
      if (step > 0) change[with] += golden::compare(before, image, 0).mean;
      before = image;
    }
  }
  std::printf("mean change a frame: %.4f levels without, %.4f with\n", change[0] / 11, change[1] / 11);
  EXPECT_LE(change[1], 1.15 * change[0] + 0.01);
}

}  // namespace skips_draw_test
