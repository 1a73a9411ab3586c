// Longitudinal scattering of a hair fibre, normalised so that a fibre without absorption under even light from
// everywhere is as bright as that light, at every roughness and inclination.
//
// M_p(theta_i, theta_r) = k a_p(theta_i) a_p(theta_r) c(theta_r), and S = sum M_p N_p: no division by cos^2 theta_d.
// k = exp(-2 sin^2(theta_h + shift cos theta_d) / v) / (cos theta_i cos theta_r + kGrazing v), v = 4 deviation^2: the
// shape of the energy-conserving lobe of d'Eon et al. 2011, with its Bessel function and norm in a_p: the integral of
// k a_p a_p cos^2 theta over either inclination is 1 without a shift, so M_p is reciprocal. c mends what the shift and
// Fresnel's change over the lobe's width leave, for the eye's side.
#pragma once

#include <array>

#include "render/light/azimuthal_lobes.h"

namespace render {

struct LongitudinalLobes {
  // At kScatterPhi inclinations over [-pi/2, pi/2].
  std::array<std::array<float, 4>, shared::kScatterPhi> norm{};  // a of R, TT, TRT, and of light of several fibres
  std::array<float, shared::kScatterPhi> eye{};                  // c
};

// k of a lobe. half_angle: theta_h with the shift.
float longitudinalShape(float half_angle, float cos_product, float deviation);

// Shifts of R, TT, TRT over the half angle, rad.
std::array<float, kLobes> lobeShifts(float cuticle_angle);

// deviations: of R, TT, TRT over the half angle, rad.
LongitudinalLobes tabulateInclinations(const std::array<float, kLobes>& deviations, float cuticle_angle,
                                       const AzimuthalLobes& azimuth);

}  // namespace render
