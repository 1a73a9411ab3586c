// docs/stability.md: its measured parts.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tests/stress/report.h"

namespace stress {

// Puts the measured parts into <folder>/stability.md; the prose around them is a person's. Full tables and heat maps
// (SVG and PNG, where gnuplot is installed) go into <folder>/data. `how`: the option that chose the cases, as the page
// quotes it. Throws app::InputError where a part's marks are missing and app::OutputError where a file cannot be
// written.
void writeDocument(const std::vector<Result>& results, const std::string& how, std::uint64_t seed,
                   const std::string& folder);

// Throws what writeDocument would, before the cases are run. Leaves nothing.
void checkDocument(const std::string& folder);

}  // namespace stress
