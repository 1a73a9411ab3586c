#include "tests/bench/brush_cost.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <string>
#include <vector>

#include "app/files/data_path.h"
#include "app/scene/demo.h"
#include "app/scene/edit/groom_brush.h"
#include "app/scene/edit/mesh_change.h"
#include "tests/bench/cpu_clock.h"

namespace bench {
namespace {

constexpr int kSamples = 200, kWarmUp = 30;
constexpr double kBound = 8e-3;  // s

double percentile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

app::Demo walkingHair() {
  app::Scene scene;
  app::CharacterSpec spec;
  spec.motion = app::findFile("walk.bvh", "", "clips");
  spec.style = app::Style::kLong;
  spec.resolution = app::Resolution::kHigh;
  scene.characters = {spec};
  return app::openScene(std::move(scene), 1.5);
}

// A stroke that wanders over the hair, a sample a frame.
app::Request sampleAt(int k, app::BrushTool tool, const app::Demo& demo) {
  const app::Actor& actor = demo.actors[0];
  const app::Rigid to_scalp = app::scalpToWorld(actor.body->character, actor.pose).inverse(Eigen::Isometry);
  const std::size_t vertex = (static_cast<std::size_t>(k) * 131) % actor.hair.positions.size();
  app::BrushSample sample;
  sample.tool = tool;
  sample.at = to_scalp * actor.hair.positions[vertex];
  sample.along = {0.004 * std::cos(0.3 * k), 0.002, 0.004 * std::sin(0.3 * k)};
  sample.radius = 0.05, sample.strength = 0.4;
  return {app::Ask::kBrush, std::string(app::kBrushNames[static_cast<std::size_t>(tool)]), app::brushText(sample)};
}

// A drag of a column that swings to and fro, mirrored, a sample a frame.
app::Request moveAt(int k, const app::Demo& demo) {
  const int column = k / 20 * 7 % demo.actors[0].haircut->mesh.columnCount();
  const app::Vec3 along(0.004 * std::cos(0.3 * k), 0.001, 0.004 * std::sin(0.3 * k));
  return {app::Ask::kMove, "column", app::moveText({app::MeshElement::kColumn, {column}, along, 0.05, 1, true})};
}

// Strokes of three samples that end, and frames that finish the cut.
std::vector<app::Request> cutAndEnd(int k, const app::Demo& demo) {
  constexpr int kEvery = 25;
  const int phase = k % kEvery;
  if (phase < 3) return {sampleAt(k / kEvery, app::BrushTool::kCut, demo)};
  return phase == 3 ? std::vector<app::Request>{{app::Ask::kEndGesture, "", ""}} : std::vector<app::Request>{};
}

using Sample = std::function<std::vector<app::Request>(int, const app::Demo&)>;

// s, one a frame: the edit itself (the brush, rest quantities, what of the preconditioner follows them); in the step
// what is neither forces, solve nor contacts (gravity's balance); all else of the frame.
struct Frames {
  std::vector<double> edit, balance, rest, whole;
};

// Without a sample frames without an edit.
Frames framesOf(const Sample& sample) {
  app::Demo demo = walkingHair();
  Frames frames;
  for (int frame = 0; frame < kWarmUp + kSamples; ++frame) {
    if (sample && frame >= kWarmUp) demo.requests = sample(frame, demo);
    const double started = cpuSeconds();
    app::applyRequests(demo);
    const double edited = cpuSeconds();
    app::advanceFrame(demo, 1.0 / 60, {});
    const double ended = cpuSeconds();
    if (frame < kWarmUp) continue;
    frames.edit.push_back(edited - started);
    const double balance = demo.stats.seconds[app::kTimeStepOther];
    frames.balance.push_back(balance);
    frames.rest.push_back(ended - edited - balance);
    frames.whole.push_back(ended - started);
  }
  return frames;
}

}  // namespace

// An edit's cost: its own work, and gravity's balance of the new shape, which steps go on with. That hair in motion
// takes the solver longer is no part of it, nor is a walking step's own worst: freezing moves nothing, and its frames'
// p99 is that of a walk.
bool runBrushCost() {
  const Frames still = framesOf({});
  const double step = percentile(still.rest, 0.5), other = percentile(still.balance, 0.5);
  std::printf("long high, walking: a frame without an edit takes %.2f ms, p99 %.2f\n",
              1e3 * percentile(still.whole, 0.5), 1e3 * percentile(still.whole, 0.99));
  std::printf("| brush | frame | frame, p99 | the edit | its p99 | balance | cost, p99 | hair in motion |\n");
  std::printf("|---|---|---|---|---|---|---|---|\n");
  bool holds = true;
  const auto row = [&](const std::string& name, const Sample& sample) {
    const Frames frames = framesOf(sample);
    const double worst = percentile(frames.edit, 0.99);
    const double balance = std::max(0.0, percentile(frames.balance, 0.5) - other);
    std::printf("| %s | %.2f | %.2f | %.2f | %.2f | %.2f | %.2f | %.2f |\n", name.c_str(),
                1e3 * percentile(frames.whole, 0.5), 1e3 * percentile(frames.whole, 0.99),
                1e3 * percentile(frames.edit, 0.5), 1e3 * worst, 1e3 * balance, 1e3 * (worst + balance),
                1e3 * (percentile(frames.rest, 0.5) - step));
    std::fflush(stdout);
    holds = holds && worst + balance <= kBound;
  };
  for (int tool = 0; tool < static_cast<int>(app::kBrushNames.size()); ++tool)
    row(std::string(app::kBrushNames[static_cast<std::size_t>(tool)]), [&](int k, const app::Demo& demo) {
      return std::vector{sampleAt(k, static_cast<app::BrushTool>(tool), demo)};
    });
  row("cut, and its end", cutAndEnd);
  row("move", [](int k, const app::Demo& demo) { return std::vector{moveAt(k, demo)}; });
  return holds;
}

}  // namespace bench
