// The deadline of a frame's simulation: what a frame may cost at most, whatever happens in it.
//
// The governor (governor.h) chooses settings that hold the usual frame to a budget. The deadline bounds each frame by
// counted work: steps that do not fit are left out (motion slows down), and a step that runs long ends its solve and
// its corrections early (sim::StepInput::max_work). Hair stays outside of the body either way.
#pragma once

#include "sim/mesh/fields.h"

namespace app {

struct Deadline {
  double seconds = 0;              // of a frame's simulation; 0: off
  bool counted = false;            // a unit is worth what it was when measured: runs that must repeat
  double seconds_per_unit = 4e-8;  // of this machine (sim::workUnits), learned
  double usual = 0;                // units of a step of all hairs, of late; 0: not known
  double left = 0;                 // units of the present frame
  HAIRMESH_FIELDS(seconds, counted, seconds_per_unit, usual, left)
};

// Starts a frame. Returns the steps that it can afford of those that it wants, at least one of them.
int affordableSteps(int wanted, Deadline& deadline);

// Units that a hair's next step may take: its share, by vertices, of what is left for all that the frame has yet to
// step. Infinite when the deadline is off.
double workOfStep(int vertices, long vertices_to_come, const Deadline& deadline);

// Takes in what the steps of a frame did.
void observeWork(int steps, double units, double seconds, Deadline& deadline);

}  // namespace app
