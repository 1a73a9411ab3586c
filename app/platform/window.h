// The window: GLFW, OpenGL 4.5 core, mouse and keys, the panels' backends.
#pragma once

#include "app/files/scene_file.h"
#include "app/options.h"

namespace app {

// Runs until it is closed, or for options.frames frames when they were given: then every frame is 1 / fps long whatever
// the clock says, so that two runs show the same. Returns the exit code. Throws InputError and ContextError.
int runWindow(Scene scene, const Options& options);

}  // namespace app
