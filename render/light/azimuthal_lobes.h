// Azimuthal scattering of a hair fibre: R, TT and TRT with absorption inside.
#pragma once

#include <array>
#include <numbers>
#include <vector>

#include "render/frame_input.h"
#include "shaders/shared.h"

namespace render {

constexpr float kPi = std::numbers::pi_v<float>;
constexpr int kLobes = 3;  // R, TT, TRT and all beyond

struct AzimuthalLobes {
  // N_p: [lobe][cos theta_d][phi], kScatterTheta cosines over [0, 1], kScatterPhi angles over [0, pi]. Integrated over
  // phi in (-pi, pi) by the trapezoid rule and summed over lobes: the fibre's albedo, 1 without absorption.
  std::vector<Float3> scattered;
  // Each lobe's share of the albedo of a fibre without absorption; the shares of a row add up to 1.
  std::array<std::array<float, shared::kScatterTheta>, kLobes> share{};

  const Float3& at(int lobe, int row, int phi) const {
    return scattered[static_cast<std::size_t>((lobe * shared::kScatterTheta + row) * shared::kScatterPhi + phi)];
  }
};

// Weight of angle `phi` in the trapezoid rule over (-pi, pi).
float azimuthWeight(int phi);

// absorption: per fibre radius. The look's specular multiplies R and TRT; TT has what they leave.
AzimuthalLobes tabulateAzimuth(const HairLook& look, const Float3& absorption);

}  // namespace render
