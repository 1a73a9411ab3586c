// The log that the caller takes.
#pragma once

#include "include/hairmesh.h"

namespace app::library {

// Hands a line to the caller's function, if there is one.
void writeLog(hm_log_level level, const char* message) noexcept;

}  // namespace app::library
