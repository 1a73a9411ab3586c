#pragma once

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <string>

namespace app {

// Of a file's name, with its dot, in small letters; "" where it has none.
inline std::string endingOf(const std::string& file) {
  std::string ending = std::filesystem::path(file).extension().string();
  std::ranges::transform(ending, ending.begin(), [](unsigned char c) { return std::tolower(c); });
  return ending;
}

}  // namespace app
