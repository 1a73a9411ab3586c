#include "tests/bench/ladder.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "app/files/data_path.h"
#include "app/scene/detail/governor.h"
#include "tests/bench/cpu_clock.h"
#include "tests/bench/measured_part.h"
#include "tests/bench/scene_times.h"
#include "tests/bench/table.h"
#include "tests/bench/trajectory.h"

namespace bench {
namespace {

using sim::Integrator;
using sim::SimParams;

constexpr double kSample = 0.2, kSeconds = 2;  // s; every step length below divides a sample
constexpr double kLadderRate = 1920;           // 1/s

struct Candidate {
  Integrator integrator;
  double rate, tolerance;
  int max_iterations = 60;
};

std::vector<Candidate> candidates() {
  std::vector<Candidate> list;
  for (const double rate : {10.0, 15.0, 20.0, 30.0, 60.0, 120.0, 240.0}) {
    for (const double tolerance : {1e-1, 1e-2, 1e-3}) {
      if (rate < 60 && tolerance < 1e-2) continue;
      list.push_back({Integrator::kLinearizedEuler, rate, tolerance});
    }
  }
  list.push_back({Integrator::kLinearizedEuler, 20, 1e-1, 4});
  list.push_back({Integrator::kLinearizedEuler, 30, 1e-1, 4});
  for (const double rate : {60.0, 120.0, 240.0, 480.0, 960.0}) {
    for (const double tolerance : {1e-1, 1e-2, 1e-3}) list.push_back({Integrator::kBdf2, rate, tolerance});
  }
  return list;
}

struct LadderRun {
  Trajectory trajectory;
  double seconds = 0;
};

class Stage {
 public:
  explicit Stage(const TrajectoryScene& scene) : collide_(scene.collide) {
    app::CharacterSpec spec;
    spec.motion = app::findFile(scene.motion, "", "clips");
    spec.style = scene.style;
    spec.resolution = scene.resolution;
    actor_ = app::makeActor(spec, {}, asset_cache_);
    SimParams params;
    params.collide = collide_;
    app::settleActor(params, kSettle, actor_);
    start_ = actor_.hair;
    playback_ = actor_.playback;
  }
  double hairLength() const { return actor_.haircut->mesh.hair_length; }

  LadderRun run(SimParams params, double rate) {
    params.collide = collide_;
    params.time_step = 1 / rate;
    actor_.playback = playback_;
    app::placeActor(actor_, true);
    actor_.hair = start_;
    LadderRun result;
    const int steps_a_sample = static_cast<int>(std::lround(rate * kSample));
    const int samples = static_cast<int>(std::lround(kSeconds / kSample));
    for (int sample = 0, step = 1; sample < samples; ++sample) {
      for (int k = 0; k < steps_a_sample; ++k, ++step) {
        app::moveActor(params.time_step, actor_);
        const double started = cpuSeconds();
        app::simulateActor(params, params.time_step, step * params.time_step, actor_);
        if (step > 1) result.seconds += cpuSeconds() - started;  // the first makes the factor
      }
      result.trajectory.push_back(actor_.hair.positions);
    }
    return result;
  }

 private:
  bool collide_;
  app::AssetCache asset_cache_;
  app::Actor actor_;
  sim::HairState start_;
  app::Playback playback_;
};

SimParams paramsOf(const Candidate& candidate) {
  SimParams params;
  params.integrator = candidate.integrator;
  params.tolerance = candidate.tolerance;
  params.max_iterations = candidate.max_iterations;
  return params;
}

double fastest(Stage& stage, const Candidate& candidate, int runs, Trajectory& trajectory) {
  double least = 1e9;
  for (int k = 0; k < runs; ++k) {
    LadderRun run = stage.run(paramsOf(candidate), candidate.rate);
    least = std::min(least, run.seconds);
    trajectory = std::move(run.trajectory);
  }
  return least;
}

// What the candidates cost and how far they stray, scene by scene, and their geometric means.
struct LadderErrors {
  std::vector<std::string> scenes;
  std::vector<std::vector<double>> errors;  // [candidate][scene], over hair length
  std::vector<double> cost, error;          // [candidate]
};

LadderErrors measureCandidates(const std::vector<Candidate>& list, int runs) {
  LadderErrors measured;
  measured.errors.resize(list.size());
  measured.cost.resize(list.size()), measured.error.resize(list.size());  // sums of logarithms, to begin with
  for (const TrajectoryScene& scene : trajectoryScenes()) {
    const std::string name = scene.name;
    if (name != "head_shake" && name != "walk_contact" && name != "walk_shoulder" && name != "jump_1x") continue;
    measured.scenes.push_back(name);
    Stage stage(scene);
    SimParams reference;
    reference.integrator = Integrator::kBdf2;
    reference.precision = sim::Precision::kDouble;
    reference.tolerance = 1e-9;
    reference.acceleration_tolerance = 0;
    reference.max_iterations = 2000;
    const Trajectory truth = stage.run(reference, kLadderRate).trajectory;
    Trajectory trajectory;
    const double standard = fastest(stage, {Integrator::kLinearizedEuler, 60, SimParams{}.tolerance}, runs, trajectory);
    for (std::size_t c = 0; c < list.size(); ++c) {
      const double seconds = fastest(stage, list[c], runs, trajectory);
      const TrajectoryError strayed = difference(trajectory, truth, stage.hairLength(), static_cast<int>(truth.size()));
      measured.errors[c].push_back(strayed.rms);
      measured.cost[c] += std::log(seconds / standard);
      measured.error[c] += std::log(std::max(strayed.rms, 1e-9));
      std::printf("%-14s %-16s 1/%-4.0f %.0e %4d  cost %6.3f  rms %.2e  most %.2e\n", scene.name,
                  sim::paramText(*sim::findParam("integrator"), paramsOf(list[c])).c_str(), list[c].rate,
                  list[c].tolerance, list[c].max_iterations, seconds / standard, strayed.rms, strayed.most);
    }
  }
  const auto scenes = static_cast<double>(measured.scenes.size());
  for (double& sum : measured.cost) sum = std::exp(sum / scenes);
  for (double& sum : measured.error) sum = std::exp(sum / scenes);
  return measured;
}

void printFront(const std::vector<Candidate>& list, const LadderErrors& measured) {
  std::printf("\nthe rows that no other beats in both:\n");
  std::vector<std::size_t> order(list.size());
  for (std::size_t c = 0; c < order.size(); ++c) order[c] = c;
  std::ranges::sort(order, {}, [&](std::size_t c) { return measured.cost[c]; });
  double best = 1e9;
  for (const std::size_t c : order) {
    if (measured.error[c] >= best) continue;
    best = measured.error[c];
    std::printf("%-16s 1/%-4.0f tolerance %.0e, %d iterations: cost %.3f, error %.2e\n",
                sim::paramText(*sim::findParam("integrator"), paramsOf(list[c])).c_str(), list[c].rate,
                list[c].tolerance, list[c].max_iterations, measured.cost[c], measured.error[c]);
  }
}

bool isOf(const app::Rung& rung, const Candidate& candidate) {
  return candidate.integrator == rung.integrator && candidate.rate == rung.steps_per_second &&
         candidate.tolerance == rung.tolerance && candidate.max_iterations == rung.max_iterations;
}

// The rungs as they are written down and as they were measured now.
std::string rungTable(const std::vector<Candidate>& list, const LadderErrors& measured) {
  std::string table = "| rung | cost, ladder's | cost, measured | error, ladder's | error, measured |",
              rule = "|---|---|---|---|---|";
  for (const std::string& scene : measured.scenes) table += " " + scene + " |", rule += "---|";
  table += "\n" + rule + "\n";
  for (const app::Rung& rung : app::ladder()) {
    const auto found = std::ranges::find_if(list, [&](const Candidate& c) { return isOf(rung, c); });
    if (found == list.end()) continue;
    const auto c = static_cast<std::size_t>(found - list.begin());
    table += formatted("| %s | %.2f | %.2f | %.1e | %.1e |", rung.name, rung.cost, measured.cost[c], rung.error,
                       measured.error[c]);
    for (const double error : measured.errors[c]) table += formatted(" %.1e |", error);
    table += "\n";
  }
  return table + "\n";
}

}  // namespace

void measureLadder(int runs, const std::string& folder) {
  const std::vector<Candidate> list = candidates();
  const LadderErrors measured = measureCandidates(list, runs);
  printFront(list, measured);
  const std::string table = rungTable(list, measured), document = folder + "/performance.md";
  std::printf("\n%s", table.c_str());
  if (!std::filesystem::exists(document)) return;
  writeTable(folder, "ladder", tableOf(table));
  writeMeasuredPart(
      document, "ladder",
      columns(tableOf(table), {"rung", "cost, ladder's", "cost, measured", "error, ladder's", "error, measured"})
          .markdown());
}

}  // namespace bench
