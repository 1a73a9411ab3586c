// What every function of include/hairmesh.h begins and ends with: no exception crosses the boundary.
#pragma once

#include <new>
#include <string>
#include <utility>

#include "include/hairmesh.h"

namespace app::library {

// Thrown inside a call; becomes its result and its message.
struct Fault {
  hm_result result;
  std::string text;  // "FAULT; MEND"
};

// Notes the message of a call that failed, for hm_error_message and the log. Takes no memory.
hm_result fail(hm_result result, const char* function, const char* text) noexcept;

// The result of the exception at hand.
hm_result failWithCurrentException(const char* function) noexcept;

// Runs the body of the API's function `function`.
template <class Body>
hm_result guarded(const char* function, Body&& body) noexcept {
  try {
    std::forward<Body>(body)();
    return HM_OK;
  } catch (...) {
    return failWithCurrentException(function);
  }
}

// Throws where a pointer that a call cannot do without is NULL.
inline void needs(const void* pointer, const char* name) {
  if (!pointer) throw Fault{HM_ERROR_ARGUMENT, std::string(name) + " is NULL; give its address"};
}

}  // namespace app::library
