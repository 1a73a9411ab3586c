#include "tests/bench/timed_scene.h"

#include <algorithm>
#include <cmath>

#include "app/files/data_path.h"
#include "tests/bench/cpu_clock.h"
#include "tests/bench/scene_times.h"
#include "tests/oracle/plain_step.h"

namespace bench {
double TimedRun::median() const {
  std::vector<double> values;
  for (const TimedFrame& frame : frames) values.push_back(frame.simulation);
  return medianOf(std::move(values));
}

double TimedRun::total() const {
  double sum = 0;
  for (const TimedFrame& frame : frames) sum += frame.simulation;
  return sum;
}

TimedScene::TimedScene(std::string motion, app::Style style, app::Resolution resolution, bool collide)
    : name_(std::string(app::styleName(style)) + " " + std::string(app::resolutionName(resolution))),
      collide_(collide) {
  app::CharacterSpec spec;
  spec.motion = app::findFile(motion, "", "clips");
  spec.style = style;
  spec.resolution = resolution;
  actor_ = app::makeActor(spec, {}, asset_cache_);
  sim::SimParams params;
  params.collide = collide;
  app::settleActor(params, kSettle, actor_);
  start_ = actor_.hair;
  playback_ = actor_.playback;
  actor_.context = std::make_unique<sim::StepContext>(mesh(), cpuSeconds);
  plain_ = std::make_unique<oracle::PlainContext>(mesh(), cpuSeconds);
}

TimedScene::~TimedScene() = default;

void TimedScene::restart() {
  actor_.playback = playback_;
  app::placeActor(actor_, true);
  actor_.hair = start_;
}

TimedRun TimedScene::run(sim::SimParams params, double seconds, Method method) {
  params.collide = collide_;
  restart();
  const double dt = params.time_step;
  const int steps = static_cast<int>(std::lround(seconds / dt));
  const int steps_a_sample = std::max(1, static_cast<int>(std::lround(1 / (kSamplesPerSecond * dt))));
  TimedRun result;
  for (int step = 1; step <= steps; ++step) {
    const double started = cpuSeconds();
    app::moveActor(dt, actor_);
    const double moved = cpuSeconds();
    const sim::StepReport report =
        method == Method::kSimulator
            ? app::simulateActor(params, dt, step * dt, actor_)
            : oracle::plainAdvance(mesh(), params, {actor_.roots, actor_.ellipsoids, step * dt}, dt, *plain_,
                                   actor_.hair);
    const double done = cpuSeconds();
    result.frames.push_back({report.seconds, moved - started, done - moved, report.solver_iterations, report.contacts});
    result.recoveries += report.recoveries;
    if (step % steps_a_sample == 0) result.trajectory.push_back(actor_.hair.positions);
  }
  return result;
}

}  // namespace bench
