#include "tests/bench/gate_motion.h"

#include <string>
#include <vector>

#include "app/scene/detail/governor.h"
#include "tests/bench/consistency.h"
#include "tests/bench/cpu_clock.h"
#include "tests/bench/measured_part.h"
#include "tests/bench/scene_times.h"
#include "tests/bench/timed_scene.h"

namespace bench {
namespace {

using app::Resolution;
using app::Style;

constexpr double kSameMoment = 1e-9;
constexpr int kFrames = 60;                  // a second
constexpr int kSettling = 5, kMeasured = 9;  // s
constexpr double kHeld = 1.1;                // of a budget, at most
constexpr double kMotionShare = 0.3;         // of the tips' way, that a coarser mesh may miss
constexpr double kStepShare = 0.5;           // of the error, that a quarter of the step may leave
constexpr double kWalkSpread = 0.02;         // of the hair's length: in a walk the tips hardly move against the head
constexpr double kBudgets[] = {0.3, 0.6, 1.2, 2.4};  // ms, of the low resolution
constexpr double kLargeBudgets[] = {6, 12};          // ms, of the high one

// A frame of the walk as the demo takes it, but by the processor's time, as of all the gate's figures: what else the
// machine does is no fault of the governor. Seconds.
double governedFrame(app::Governor& governor, double& owed, double& time, app::Actor& actor) {
  const sim::SimParams params = app::governed({}, governor);
  const double step = params.time_step;
  owed += kFrame;
  const int steps = static_cast<int>(owed / step + kSameMoment);
  owed -= steps * step;
  double cost = 0;
  for (int k = 0; k < steps; ++k) {
    app::moveActor(step, actor);
    const double started = cpuSeconds();
    app::simulateActor(params, step, time += step, actor);
    cost += cpuSeconds() - started;
  }
  app::observe({kFrame, steps * step, cost, 0}, governor);
  return cost;
}

void holdBudget(Resolution resolution, double budget, const std::function<void(const Figure&)>& add) {
  TimedScene scene("walk.bvh", Style::kLong, resolution, true);
  scene.actor().context->refreshGradually(true);  // as in the window
  scene.restart();
  app::Governor governor;
  app::setBudget(1e-3 * budget, governor);
  double owed = 0, time = 0;
  std::vector<double> seconds;
  for (int second = 0; second < kSettling + kMeasured; ++second) {
    double sum = 0;
    for (int frame = 0; frame < kFrames; ++frame) sum += governedFrame(governor, owed, time, scene.actor());
    if (second >= kSettling) seconds.push_back(1e3 * sum / kFrames);
  }
  const double held = medianOf(seconds);
  add({formatted("milliseconds a frame over a budget of %.1f: %s", budget, scene.name().c_str()), held / budget, kHeld,
       false, "",
       formatted("%.2f ms by %s%s", held, app::rungName(governor).c_str(),
                 governor.over_budget ? "; the coarsest setting takes longer" : "")});
}

}  // namespace

void addBudgetFigures(const std::function<void(const Figure&)>& add) {
  for (const double budget : kBudgets) holdBudget(Resolution::kLow, budget, add);
  for (const double budget : kLargeBudgets) holdBudget(Resolution::kHigh, budget, add);
}

void addConsistencyFigures(const std::function<void(const Figure&)>& add) {
  for (const Style style : {Style::kShoulder, Style::kLong}) {
    const ResolutionSpread spread = measureSpread(style, "head_shake.bvh", false, 1);
    const std::string name(app::styleName(style));
    for (const bool medium : {false, true}) {
      const double off = medium ? spread.medium : spread.low;
      add({formatted("tips of the %s resolution off the high one's, over their way: %s", medium ? "medium" : "low",
                     name.c_str()),
           off / spread.motion, kMotionShare, false, "",
           formatted("%.4f of a way of %.4f of the hair length", off, spread.motion)});
    }
    add({formatted("low resolution off the limit of small steps, 1/240 s over 1/60 s: %s", name.c_str()),
         spread.steps[3] / spread.steps[1], kStepShare, false, "",
         formatted("%.4f and %.4f of the hair length", spread.steps[3], spread.steps[1])});
    const ResolutionSpread walk = measureSpread(style, "walk.bvh", true, 1);
    add({formatted("tips of the low resolution off the high one's, in a walk with contacts: %s", name.c_str()),
         walk.low, kWalkSpread, false, "",
         formatted("of the hair length; the medium one's %.4f, of a way of %.4f", walk.medium, walk.motion)});
  }
}

}  // namespace bench
