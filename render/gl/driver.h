// What the driver at hand is good at.
#pragma once

#include "render/frame_input.h"

namespace render {

// Whether the context's driver rasterizes on the CPU. By its name; needs a current context.
bool rasterizesInSoftware();

// The path that kAuto stands for, with the context's driver; any other as it is.
StrandPath pathFor(StrandPath asked);

}  // namespace render
