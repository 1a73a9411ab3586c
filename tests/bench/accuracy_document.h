// The tables of docs/accuracy.md, from what the benchmark has measured.
#pragma once

#include <string>

namespace bench {

// Puts the tables of <folder>/data/pareto.json, solvers.json and peers.json, as far as they are there, into the
// measured parts of <folder>/accuracy.md. Throws InputError when none is, or when the marks of a measured part are
// missing.
void writeAccuracyDocument(const std::string& folder);

}  // namespace bench
