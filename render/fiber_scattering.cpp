// Legend: h offset across the fibre (-1..1), gamma_i, gamma_t incident and refracted angles in the cross-section,
// theta_d difference angle, eta refractive index, sigma_a absorption, F Fresnel reflectance, T transmittance of one
// crossing, A_p attenuation of lobe p (0 R, 1 TT, 2 TRT and all beyond), Phi_p its exit azimuth. Sources: Marschner et
// al. 2003; d'Eon et al. 2011; Chiang et al. 2016 (logistic azimuthal roughness).
#include "render/fiber_scattering.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "shaders/shared.h"

namespace render {
namespace {

using shared::kScatterPhi;
using shared::kScatterTheta;
constexpr float kPi = std::numbers::pi_v<float>;
constexpr int kOffsets = 100;

float fresnel(float cos_i, float eta) {
  const float sin2_t = (1 - cos_i * cos_i) / (eta * eta);
  const float cos_t = std::sqrt(std::max(1 - sin2_t, 0.0f));
  const float parallel = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
  const float perpendicular = (cos_i - eta * cos_t) / (cos_i + eta * cos_t);
  return 0.5f * (parallel * parallel + perpendicular * perpendicular);
}

// Logistic distribution on (-pi, pi), normalised there.
float trimmedLogistic(float x, float s) {
  const auto cdf = [s](float at) { return 1 / (1 + std::exp(-at / s)); };
  const float e = std::exp(-std::abs(x) / s);
  return e / (s * (1 + e) * (1 + e)) / (cdf(kPi) - cdf(-kPi));
}

float wrapAngle(float angle) {
  return std::remainder(angle, 2 * kPi);
}

struct Crossing {
  float gamma_i, gamma_t;
  std::array<Float3, 3> attenuation;
};

Crossing crossFiber(float h, float cos_d, float eta, const Float3& sigma_a) {
  const float sin2_d = 1 - cos_d * cos_d;
  const float bent_eta = std::sqrt(eta * eta - sin2_d) / std::max(cos_d, 1e-3f);
  const float cos_theta_t = std::sqrt(1 - sin2_d / (eta * eta));
  Crossing crossing;
  crossing.gamma_i = std::asin(h);
  crossing.gamma_t = std::asin(h / bent_eta);
  const float f = fresnel(cos_d * std::cos(crossing.gamma_i), eta);
  for (int c = 0; c < 3; ++c) {
    const float t = std::exp(-sigma_a[c] * 2 * std::cos(crossing.gamma_t) / cos_theta_t);
    crossing.attenuation[0][c] = f;
    crossing.attenuation[1][c] = (1 - f) * (1 - f) * t;
    // The geometric tail beyond TRT leaves in about the same directions after blurring, so TRT carries it too.
    crossing.attenuation[2][c] = crossing.attenuation[1][c] * t * f / (1 - t * f);
  }
  return crossing;
}

}  // namespace

Float3 absorptionOf(const HairLook& look) {
  Float3 sigma{};
  if (look.use_color) {
    const float b = look.beta_n;
    const float fit = 5.969f + b * (-0.215f + b * (2.532f + b * (-10.73f + b * (5.574f + b * 0.245f))));
    for (int c = 0; c < 3; ++c) {
      const float root = std::log(std::clamp(look.color[c], 1e-3f, 0.99f)) / fit;
      sigma[c] = root * root;
    }
    return sigma;
  }
  constexpr Float3 kEumelanin{0.419f, 0.697f, 1.37f}, kPheomelanin{0.187f, 0.4f, 1.05f};
  for (int c = 0; c < 3; ++c) {
    sigma[c] = std::max(look.eumelanin, 0.0f) * kEumelanin[c] + std::max(look.pheomelanin, 0.0f) * kPheomelanin[c];
  }
  return sigma;
}

Float3 rootColor(const HairLook& look) {
  Float3 color = absorptionOf(look);
  for (float& c : color) c = std::exp(-2 * (kPi / 2) * c);  // pi / 2: mean chord of a circle of radius 1
  return color;
}

Float3 lobeWidths(float beta_m) {
  const float b = std::clamp(beta_m, 0.05f, 1.0f);
  const float deviation = 0.5f * (0.726f * b + 0.812f * b * b + 3.7f * std::pow(b, 20.0f));
  return {deviation, 0.5f * deviation, 2 * deviation};
}

FiberScattering tabulateScattering(const HairLook& look) {
  const Float3 sigma_a = absorptionOf(look);
  const float eta = std::clamp(look.eta, 1.05f, 3.0f), b = std::clamp(look.beta_n, 0.05f, 1.0f);
  const float s = std::sqrt(kPi / 8) * (0.265f * b + 1.194f * b * b + 5.372f * std::pow(b, 22.0f));
  FiberScattering result;
  result.table.assign(static_cast<std::size_t>(3) * kScatterTheta * kScatterPhi * 4, 0.0f);
  float weight_sum = 0;
  for (int row = 0; row < kScatterTheta; ++row) {
    const float cos_d = std::max(static_cast<float>(row) / (kScatterTheta - 1), 0.02f);
    Float3 forward{}, backward{};
    for (int i = 0; i < kOffsets; ++i) {
      const float h = -1 + 2 * (i + 0.5f) / kOffsets;
      const Crossing crossing = crossFiber(h, cos_d, eta, sigma_a);
      for (int lobe = 0; lobe < 3; ++lobe) {
        const float exit = 2 * lobe * crossing.gamma_t - 2 * crossing.gamma_i + lobe * kPi;
        for (int j = 0; j < kScatterPhi; ++j) {
          const float phi = kPi * j / (kScatterPhi - 1);
          const float n = trimmedLogistic(wrapAngle(phi - exit), s) / kOffsets;
          float* texel = &result.table[((static_cast<std::size_t>(lobe) * kScatterTheta + row) * kScatterPhi + j) * 4];
          const float slice = 2 * kPi / (kScatterPhi - 1) * (j == 0 || j == kScatterPhi - 1 ? 0.5f : 1.0f);
          for (int c = 0; c < 3; ++c) {
            texel[c] += crossing.attenuation[lobe][c] * n;
            (phi > kPi / 2 ? forward : backward)[c] += crossing.attenuation[lobe][c] * n * slice;
          }
        }
      }
    }
    // Even light from everywhere meets a fibre at inclination theta in proportion to cos^2 theta.
    const float weight = cos_d * cos_d;
    weight_sum += weight;
    for (int c = 0; c < 3; ++c) {
      result.forward_albedo[c] += weight * forward[c];
      result.backward_albedo[c] += weight * backward[c];
    }
  }
  for (int c = 0; c < 3; ++c) {
    const float a_f = std::min(result.forward_albedo[c] /= weight_sum, 0.98f),
                a_b = result.backward_albedo[c] /= weight_sum;
    const float left = 1 - a_f * a_f;
    // Zinke et al. 2008, equations 12 to 14: one, and three, backward events among any number of forward ones.
    result.local_back[c] = a_b * a_f * a_f / left + a_b * a_b * a_b * a_f * a_f / (left * left * left);
    result.local_back[c] = std::min(result.local_back[c], 1.0f);
  }
  return result;
}

}  // namespace render
