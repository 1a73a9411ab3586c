// Text files, read whole.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace app {

// Some editors put a byte order mark before UTF-8.
inline std::string_view withoutByteOrderMark(std::string_view text) {
  return text.substr(text.starts_with("\xEF\xBB\xBF") ? 3 : 0);
}

// Reads a whole file. Throws InputError when it is missing, empty, a directory, a device or over `limit_bytes`.
std::string readText(const std::string& file, std::size_t limit_bytes = std::size_t{256} << 20);

}  // namespace app
