#include "tests/bench/brush_cost.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "app/files/data_path.h"
#include "app/scene/demo.h"
#include "app/scene/edit/groom_brush.h"
#include "app/scene/edit/mesh_change.h"
#include "tests/bench/cpu_clock.h"

namespace bench {
namespace {

constexpr int kStrokes = 4, kStroke = 50, kPause = 110,
              kWarmUp = 30;  // frames; in a pause the balance comes to its end
constexpr int kCostFrames = kStrokes * (kStroke + kPause);
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
  app::Demo demo = app::openScene(std::move(scene), 1.5);
  app::Actor& actor = demo.actors[0];
  actor.context = std::make_unique<sim::StepContext>(actor.haircut->mesh, cpuSeconds);
  actor.context->refreshGradually(true);
  return demo;
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

// A parting over three root edges in a row.
std::string partingOf(const app::Demo& demo) {
  const sim::HairMeshShape& shape = demo.actors[0].haircut->mesh.shape;
  std::string text;
  int here = 20, before = -1;
  for (int k = 0; k < 3; ++k) {
    int next = -1;
    for (const sim::RootFace& face : shape.root_faces) {
      for (int i = 0; i < face.corner_count; ++i) {
        const int a = face.columns[static_cast<std::size_t>(i)],
                  b = face.columns[static_cast<std::size_t>((i + 1) % face.corner_count)];
        if (a == here && b != before) next = b;
      }
    }
    if (next < 0) break;
    text += (text.empty() ? "" : " ") + std::to_string(here) + " " + std::to_string(next);
    before = here, here = next;
  }
  return text;
}

using Sample = std::function<app::Request(int, const app::Demo&)>;

// What is asked for in a frame: samples of a stroke, its end, nothing while it pauses.
std::vector<app::Request> askedAt(int frame, const Sample& sample, const app::Demo& demo) {
  const int phase = frame % (kStroke + kPause);
  if (phase < kStroke) return {sample(frame, demo)};
  return phase == kStroke ? std::vector<app::Request>{{app::Ask::kEndGesture, "", ""}} : std::vector<app::Request>{};
}

// s, one a frame: the edit itself (the brush, rest quantities, what of the preconditioner follows them); in the step
// what is neither forces, solve nor contacts (gravity's balance); all else of the frame.
struct Frames {
  std::vector<double> edit, balance, rest, whole;
};

// Without a sample frames without an edit.
Frames framesOf(const Sample& sample) {
  app::Demo demo = walkingHair();
  Frames frames;
  for (int frame = 0; frame < kWarmUp + kCostFrames; ++frame) {
    if (sample && frame >= kWarmUp) demo.requests = askedAt(frame - kWarmUp, sample, demo);
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

namespace {

// s, one a frame: an edit's own work, and what the balance of the new shape takes in the same frame beyond what that
// stage takes without one (`usual`).
std::vector<double> costsOf(const Frames& frames, double usual) {
  std::vector<double> costs;
  for (std::size_t k = 0; k < frames.edit.size(); ++k)
    costs.push_back(frames.edit[k] + std::max(0.0, frames.balance[k] - usual));
  return costs;
}

// s, of the frames in which `values` has something.
std::vector<double> within(const std::vector<double>& values, double least) {
  std::vector<double> some;
  for (const double value : values) {
    if (value > least) some.push_back(value);
  }
  return some.empty() ? std::vector{0.0} : some;
}

// A change of the mesh's structure: its request, the frame that shows it, and the worst of those until the balance is
// whole.
void printMeshChanges() {
  std::printf("\n| mesh | the request | the frame | worst after it |\n|---|---|---|---|\n");
  const std::pair<const char*, const char*> changes[] = {{"add-layer", "3"}, {"remove-layer", "3"}, {"split", ""}};
  for (const auto& [name, text] : changes) {
    app::Demo demo = walkingHair();
    for (int frame = 0; frame < kWarmUp; ++frame) app::advanceFrame(demo, 1.0 / 60, {});
    demo.requests = {{app::Ask::kMesh, name, *text ? text : partingOf(demo)}};
    std::vector<double> times;
    double asked = 0;
    for (int frame = 0; frame < kPause; ++frame) {
      const double started = cpuSeconds();
      app::applyRequests(demo);
      if (frame == 0) asked = cpuSeconds() - started;
      app::advanceFrame(demo, 1.0 / 60, {});
      times.push_back(cpuSeconds() - started);
    }
    std::printf("| %s%s | %.1f | %.1f | %.1f |\n", name, demo.message_is_fault ? ": refused" : "", 1e3 * asked,
                1e3 * (times[0] - asked), 1e3 * *std::max_element(times.begin() + 1, times.end()));
  }
}

}  // namespace

// An edit's cost: its own work, and gravity's balance of the new shape, which steps go on with, frame by frame. That
// hair in motion takes the solver longer is no part of it, nor is a walking step's own worst: freezing moves nothing,
// and its frames' p99 is that of a walk.
bool runBrushCost() {
  const Frames still = framesOf({});
  const double step = percentile(still.rest, 0.5), other = percentile(still.balance, 0.5);
  std::printf("long high, walking: a frame without an edit takes %.2f ms, p99 %.2f\n",
              1e3 * percentile(still.whole, 0.5), 1e3 * percentile(still.whole, 0.99));
  std::printf("| brush | frame | frame, p99 | the edit | its p99 | balance, p99 | cost, p99 | hair in motion |\n");
  std::printf("|---|---|---|---|---|---|---|---|\n");
  bool holds = true;
  const auto row = [&](const std::string& name, const Sample& sample) {
    const Frames frames = framesOf(sample);
    const std::vector<double> edits = within(frames.edit, 1e-4);
    const double cost = percentile(costsOf(frames, other), 0.99);
    std::printf("| %s | %.2f | %.2f | %.2f | %.2f | %.2f | %.2f | %.2f |\n", name.c_str(),
                1e3 * percentile(frames.whole, 0.5), 1e3 * percentile(frames.whole, 0.99), 1e3 * percentile(edits, 0.5),
                1e3 * percentile(edits, 0.99), 1e3 * std::max(0.0, percentile(frames.balance, 0.99) - other),
                1e3 * cost, 1e3 * (percentile(frames.rest, 0.5) - step));
    std::fflush(stdout);
    holds = holds && cost <= kBound;
  };
  for (int tool = 0; tool < static_cast<int>(app::kBrushNames.size()); ++tool)
    row(std::string(app::kBrushNames[static_cast<std::size_t>(tool)]),
        [&](int k, const app::Demo& demo) { return sampleAt(k, static_cast<app::BrushTool>(tool), demo); });
  row("move", moveAt);
  printMeshChanges();
  return holds;
}

}  // namespace bench
