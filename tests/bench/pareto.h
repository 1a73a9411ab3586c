// Run time against error, over the ways that a scene can be simulated.
#pragma once

#include <string>
#include <vector>

namespace bench {

struct ParetoOptions {
  std::vector<std::string> scenes;  // empty: all
  std::string folder;               // CSV, JSON and plots go here
  int runs = 3;                     // timed runs a point, after one that is not
  bool quick = false;               // a coarser sweep
};

// Writes <folder>/pareto.csv, pareto.json and, where gnuplot is installed, accuracy_<scene>.svg and .png. Prints the
// front of each scene and where the default stands. Errors are measured against a reference trajectory: BDF2 in double
// precision at 1/3840 s, linear solves to 1e-11, Newton to 1e-9 m/s, whose own error is estimated by the same at 1/1920
// s and reported beside them.
void runPareto(const ParetoOptions& options);

// Puts the tables of <folder>/pareto.json into the measured part of <folder>/accuracy.md.
void writeAccuracyDocument(const std::string& folder);

}  // namespace bench
