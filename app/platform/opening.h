// The demo that a command line asks for, and what a person should know of it before its first frame.
#pragma once

#include <string>
#include <vector>

#include "app/options.h"
#include "app/scene/demo.h"

namespace app {

// Opens the scene, or the project with these settings, for pictures of `aspect`. What a replay has to do again is a
// request: opening the project of a recorded run, and the turntable. Without a window a project that was saved paused
// plays. `beside`: large figures may load beside the first frames. Throws InputError.
Demo openAsked(Scene scene, const Options& options, double aspect, bool beside);

// What was inferred, limited or begins elsewhere: a line each, for the terminal.
std::vector<std::string> openingNotes(const Options& options, const Demo& demo);

}  // namespace app
