// Scattering of a look's fibres, tabulated for the shaders: single scattering (azimuthal_lobes.h, longitudinal_lobes.h)
// and what fibres send on to each other (hair_volume.h).
#pragma once

#include <array>
#include <vector>

#include "render/frame_input.h"

namespace render {

// Absorption coefficient per fibre radius, RGB.
// Melanin: d'Eon et al. 2011 (coefficients as in pbrt). Picked colour: the fit of Chiang et al. 2016 from
// multiple-scattering colour, for azimuthal roughness beta_n.
Float3 absorptionOf(const HairLook& look);

// What two crossings of a root leave of light, RGB: skin between roots is seen through them by light that met them on
// its way in and on its way out.
Float3 rootColor(const HairLook& look);

// Longitudinal standard deviations of R, TT, TRT over the half angle theta_h, rad (Marschner et al. 2003's ratios 1,
// 1/2, 2; the width from beta_m by Chiang et al. 2016).
Float3 lobeWidths(float beta_m);

struct FiberScattering {
  // RGBA floats: kScatterSlices slices of kScatterTheta rows of kScatterPhi texels; see shaders/shared.h.
  std::vector<float> table;
  Float3 forward_albedo{}, backward_albedo{};  // share sent on with and against the light, mean over inclinations
};

FiberScattering tabulateScattering(const HairLook& look);

}  // namespace render
