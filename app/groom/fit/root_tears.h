// Where hair on the scalp's map goes apart, and the regions between.
#pragma once

#include "app/groom/fit/root_raster.h"

namespace app {

// Sets regions and splits of the raster from its cells' paths.
void tearApart(RootRaster& raster);

}  // namespace app
