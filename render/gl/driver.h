// The driver at hand: its functions, its name, and what it is good at.
#pragma once

#include <string>

#include "render/frame_input.h"

namespace render {

// Loads OpenGL functions through GLEW; accepts GLEW_ERROR_NO_GLX_DISPLAY, which GLX builds answer under EGL although
// all is loaded. Returns an error message, empty when fine. Needs a current context.
std::string initGl();

// "vendor / renderer / version" of the current context.
std::string rendererName();

// Whether the context's driver rasterizes on the CPU. By its name; needs a current context.
bool rasterizesInSoftware();

// The path that kAuto stands for, with the context's driver; any other as it is.
StrandPath pathFor(StrandPath asked);

}  // namespace render
