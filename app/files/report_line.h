#pragma once
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>

namespace app {

// A line of a report as printf writes it, with its end; at most 399 characters.
template <class... Values>
std::string reportLine(const char* format, Values... values) {
  char text[400];
  std::snprintf(text, sizeof text, format, values...);
  return std::string(text) + "\n";
}

// Three digits: "0.0123", "12.3", "2180".
inline std::string threeDigits(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.2e", value);
  const double rounded = std::strtod(text, nullptr);
  std::snprintf(text, sizeof text, std::abs(rounded) < 1000 ? "%.3g" : "%.0f", rounded);
  return text;
}

// "1 frame", "2 frames".
inline std::string countOf(auto number, const char* what) {
  return std::to_string(number) + " " + what + (number == 1 ? "" : "s");
}

}  // namespace app
