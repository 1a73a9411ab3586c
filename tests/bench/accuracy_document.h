// The tables of docs/accuracy.md, from what the benchmark has measured.
#pragma once

#include <string>

namespace bench {

// Puts the tables of <folder>/pareto.json, solvers.json and peers.json into the measured parts of <folder>/accuracy.md.
// Throws InputError when a file or the marks of a measured part are missing.
void writeAccuracyDocument(const std::string& folder);

}  // namespace bench
