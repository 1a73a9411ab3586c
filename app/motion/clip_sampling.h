// Local transforms of a clip between its frames.
#pragma once

#include "app/figure/character.h"

namespace app {

// Two neighbouring frames and how far between them: 0 is exactly the first.
struct ClipMoment {
  int first = 0, second = 0;
  double fraction = 0;
};

// Times outside the clip are clamped to its ends; within 1e-9 of a frame's own time it is that frame exactly.
ClipMoment clipMoment(const Clip& clip, double time);

// Joint to parent.
Rigid sampleLocal(const Clip& clip, const ClipMoment& moment, int joint);

}  // namespace app
