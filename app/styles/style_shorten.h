// Columns of a hair mesh made shorter, each by its own share, that leaves no prism flat.
#pragma once

#include <vector>

#include "app/styles/hair_styles.h"

namespace app {

// Cuts each column to a share (above 0; 1: as it is) of its length, along its own curve. Neighbours of very unequal
// length have flat prisms between them: shares are raised until none of a root face is below half of another, or where
// that is not enough below more; then prisms are untangled (style_untangle.h) to `fatness`. Where no such
// cut leaves prisms, as on heads that leave no room, a part of it is made, or none. On return `shares` is what columns
// were cut to. Deterministic; takes tenths of a second.
void shortenColumns(const BodyDistance& body, double fatness, std::vector<double>& shares, sim::HairMeshShape& shape);

}  // namespace app
