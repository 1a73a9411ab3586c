// What a step of an actor's hair collides with: ellipsoids of the body or signed distances of its skin, and what it
// wears.
#pragma once

#include "app/scene/actor.h"

namespace app {

// What the hair sees in a step (s) that has brought the figure from its previous pose to its present one. Spans point
// into the actor, whose pins and colliders are posed.
sim::StepInput stepInput(const sim::SimParams& params, double step, double time, Actor& actor);

}  // namespace app
