// The fixed-step clock: how many simulation steps a frame takes, whatever the frame rate.
#pragma once

namespace app {

// The simulation runs ahead of the picture by less than one step, and the picture shows the moment in between the last
// two states. So a frame shows exactly its own time, and the states do not depend on the frame rate at all.
struct FixedClock {
  double ahead = 0;  // s from the shown moment to the last state, 0 <= ahead < step
  double lost = 0;   // s of time given up so far because frames took more steps than allowed
  long steps = 0;    // taken so far
  double time = 0;   // s that these make: the moment of the last state
  double step = 0;   // s, the length of the last step
};

// Advances the shown moment by `seconds` and returns the steps of length `step` (s) to take now, at most `most`. Time
// beyond those is given up in whole steps: motion slows down, the frame does not spiral. Negative or non-finite seconds
// count as 0.
int tick(double seconds, double step, int most, FixedClock& clock);

// Steps taken one by one while the picture stands still: they end at the shown moment.
void stepSingly(int steps, double step, FixedClock& clock);

// Where the shown moment lies between the last state but one (0) and the last state (1). `step`: for a clock that has
// not taken any; the length of the last step counts where there is one, so that it may change without a jump.
double shownFraction(const FixedClock& clock, double step);

}  // namespace app
