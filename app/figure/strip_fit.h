// Strips, cards and tubes of a file, made into a hair mesh for the head at hand.
#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "app/figure/character.h"
#include "app/groom/strips/strip_convert.h"

namespace app {

inline constexpr double kAtScalp = 0.02;  // m: on the scalp

struct FittedStrips {
  StripConversion conversion;
  std::string fit;                                      // what fitHair says of their place; empty: they fit as they are
  double as_made_distance = 0;                          // m, fitHair's
  Eigen::Affine3d place = Eigen::Affine3d::Identity();  // from the strips' metres and axes to the head's
};

// Strips of which the end that is no root is on the scalp, as `place` brings it there, and the root is not.
std::vector<int> rootedAway(const std::vector<FollowedStrip>& strips, const Character& character,
                            const Eigen::Affine3d& place);

// As convertStrips, with the hair mesh brought to the head as fitHair does, where `mend` says so. Strips without a
// scalp are rooted at their highest ends, and their file does not say which axis is up: where `up_given` is false and
// they lie away from the head it is y or z, whichever brings the roots nearer to the scalp. Where these ends lie away
// from the head, and the lowest ends lie much nearer to it and no further apart, as of hair that stands, those are the
// roots. Of single strips that are then rooted away from the head the other end is the root, unless options say which.
// Throws InputError.
FittedStrips fitStrips(const PolygonMesh& mesh, const StripOptions& options, bool up_given, const std::string& file,
                       const Character& character, bool mend);

// Whether the roots lie so far from the figure's scalp that the hair is for no head that is known.
bool farFromHead(const sim::HairMeshShape& shape, const Character& character);

}  // namespace app
