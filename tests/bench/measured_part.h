// Documents whose measured parts the benchmark writes, and the prose around them people.
#pragma once

#include <string>
#include <vector>

namespace bench {

// Replaces what stands between `<!-- measured: <name> -->` and `<!-- end of <name> -->` in a Markdown file. Throws
// InputError where the file or these marks are missing and OutputError where it cannot be written.
void writeMeasuredPart(const std::string& file, const std::string& name, const std::string& part);

// Throws what writeMeasuredPart would, before a long measurement. Writes nothing.
void checkMeasuredParts(const std::string& file, const std::vector<std::string>& names);

// printf into a string of at most 511 characters.
__attribute__((format(printf, 1, 2))) std::string formatted(const char* format, ...);

}  // namespace bench
