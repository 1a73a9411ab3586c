// Where hair on the scalp's map goes apart, and the regions between.
#pragma once

#include "app/groom/fit/root_raster.h"

namespace app {

// Sets regions and splits of the raster from its cells' paths: where neighbouring strands go apart by more than `tears`
// (rad) over at least 20 mm of scalp, as at a parting, the map is torn, and each tear goes on to the rim where the
// strands differ most. Regions lie between.
void tearApart(double tears, RootRaster& raster);

}  // namespace app
