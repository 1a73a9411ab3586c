// What reloading shaders is asked and answers.
#pragma once

#include <string>

namespace render {

// Which programs a reload compiles: those of files that changed since they were last read, or all.
enum class Reload { kChanged, kAll };

struct ReloadReport {
  int programs = 0;   // compiled anew and in use
  std::string fault;  // "FILE:LINE: the driver's words" of the first program that failed; empty when none did
  ReloadReport& operator+=(const ReloadReport& other);
};

}  // namespace render
