// Hands that a capture lost for a while.
#pragma once

#include <string>

#include "app/figure/character.h"

namespace app {

// Which hand or forearm keeps its turn to the bit for at least half a second while the arm above it turns, though it
// moves in most of the clip's other frames, and when (s); the longest stretch of each. Nothing is mended, for what the
// hand did meanwhile is not known. A joint that never moves was not captured, which is no fault. Empty: none is frozen.
std::string frozenHands(const Skeleton& skeleton, const Clip& clip);

}  // namespace app
