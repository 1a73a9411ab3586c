// Run time against error, over the configurations that a scene can be simulated with.
#pragma once

#include <string>
#include <vector>

namespace bench {

struct ParetoOptions {
  std::vector<std::string> scenes;  // empty: all
  std::string folder;               // CSV, JSON and plots go here
  std::string references;           // reference trajectories are kept here; empty: computed each time
  int runs = 3;                     // timed runs a point, after one that is not
  bool quick = false;               // a coarser sweep
};

// Writes <folder>/pareto.csv, pareto.json and, where gnuplot is installed, accuracy_<scene>.svg and .png. Prints the
// front of each scene, the paper's setting and where the default stands.
void runPareto(const ParetoOptions& options);

}  // namespace bench
