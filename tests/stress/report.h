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

// What runs the case again, by itself. `sets`: parameters that were given by hand over the case's own.
std::string replayCommand(const std::string& name, std::uint64_t seed, const std::vector<std::string>& sets);

// A table with a row a case: its head and a row, with their line ends, and the results that such a file holds, of the
// cases declared. Throws InputError naming the line.
std::string csvHead();
std::string csvRow(const Result& result);
std::vector<Result> readCsv(const std::string& file, const std::vector<StressCase>& declared);

}  // namespace stress
