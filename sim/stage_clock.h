// Seconds per stage of a step. sim has no clock of its own: the caller gives one, or none.
#pragma once

#include "sim/step.h"

namespace sim {

struct StageClock {
  double (*clock)() = nullptr;
  double started = 0;

  void start() { started = clock ? clock() : 0; }
  // Books the time since the last start or spent on `stage`.
  void spent(Stage stage, StepReport& report) {
    if (!clock) return;
    const double now = clock();
    report.seconds[stage] += now - started;
    started = now;
  }
};

}  // namespace sim
