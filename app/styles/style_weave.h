// From a coat of hair to a hair mesh: chooses the columns, joins them with root faces and cuts them into layers.
#pragma once

#include <vector>

#include "app/styles/style_comb.h"

namespace app {

// How finely a style is meshed. Everything is counted, not measured, so that a style has the same topology on every
// head.
struct Weave {
  std::vector<double> backness;  // of the sheets of one half, 0 (temple) to 1 (nape), the nape's sheet shared
  int front_ranks = 3,
      back_ranks = 5;  // columns a sheet has from the hairline to the parting, at the temple and at the nape
  int inner_layers = 4, outer_layers = 6;  // layers of the columns at the hairline and of those at the parting
  double grading = 0;                      // 0: layers are evenly spaced; towards 1: closer over the head than below it
  double creep = 0.004;                    // m a layer: how columns go on whose layer lies along the scalp
};

Weave weaveOf(Style style, Resolution resolution);

struct Woven {
  sim::HairMeshShape shape;
  std::vector<Vec3> up;  // unit, per vertex: off the coat's underside
};

Woven weave(const Coat& coat, const Weave& plan);

}  // namespace app
