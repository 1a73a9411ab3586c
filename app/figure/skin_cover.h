// Collision ellipsoids that cover the skin that hair can reach.
#pragma once

#include <string>

#include "app/figure/character.h"

namespace app {

struct CoverReport {
  double before = 0, after = 0;      // m, how far skin within reach sticks out of the ellipsoids together, at worst
  double over_before = 0, over = 0;  // m, how far the ellipsoids stick out of that skin in the rest pose: the mean
  int added = 0;
  std::string where;  // the joint that carries the worst skin
  std::string unfit;  // the joints whose skin no ellipsoids fit, with commas; what they carry is left out of the rest
};

// Adds ellipsoids until no skin below the chin that hair can reach sticks out of all of them by more than about 2 mm,
// at rest and at moments of every clip, or `enough` have been added; then smaller ones too, until none sticks out by
// more than 3 mm, or there are twice as many. Each stands for one patch of skin. One that swallows skin above the chin,
// for hair is rooted there and lies there, or air in front of any skin, where hair may hang, is made smaller or left
// out. What is there already stays, and is marked (BodyEllipsoid::by_distances) where the skin of its joint, the head's
// included, still sticks out by far: boxes. Deterministic.
CoverReport coverSkin(Character& character, int enough = 40);

}  // namespace app
