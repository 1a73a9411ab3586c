// What a person should know of a scene before its first frame: what was inferred, limited or begins elsewhere.
#pragma once

#include <string>
#include <vector>

#include "app/options.h"
#include "app/scene/demo.h"

namespace app {

// A line each, for the terminal.
std::vector<std::string> openingNotes(const Options& options, const Demo& demo);

}  // namespace app
