// The --report file: what every frame cost and did, and what was inferred about the characters, as JSON.
#pragma once

#include <string>
#include <vector>

#include "app/scene/demo.h"

namespace app {

// What a run of frames leaves to be written.
struct RunReport {
  std::string renderer;      // of the context; empty without one
  double start_seconds = 0;  // load and settle
  double fps = 0;
  std::vector<FrameStats> frames;
  long first = 0;  // number of the first: a loaded state has some behind it
};

// Parameters of which a character's hair uses another value than is set: which, why, and of what; a line each.
std::vector<std::string> limitNotes(const Demo& demo);

// Throws OutputError.
void writeReport(const std::string& file, const RunReport& run, const Demo& demo);

// One line a stage, and how budgets and a deadline were kept, for the terminal.
std::string summary(const RunReport& run, const Demo& demo);

}  // namespace app
