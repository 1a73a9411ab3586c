// What makes a person wait: start-up, and a slider being dragged.
#pragma once

#include <string>

#include "tests/bench/timed_scene.h"

namespace bench {

// Seconds of this thread's processor time from nothing to the end of the first step.
struct StartUp {
  double parse = 0, build = 0;  // hair mesh from the text of its file; topology and rest quantities
  double factor = 0;            // step context and first step: force model, rest shape, factor
  double character = 0;         // motion file, mannequin, its distances, the built-in style and mesh
};
StartUp measureStartUp(app::Style style, app::Resolution resolution);

// Seconds of a frame's simulation while a parameter changes every frame and, on the same frames, while none does.
struct DragTimes {
  double worst = 0, median = 0, still_worst = 0, still_median = 0;
  bool converged = true;  // all solves
};
DragTimes measureDrag(TimedScene& scene, const std::string& parameter);

}  // namespace bench
