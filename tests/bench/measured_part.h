// Documents whose measured parts the benchmark writes, and the prose around them people.
#pragma once

#include <string>

namespace bench {

// Replaces what stands between `<!-- measured: <name> -->` and `<!-- end of <name> -->` in a Markdown file. Throws
// InputError where these marks are missing.
void writeMeasuredPart(const std::string& file, const std::string& name, const std::string& part);

// printf into a string of at most 511 characters.
__attribute__((format(printf, 1, 2))) std::string formatted(const char* format, ...);

}  // namespace bench
