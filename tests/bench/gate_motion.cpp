#include "tests/bench/gate_motion.h"

#include <string>
#include <vector>

#include "app/data_path.h"
#include "app/demo.h"
#include "tests/bench/consistency.h"
#include "tests/bench/cpu_clock.h"
#include "tests/bench/measured_part.h"

namespace bench {
namespace {

using sim::Resolution;
using sim::Style;

constexpr int kFrames = 60;                          // a second
constexpr int kSettling = 5, kMeasured = 9;          // s
constexpr double kHeld = 1.1;                        // of a budget, at most
constexpr double kMotionShare = 0.3;                 // of the tips' way, that a coarser mesh may miss
constexpr double kBudgets[] = {0.3, 0.6, 1.2, 2.4};  // ms, of the low resolution
constexpr double kLargeBudgets[] = {6, 12};          // ms, of the high one

// ms a frame: the median of so many seconds' means, as the clock on the wall also counts what else the machine does.
void holdBudget(Resolution resolution, double budget, const std::function<void(const Figure&)>& add) {
  app::Scene scene = app::loadScene(app::dataPath("assets/scenes/walk.json"));
  scene.characters.resize(1);
  scene.characters[0].style = Style::kLong;
  scene.characters[0].resolution = resolution;
  scene.playback.budget_ms = budget;
  app::Demo demo = app::openScene(std::move(scene), 1);
  std::vector<double> seconds;
  for (int second = 0; second < kSettling + kMeasured; ++second) {
    double sum = 0;
    for (int frame = 0; frame < kFrames; ++frame) {
      app::advanceFrame(demo, 1.0 / kFrames, {});
      sum += demo.stats.simulation();
    }
    if (second >= kSettling) seconds.push_back(1e3 * sum / kFrames);
  }
  const double held = medianOf(seconds);
  add({formatted("milliseconds a frame over a budget of %.1f: long %s", budget,
                 std::string(sim::resolutionName(resolution)).c_str()),
       held / budget, kHeld, false, "",
       formatted("%.2f ms by %s%s", held, app::rungName(demo.governor).c_str(),
                 demo.governor.over_budget ? "; the coarsest setting takes longer" : "")});
}

}  // namespace

void addBudgetFigures(const std::function<void(const Figure&)>& add) {
  for (const double budget : kBudgets) holdBudget(Resolution::kLow, budget, add);
  for (const double budget : kLargeBudgets) holdBudget(Resolution::kHigh, budget, add);
}

void addConsistencyFigures(const std::function<void(const Figure&)>& add) {
  for (const Style style : {Style::kShoulder, Style::kLong}) {
    const ResolutionSpread spread = measureSpread(style, "head_shake.bvh", false, 1);
    const std::string name(sim::styleName(style));
    for (const bool medium : {false, true}) {
      const double off = medium ? spread.medium : spread.low;
      add({formatted("tips of the %s resolution off the high one's, over their way: %s", medium ? "medium" : "low",
                     name.c_str()),
           off / spread.motion, kMotionShare, false, "",
           formatted("%.4f of a way of %.4f of the hair length", off, spread.motion)});
    }
  }
}

}  // namespace bench
