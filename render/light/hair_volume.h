// Light that several fibres have scattered, inside of a slab of parallel fibres lit from its front.
#pragma once

#include <array>
#include <vector>

#include "render/light/azimuthal_lobes.h"

namespace render {

// What a fibre sends on of it, per irradiance of the light on its own: a quadratic in the cosine of the azimuth between
// light and eye, whose coefficients are RGB.
struct VolumeLight {
  std::array<Float3, 3> power{};
};

// Share of the light on its way from one fibre to the next that leaves a lock at its sides: a slab is endless, a lock and
// a head are not. Fitted to traced hair of three styles from three sides, blond and white: docs/log/light.md.
inline constexpr double kSideLoss = 0.07;

// [behind][front], kVolumeSteps each: optical depth behind the fibre and in front of it; see shared.h.
// Radiative transfer in the plane across the fibres, by discrete ordinates (Chandrasekhar 1950; Stamnes et al. 1988):
// exact but for the number of directions, since a ray's extinction across parallel cylinders does not depend on its
// inclination. Scattering is that of normal incidence. Light with a depth of zero on both sides is zero: a lone fibre
// sends on what the lights give it and no more.
std::vector<VolumeLight> tabulateVolume(const AzimuthalLobes& azimuth);

}  // namespace render
