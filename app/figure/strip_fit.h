// Strips, cards and tubes of a file, made into a hair mesh for the head at hand.
#pragma once

#include <Eigen/Geometry>
#include <string>

#include "app/figure/character.h"
#include "app/groom/strips/strip_convert.h"

namespace app {

struct FittedStrips {
  StripConversion conversion;
  std::string fit;                                      // what fitHair says of their place; empty: they fit as they are
  double as_made_distance = 0;                          // m, fitHair's
  Eigen::Affine3d place = Eigen::Affine3d::Identity();  // from the strips' metres and axes to the head's
};

// As convertStrips, with the hair mesh brought to the head as fitHair does, where `mend` says so. Strips without a
// scalp are rooted at their highest ends, and their file does not say which axis is up: where `up_given` is false and
// they lie away from the head it is y or z, whichever brings the roots nearer to the scalp. Where these ends lie away
// from the head, and the lowest ends lie much nearer to it and no further apart, as of hair that stands, those are the
// roots. Throws InputError.
FittedStrips fitStrips(const PolygonMesh& mesh, const StripOptions& options, bool up_given, const std::string& file,
                       const Character& character, bool mend);

// Whether the roots lie so far from the figure's scalp that the hair is for no head that is known.
bool farFromHead(const sim::HairMeshShape& shape, const Character& character);

}  // namespace app
