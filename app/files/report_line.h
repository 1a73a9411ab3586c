#pragma once
#include <cstdio>
#include <string>

namespace app {

// A line of a report as printf writes it, with its end; at most 399 characters.
template <class... Values>
std::string reportLine(const char* format, Values... values) {
  char text[400];
  std::snprintf(text, sizeof text, format, values...);
  return std::string(text) + "\n";
}

// "1 frame", "2 frames".
inline std::string countOf(auto number, const char* what) {
  return std::to_string(number) + " " + what + (number == 1 ? "" : "s");
}

}  // namespace app
