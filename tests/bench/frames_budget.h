// What the steps of whole clips cost, seams of loops included, against the median step of a walk: the distribution, in
// counted work (sim/step_work.h), so that runs repeat.
#pragma once

#include <string>
#include <vector>

namespace bench {

struct FramesBudgetOptions {
  std::vector<std::string> styles;  // "long low"; empty: three styles, low to high
  std::vector<std::string> clips;   // file names; empty: the project's own, ../shared/mocap and ../shared/arcsim
  std::vector<double> speeds;       // of playback; empty: 1, 4, 10 and 20
  std::string folder;               // of the document whose table, chart and data are written; empty: none
  std::string steps;                // CSV of every step, for fits of the weights; empty: none
};

// The clips that are there. Throws app::InputError.
std::vector<std::string> framesBudgetClips();

// Two rounds of each clip, 4 s or more, at most 60 s of simulation, in steps of 1/60 s. Returns whether all keep the
// bounds on a step's cost over the walk's median: at 1x p99 3 and worst 8, faster 6 and 12. Throws app::InputError.
bool runFramesBudget(const FramesBudgetOptions& options);

}  // namespace bench
