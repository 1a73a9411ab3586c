// A finer mesh of the same haircut: twice the sheets and twice the layers.
#pragma once

#include "app/styles/style_weave.h"

namespace app {

// Lays a sheet half-way between any two neighbouring ones and a layer between any two. `coarse` is as weave() makes it:
// columns numbered along their sheet, so that an edge within a sheet joins consecutive columns and every root face has
// edges across sheets but on its one or two sides within a sheet. New roots stand on the scalp. Columns within a sheet
// stay as they are: they are as near to each other as the simulator's systems stand.
sim::HairMeshShape refined(const Woven& coarse, const Scalp& scalp);

}  // namespace app
