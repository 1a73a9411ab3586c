// A run without a window: frames to PNG files through EGL, or without any pictures at all.
#pragma once

#include "app/files/scene_file.h"
#include "app/options.h"

namespace app {

// Frame k shows the moment k / fps exactly. Returns the exit code. Throws InputError, OutputError and ContextError.
int runHeadless(Scene scene, const Options& options);

}  // namespace app
