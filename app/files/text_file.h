// Text files, read whole.
#pragma once

#include <cstddef>
#include <string>

namespace app {

// Reads a whole file. Throws InputError when it is missing, empty, a directory, a device or over `limit_bytes`.
std::string readText(const std::string& file, std::size_t limit_bytes = std::size_t{256} << 20);

}  // namespace app
