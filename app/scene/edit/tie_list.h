// The list of a character's hair ties, as a hand changes it: a ring more, one ring elsewhere.
#pragma once

#include <string>
#include <vector>

#include "app/files/tie_spec.h"

namespace app {

// For lists: "back", "left" or where it is in centimetres.
std::string placeText(const TieSpec& tie);

// The rings put beside those that there are: one, or one on each side of the head. They share hair with the nearest of
// these: by sides where the two lie side by side, else the higher one takes what is rooted above the middle between
// them. Places are those of a head.
std::vector<TieSpec> withRings(std::vector<TieSpec> ties, const std::vector<TieSpec>& rings, const Scalp& scalp);

}  // namespace app
