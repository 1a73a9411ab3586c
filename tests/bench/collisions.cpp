#include "tests/bench/collisions.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>

#include "app/files/data_path.h"
#include "app/files/errors.h"
#include "tests/bench/cpu_clock.h"
#include "tests/bench/scene_times.h"
#include "tests/sim_probes.h"

namespace bench {

app::Actor makeDancer(const std::string& clip, app::Style style, app::Resolution resolution,
                      app::AssetCache& asset_cache) {
  app::CharacterSpec spec;
  spec.motion = app::findFile(clip, "", "clips");
  spec.style = style;
  spec.resolution = resolution;
  return app::makeActor(spec, app::PlaybackSpec{}, asset_cache);
}

namespace {

constexpr double kRest = 4;  // s of standing before rest is measured

double depthOf(const app::Actor& actor, int vertex) {
  double depth = 0;
  for (const sim::Ellipsoid& e : actor.ellipsoids) {
    const sim::Vec3& x = actor.hair.positions[vertex];
    if (test::implicitValue(e, x) < 0) depth = std::max(depth, -sim::closestPoint(e, x).distance);
  }
  return depth;
}

struct CollisionRow {
  double milliseconds = 0, iterations = 0, contacts = 0, entered = 0, left = 0, corrected = 0;  // per step
  double outer = 0, inner = 0;  // m, deepest external and internal vertex after a step
  int recoveries = 0;
};

CollisionRow measureClip(const sim::SimParams& params, int frames, app::Actor& actor) {
  app::settleActor(params, kSettle, actor);
  const sim::HairMesh& mesh = actor.haircut->mesh;
  std::vector<unsigned char> external(mesh.vertexCount(), 0);
  for (const int v : mesh.external_vertices) external[v] = 1;
  CollisionRow row;
  std::vector<double> times;
  std::set<std::pair<int, int>> before;
  for (int frame = 0; frame < frames; ++frame) {
    app::moveActor(params.time_step, actor);
    const double started = cpuSeconds();
    const sim::StepReport report = app::simulateActor(params, params.time_step, frame * params.time_step, actor);
    times.push_back(cpuSeconds() - started);
    std::set<std::pair<int, int>> now;
    for (const sim::Contact& c : actor.hair.contacts) now.insert({c.vertex, c.collider});
    for (const auto& key : now) row.entered += !before.contains(key);
    for (const auto& key : before) row.left += !now.contains(key);
    before = std::move(now);
    row.iterations += report.solver_iterations;
    row.contacts += report.contacts;
    row.corrected += report.corrected;
    row.recoveries += report.recoveries;
    for (int v = 0; v < mesh.vertexCount(); ++v) {
      if (mesh.isRoot(v)) continue;
      double& deepest = external[v] ? row.outer : row.inner;
      deepest = std::max(deepest, depthOf(actor, v));
    }
  }
  std::nth_element(times.begin(), times.begin() + times.size() / 2, times.end());
  row.milliseconds = 1e3 * times[times.size() / 2];
  for (double* sum : {&row.iterations, &row.contacts, &row.entered, &row.left, &row.corrected}) *sum /= frames;
  return row;
}

// Root mean square and largest vertex speed (m/s) over a second, `kRest` seconds after the figure has stood still.
std::pair<double, double> measureRest(const sim::SimParams& params, app::Actor& actor) {
  app::settleActor(params, kSettle, actor);
  double sum = 0, most = 0;
  const int steps = static_cast<int>(1 / params.time_step), still = static_cast<int>(kRest / params.time_step);
  for (int step = 0; step < still + steps; ++step) {
    app::simulateActor(params, params.time_step, 0, actor);
    if (step < still) continue;
    double square = 0;
    for (const sim::Vec3& v : actor.hair.velocities) square += v.squaredNorm(), most = std::max(most, v.norm());
    sum += square / static_cast<double>(actor.hair.velocities.size());
  }
  return {std::sqrt(sum / steps), most};
}

sim::SimParams paramsOf(const CollisionOptions& options) {
  sim::SimParams params;
  for (const auto& [name, text] : options.set) {
    const sim::ParamText done = sim::setParam(params, name, text);
    if (!done.ok) throw app::InputError("", "--set " + name, done.fault, "");
  }
  return params;
}

// Calls visit(name, style, resolution) for the wanted ones.
void eachStyle(const CollisionOptions& options, auto&& visit) {
  for (const app::Style style : {app::Style::kShort, app::Style::kShoulder, app::Style::kLong}) {
    for (const app::Resolution resolution : {app::Resolution::kLow, app::Resolution::kMedium, app::Resolution::kHigh}) {
      const std::string name = std::string(app::styleName(style)) + " " + std::string(app::resolutionName(resolution));
      const auto& wanted = options.styles;
      if (wanted.empty() || std::find(wanted.begin(), wanted.end(), name) != wanted.end())
        visit(name, style, resolution);
    }
  }
}

}  // namespace

void writeClips(const CollisionOptions& options, std::FILE* out) {
  const sim::SimParams params = paramsOf(options);
  std::fprintf(
      out,
      "| style | clip | ms a step | iterations | contacts | entered | left | corrected | outside vertices, mm inside | "
      "inner vertices, mm inside | recoveries |\n|---|---|---|---|---|---|---|---|---|---|---|\n");
  app::AssetCache asset_cache;
  for (const std::string& clip : options.clips) {
    eachStyle(options, [&](const std::string& name, app::Style style, app::Resolution resolution) {
      app::Actor actor = makeDancer(clip, style, resolution, asset_cache);
      const CollisionRow row = measureClip(params, options.frames, actor);
      std::fprintf(out, "| %s | %s | %.2f | %.1f | %.1f | %.2f | %.2f | %.2f | %.3f | %.1f | %d |\n", name.c_str(),
                   clip.c_str(), row.milliseconds, row.iterations, row.contacts, row.entered, row.left, row.corrected,
                   1e3 * row.outer, 1e3 * row.inner, row.recoveries);
      std::fflush(out);
    });
  }
}

void writeRests(const CollisionOptions& options, std::FILE* out) {
  const sim::SimParams params = paramsOf(options);
  std::fprintf(out, "| style | rest speed, RMS mm/s | largest mm/s | contacts |\n|---|---|---|---|\n");
  app::AssetCache asset_cache;
  eachStyle(options, [&](const std::string& name, app::Style style, app::Resolution resolution) {
    app::Actor actor = makeDancer("idle_turns.bvh", style, resolution, asset_cache);
    const auto [rms, most] = measureRest(params, actor);
    std::fprintf(out, "| %s | %.3f | %.2f | %zu |\n", name.c_str(), 1e3 * rms, 1e3 * most, actor.hair.contacts.size());
    std::fflush(out);
  });
}

}  // namespace bench
