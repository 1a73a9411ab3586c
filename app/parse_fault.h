// What the three programs say of a command line that cannot be read.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace app {

// One line with the fault and the mend: of an unknown option the one that was meant, of a file too many `one_file`.
std::string parseFault(const CLI::ParseError& error, const CLI::App& parser, const std::string& one_file);

// Throws UsageError where the file's name ends in none of `endings`, the formats that the option writes. An empty name
// is none that was given.
void expectEnding(const std::string& option, const std::string& file, const std::vector<std::string>& endings);

// A number of that range. CLI::Range lets NaN through, because NaN is neither below nor above.
CLI::Validator within(double low, double high);

// "1 to 1000000", "0.5 to 2".
std::string rangeText(double low, double high);

}  // namespace app
