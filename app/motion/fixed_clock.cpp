#include "app/motion/fixed_clock.h"

#include <algorithm>
#include <cmath>

namespace app {

namespace {
// A step that rounding alone would ask for is not taken: sixty sixtieths make sixty steps.
constexpr double kSlack = 1e-6;
// Longer frames (a debugger, a laptop's lid) are not caught up with at all.
constexpr double kLongestWait = 10;

void countSteps(int steps, double step, FixedClock& clock) {
  if (steps <= 0) return;
  clock.steps += steps;
  clock.time += steps * step;
  clock.step = step;
}
}  // namespace

int tick(double seconds, double step, int most, FixedClock& clock) {
  if (!(seconds > 0)) return 0;
  if (seconds > kLongestWait) {
    clock.lost += std::isfinite(seconds) ? seconds - kLongestWait : 0;
    seconds = kLongestWait;
  }
  clock.ahead -= seconds;
  if (clock.ahead >= -kSlack * step) return 0;
  const int needed = static_cast<int>(std::ceil(-clock.ahead / step - kSlack));
  const int taken = std::min(needed, most);
  clock.ahead += needed * step;
  clock.lost += (needed - taken) * step;
  countSteps(taken, step, clock);
  return taken;
}

void stepSingly(int steps, double step, FixedClock& clock) {
  countSteps(steps, step, clock);
  if (steps > 0) clock.ahead = 0;
}

double shownFraction(const FixedClock& clock, double step) {
  const double fraction = 1 - clock.ahead / (clock.step > 0 ? clock.step : step);
  return fraction > 1 - kSlack ? 1 : std::max(0.0, fraction);
}

}  // namespace app
