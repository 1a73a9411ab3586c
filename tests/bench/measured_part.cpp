#include "tests/bench/measured_part.h"

#include <cstdarg>
#include <cstdio>
#include <fstream>
#include <iterator>

#include "app/files/errors.h"
#include "app/files/output_file.h"

namespace bench {

namespace {

// The document in front of a part, that part's opening mark included, and from its closing mark on.
struct AroundPart {
  std::string before, after;
};

AroundPart aroundPart(const std::string& file, const std::string& name) {
  std::ifstream stream(file);
  if (!stream)
    throw app::InputError(file, "", "is not there or cannot be read", "name the folder that holds this page");
  const std::string text((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
  const std::string opening = "<!-- measured: " + name + " -->", closing = "<!-- end of " + name + " -->";
  const auto start = text.find(opening), end = text.find(closing);
  if (start == std::string::npos || end == std::string::npos || end < start) {
    throw app::InputError(file, "", "lacks the marks of its part '" + name + "'", "restore it from the repository");
  }
  return {text.substr(0, start) + opening, text.substr(end)};
}

}  // namespace

void writeMeasuredPart(const std::string& file, const std::string& name, const std::string& part) {
  const AroundPart around = aroundPart(file, name);
  app::writeFile(file, around.before + "\n\n" + part + around.after);
}

void checkMeasuredParts(const std::string& file, const std::vector<std::string>& names) {
  for (const std::string& name : names) aroundPart(file, name);
  app::checkWritable(file);
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
