// What the cases came to, as files.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tests/stress/run_case.h"

namespace stress {

struct Result {
  StressCase one;
  Outcome outcome;
};

// A row a case. Throws InputError when the file cannot be written.
void writeCsv(const std::vector<Result>& results, const std::string& file);

// stability.md with its tables, and its heat maps (SVG and PNG) where gnuplot is installed.
void writeDocument(const std::vector<Result>& results, std::uint64_t seed, const std::string& folder);

}  // namespace stress
