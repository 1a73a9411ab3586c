// A character's head as the inspector of grooms holds hair against it.
#pragma once

#include "app/figure/character.h"
#include "app/groom/inspect/groom_inspect.h"

namespace app {

// In the scalp's frame. Lives without the character.
HeadModel headModelOf(const Character& character);

}  // namespace app
