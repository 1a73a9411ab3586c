// Every bound that the simulator's speed and accuracy are held to, measured in one run.
#pragma once

#include <string>
#include <vector>

namespace bench {

struct GateOptions {
  int rounds = 5;          // of the interleaved comparisons, after one that is not counted
  std::string references;  // reference trajectories are kept here; empty: computed each time, which takes minutes
  std::string part;        // speed, consistency, sweep or drawing; empty: all
};

// A figure and its bound.
struct Figure {
  std::string name;
  double value = 0, bound = 0;
  bool at_least = false;  // the value must not be below the bound; otherwise not above
  std::string unit, note;
  bool holds() const { return at_least ? value >= bound : value <= bound; }  // NaN falls short
};

// Prints one line a figure (name, value, bound, ok or short) as it is measured. Times are of
// this thread's processor time; ratios compare runs that took turns. Throws app::InputError.
std::vector<Figure> measureFigures(const GateOptions& options);

// Puts the figures into the measured part of <folder>/gate.md and, with their notes, into <folder>/data/gate.csv.
// in_part: rows of figures that were not measured this time stay. Throws app::InputError.
void writeGateDocument(const std::vector<Figure>& figures, bool in_part, const std::string& folder);

// Whether all hold; prints how many do.
bool allHold(const std::vector<Figure>& figures);

// What hairmesh-bench ends with: 1 where a figure falls short.
int exitCodeOf(bool all_hold);

}  // namespace bench
