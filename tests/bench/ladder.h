// The rungs of the budget governor, measured: what each costs against the default, and how far it strays.
#pragma once

#include <string>

namespace bench {

// Prints, for every candidate setting, the geometric means over the calm scenes of the sweep (trajectory.h) of its cost
// against the default's and of its error over hair length, then the rows of app/scene/detail/governor_ladder.cpp: those
// that no other candidate beats in both, and a table of the rungs. A performance.md in `folder` gets the table too.
void measureLadder(int runs, const std::string& folder);

}  // namespace bench
