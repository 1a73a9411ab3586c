// Sleep of an actor's hair.
#pragma once

#include "app/scene/actor.h"

namespace app {

// Poses the pins of the coming step and tells whether that step may be left out; keeps account of it in the actor.
bool maySleep(const sim::SimParams& params, double step, double time, Actor& actor);

}  // namespace app
