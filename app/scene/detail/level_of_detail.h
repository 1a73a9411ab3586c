// How much care the simulation takes of each actor: by its size in the picture, and whether it can be in the picture.
#pragma once

#include "app/scene/demo.h"

namespace app {

// Pixels that the hair and head of an actor span at most, at the demo's camera.
double projectedSize(const Demo& demo, const Actor& actor);

// Whether the actor's figure or its shadow can be in the picture within the next moments.
bool mayBeSeen(const Demo& demo, const Actor& actor);

// Chooses detail for all actors. Thresholds differ on the way in and out, so that nothing switches to and fro.
void chooseDetail(Demo& demo);

// Lets the hair of a new actor come to rest for `seconds` before the first frame, at its detail.
void settleInDetail(double seconds, Demo& demo, Actor& actor);

// One step of the clock for one actor, at its detail, with what can be left out left out. Accounts in demo.stats.
void stepInDetail(double time, Demo& demo, Actor& actor);

// Whether the last frame showed what the one before it did and the next one will too, unless somebody does something:
// the window may then wait for events.
bool nothingMoves(const Demo& demo);

}  // namespace app
