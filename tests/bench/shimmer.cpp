#include "tests/bench/shimmer.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <utility>
#include <vector>

#include "app/files/data_path.h"
#include "app/platform/egl_context.h"
#include "app/scene/demo.h"
#include "render/renderer.h"
#include "tests/bench/draw_scene.h"

namespace bench {
namespace {

constexpr int kShimmerWidth = 240, kShimmerHeight = 240, kShimmerFrames = 8;
constexpr double kShimmerFrame = 1.0 / 60;
constexpr double kMostShimmer = 1.15;  // times the reference

struct MovingScene {
  const char* name;
  const char* file;
  int before;   // frames
  double turn;  // rad a frame, of the camera; 0: the figure moves
};
constexpr std::array<MovingScene, 2> kMovingScenes{
    {{"slow camera", "default.json", 60, 0.0017}, {"head shake", "head_shake.json", 40, 0}}};

// Levels, mean over pixels and channels: how far a frame is from the middle between those before and after it. What
// glides evenly adds nothing.
double shimmerOf(const std::vector<LevelPicture>& frames) {
  double sum = 0;
  std::size_t count = 0;
  for (std::size_t t = 1; t + 1 < frames.size(); ++t) {
    for (std::size_t k = 0; k < frames[t].levels.size(); ++k, ++count)
      sum += std::abs(frames[t - 1].levels[k] - 2 * frames[t].levels[k] + frames[t + 1].levels[k]) / 2;
  }
  return sum / static_cast<double>(count);
}

std::pair<double, double> shimmer(const MovingScene& moving, render::Renderer& renderer) {
  app::Scene opened = app::loadScene(app::dataPath(std::string("assets/scenes/") + moving.file));
  opened.camera.framing = "head";
  app::Demo demo = app::openScene(std::move(opened), static_cast<double>(kShimmerWidth) / kShimmerHeight);
  demo.picture_height = kShimmerHeight;
  for (int frame = 0; frame < moving.before; ++frame) app::advanceFrame(demo, frame == 0 ? 0 : kShimmerFrame, {});
  demo.camera.follow = false;
  if (moving.turn != 0) demo.paused = true;
  std::vector<LevelPicture> drawn, true_ones;
  std::vector<unsigned char> rgba;
  for (int frame = 0; frame < kShimmerFrames; ++frame) {
    app::advanceFrame(demo, kShimmerFrame, {});
    demo.camera.yaw += moving.turn;
    renderer.renderImage(app::frameInput(demo, kShimmerWidth, kShimmerHeight), rgba);
    drawn.push_back(levelsOf(kShimmerWidth, kShimmerHeight, rgba));
    true_ones.push_back(referencePicture(demo, kShimmerWidth, kShimmerHeight, renderer));
    for (float& level : true_ones.back().levels) level = std::round(level);  // as a picture of its size has it
  }
  return {shimmerOf(drawn), shimmerOf(true_ones)};
}

}  // namespace

bool runShimmer() {
  const app::EglContext context;
  render::Renderer renderer(app::dataPath("shaders"));
  std::printf("| motion | drawn, levels | reference, levels | times |\n|---|---|---|---|\n");
  bool holds = true;
  for (const MovingScene& moving : kMovingScenes) {
    const auto [drawn, reference] = shimmer(moving, renderer);
    std::printf("| %s | %.2f | %.2f | %.2f |\n", moving.name, drawn, reference, drawn / reference);
    std::fflush(stdout);
    holds = holds && drawn <= kMostShimmer * reference;
  }
  return holds;
}

}  // namespace bench
