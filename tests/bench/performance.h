// docs/performance.md: where the time of a frame goes, by stage, for the default, the paper's setting and the plain
// implementation; growth with the mesh; start-up; the gate's figures.
#pragma once

#include <string>

#include "tests/bench/gate.h"

namespace bench {

// Measures and puts the tables into the measured part of <folder>/performance.md, and the chart of growth beside it
// (growth.svg and .png, where gnuplot is installed). Throws app::InputError.
void writePerformanceDocument(const std::string& folder, const GateOptions& gate);

}  // namespace bench
