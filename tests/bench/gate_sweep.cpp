#include "tests/bench/gate_sweep.h"

#include <algorithm>
#include <cstdio>

#include "tests/bench/sweep.h"

namespace bench {
namespace {

constexpr double kBehindFront = 1.1;    // times faster that no other way may be
constexpr double kSmallestShare = 0.1;  // of the smallest error reported

}  // namespace

void addSweepFigures(const GateOptions& options, const std::function<void(const Figure&)>& add) {
  for (const TrajectoryScene& scene : trajectoryScenes()) {
    TrajectoryStage stage(scene);
    const Reference reference = referenceOf(stage, kReferenceRate, options.references);
    const std::vector<sim::SimParams> configurations = configurationsToRun(SweepSize::kShort, scene.collide);
    const Sweep sweep = sweepScene(stage, reference, configurations, std::min(3, options.rounds));
    Lag lag = lagOfDefault(sweep);
    if (lag.ratio > kBehindFront) {
      lag.ratio = confirmedRatio(stage, sweep.points.front().params, lag.configuration->params, options.rounds);
    }
    const std::string name = scene.name;
    add({"fastest way with no more of any error over the default: " + name, lag.ratio, kBehindFront, false, "",
         lag.configuration->is_default ? "the default itself" : lag.configuration->name()});
    double smallest = sweep.points.front().error.rms;
    for (const Point& point : sweep.points) smallest = std::min(smallest, point.error.rms);
    char note[100];
    std::snprintf(note, sizeof note, "%.1e of %.1e, over %.2f s", sweep.own_error, smallest, sweep.compared_seconds);
    add({"reference's own error over the smallest reported: " + name, sweep.own_error / smallest, kSmallestShare, false,
         "", note});
  }
}

}  // namespace bench
