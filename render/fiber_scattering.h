// Azimuthal scattering of a hair fibre, tabulated for the shaders: R, TT and TRT with absorption inside.
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
  // N_p, RGBA floats: [lobe][cos theta_d][phi], kScatterPhi angles over [0, pi], kScatterTheta cosines over [0, 1].
  // Integrated over phi in (-pi, pi) and summed over lobes: the fibre's albedo, 1 without absorption.
  std::vector<float> table;
  Float3 forward_albedo{}, backward_albedo{};  // a_f, a_b (Zinke et al. 2008), mean over inclinations
  Float3 local_back{};                         // A_b: multiple backscattering among neighbours
};

FiberScattering tabulateScattering(const HairLook& look);

}  // namespace render
