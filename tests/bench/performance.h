// docs/performance.md: where the time of a frame goes, by stage, for the default, the paper's setting and the plain
// implementation; growth with the mesh; start-up.
#pragma once

#include <string>

namespace bench {

// Measures and puts the tables into the measured parts of <folder>/performance.md, all of them into
// <folder>/data/stages.csv, and draws <folder>/data/growth.svg and .png where gnuplot is installed. Throws
// app::InputError.
void writePerformanceDocument(const std::string& folder);

}  // namespace bench
