// A run without a window: frames to PNG files through EGL, or without any pictures at all.
#pragma once

#include "app/options.h"
#include "app/scene_file.h"

namespace app {

// Frame k shows the moment k / fps exactly. Returns the exit code. Throws InputError and ContextError.
int runHeadless(Scene scene, const Options& options);

}  // namespace app
