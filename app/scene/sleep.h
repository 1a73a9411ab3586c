// Sleep of an actor's hair: all of it, or those connected parts of it that hang still.
#pragma once

#include "app/scene/actor.h"

namespace app {

// How many of the hair's parts may be left out of the coming step, and of how many; keeps account of it in the actor.
struct Sleepers {
  int asleep = 0, parts = 1;
  bool all() const { return asleep == parts; }
};
Sleepers sleepersOf(const sim::SimParams& params, double step, double time, Actor& actor);

// Steps the parts that are awake.
sim::StepReport advanceAwakeParts(const sim::SimParams& params, sim::StepInput input, double step, Actor& actor);

}  // namespace app
