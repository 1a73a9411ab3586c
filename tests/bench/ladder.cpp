#include "tests/bench/ladder.h"

#include <time.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "app/data_path.h"
#include "tests/bench/trajectory.h"

namespace bench {
namespace {

using sim::Integrator;
using sim::SimParams;

constexpr double kSample = 0.2, kSeconds = 2, kSettle = 2;  // s; every step length below divides a sample
constexpr double kReferenceRate = 1920;                     // 1/s

double cpuSeconds() {
  timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

struct Candidate {
  Integrator integrator;
  double rate, tolerance;
  int max_iterations = 400;
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

struct Run {
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
    actor_ = app::makeActor(spec, {}, wardrobe_);
    SimParams params;
    params.collide = collide_;
    app::settleActor(params, kSettle, actor_);
    start_ = actor_.hair;
    playback_ = actor_.playback;
  }
  double hairLength() const { return actor_.haircut->mesh.hair_length; }

  Run run(SimParams params, double rate) {
    params.collide = collide_;
    params.time_step = 1 / rate;
    actor_.playback = playback_;
    app::placeActor(actor_, true);
    actor_.hair = start_;
    Run result;
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
  app::Wardrobe wardrobe_;
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
    Run run = stage.run(paramsOf(candidate), candidate.rate);
    least = std::min(least, run.seconds);
    trajectory = std::move(run.trajectory);
  }
  return least;
}

}  // namespace

void measureLadder(int runs) {
  const std::vector<Candidate> list = candidates();
  std::vector<double> cost(list.size(), 0), error(list.size(), 0);  // sums of logarithms
  int scenes = 0;
  for (const TrajectoryScene& scene : trajectoryScenes()) {
    const std::string name = scene.name;
    if (name != "head_shake" && name != "walk_contact" && name != "walk_shoulder" && name != "jump_1x") continue;
    ++scenes;
    Stage stage(scene);
    SimParams reference;
    reference.integrator = Integrator::kBdf2;
    reference.precision = sim::Precision::kDouble;
    reference.tolerance = 1e-9;
    reference.acceleration_tolerance = 0;
    const Trajectory truth = stage.run(reference, kReferenceRate).trajectory;
    Trajectory trajectory;
    const double standard = fastest(stage, {Integrator::kLinearizedEuler, 60, SimParams{}.tolerance}, runs, trajectory);
    for (std::size_t c = 0; c < list.size(); ++c) {
      const double seconds = fastest(stage, list[c], runs, trajectory);
      const TrajectoryError strayed = difference(trajectory, truth, stage.hairLength(), static_cast<int>(truth.size()));
      cost[c] += std::log(seconds / standard);
      error[c] += std::log(std::max(strayed.rms, 1e-9));
      std::printf("%-14s %-16s 1/%-4.0f %.0e %4d  cost %6.3f  rms %.2e  most %.2e\n", scene.name,
                  sim::paramText(*sim::findParam("integrator"), paramsOf(list[c])).c_str(), list[c].rate,
                  list[c].tolerance, list[c].max_iterations, seconds / standard, strayed.rms, strayed.most);
    }
  }
  std::printf("\nthe rows that no other beats in both:\n");
  for (std::size_t c = 0; c < list.size(); ++c) {
    cost[c] = std::exp(cost[c] / scenes);
    error[c] = std::exp(error[c] / scenes);
  }
  std::vector<std::size_t> order(list.size());
  for (std::size_t c = 0; c < order.size(); ++c) order[c] = c;
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return cost[a] < cost[b]; });
  double best = 1e9;
  for (const std::size_t c : order) {
    if (error[c] >= best) continue;
    best = error[c];
    std::printf("%-16s 1/%-4.0f tolerance %.0e, %d iterations: cost %.3f, error %.2e\n",
                sim::paramText(*sim::findParam("integrator"), paramsOf(list[c])).c_str(), list[c].rate,
                list[c].tolerance, list[c].max_iterations, cost[c], error[c]);
  }
}

}  // namespace bench
