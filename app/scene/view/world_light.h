// Lights stand about the figure: a scene gives them for one that faces +z.
#pragma once

#include "app/scene/actor.h"
#include "render/frame_input.h"

namespace app {

// The lights turned about y to the way the figure faces as its clip begins, in quarter turns: those of a figure that
// faces +z are what they were to the bit. Where a scene turns it (heading) they stay in the scene.
render::LightInput lightAbout(const Actor& actor, render::LightInput light);

}  // namespace app
