#include "tests/bench/measured_part.h"

#include <cstdarg>
#include <cstdio>
#include <fstream>
#include <iterator>

#include "app/files/errors.h"

namespace bench {

void writeMeasuredPart(const std::string& file, const std::string& name, const std::string& part) {
  std::ifstream stream(file);
  std::string text((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
  const std::string opening = "<!-- measured: " + name + " -->", closing = "<!-- end of " + name + " -->";
  const auto start = text.find(opening), end = text.find(closing);
  if (start == std::string::npos || end == std::string::npos || end < start) {
    throw app::InputError(file, "", "lacks the marks of its part '" + name + "'", "restore it from the repository");
  }
  text = text.substr(0, start) + opening + "\n\n" + part + text.substr(end);
  std::ofstream(file) << text;
}

std::string formatted(const char* format, ...) {
  char text[512];
  va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(text, sizeof text, format, arguments);
  va_end(arguments);
  return text;
}

}  // namespace bench
