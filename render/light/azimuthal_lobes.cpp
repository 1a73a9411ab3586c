// Legend: h offset across the fibre (-1..1), gamma_i, gamma_t incident and refracted angles in the cross-section,
// theta_d difference angle, eta refractive index, sigma_a absorption, F Fresnel reflectance, T transmittance of one
// crossing, A_p attenuation of lobe p (0 R, 1 TT, 2 TRT and all beyond), Phi_p its exit azimuth. Sources: Marschner et
// al. 2003; d'Eon et al. 2011; Chiang et al. 2016 (logistic azimuthal roughness).
#include "render/light/azimuthal_lobes.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace render {
namespace {

using shared::kScatterPhi;
using shared::kScatterTheta;
constexpr int kOffsets = 100;

float fresnel(float cos_i, float eta) {
  const float sin2_t = (1 - cos_i * cos_i) / (eta * eta);
  const float cos_t = std::sqrt(std::max(1 - sin2_t, 0.0f));
  const float parallel = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
  const float perpendicular = (cos_i - eta * cos_t) / (cos_i + eta * cos_t);
  return 0.5f * (parallel * parallel + perpendicular * perpendicular);
}

// Logistic distribution on (-pi, pi), normalised there.
struct TrimmedLogistic {
  float scale, norm;
  explicit TrimmedLogistic(float s) : scale(1 / s), norm(1 / (s * std::tanh(kPi / (2 * s)))) {}
  float operator()(float x) const {
    const float e = std::exp(-std::abs(x) * scale);
    return norm * e / ((1 + e) * (1 + e));
  }
};

struct Crossing {
  float gamma_i, gamma_t;
  std::array<Float3, kLobes> attenuation;
  std::array<float, kLobes> lossless;
};

Crossing crossFiber(float h, float cos_d, float eta, const Float3& sigma_a) {
  const float sin2_d = 1 - cos_d * cos_d;
  const float bent_eta = std::sqrt(eta * eta - sin2_d) / std::max(cos_d, 1e-3f);
  const float cos_theta_t = std::sqrt(1 - sin2_d / (eta * eta));
  Crossing crossing;
  crossing.gamma_i = std::asin(h);
  crossing.gamma_t = std::asin(h / bent_eta);
  const float f = fresnel(cos_d * std::cos(crossing.gamma_i), eta);
  crossing.lossless = {f, (1 - f) * (1 - f), (1 - f) * f};
  for (int c = 0; c < 3; ++c) {
    const float t = std::exp(-sigma_a[c] * 2 * std::cos(crossing.gamma_t) / cos_theta_t);
    crossing.attenuation[0][c] = f;
    crossing.attenuation[1][c] = (1 - f) * (1 - f) * t;
    // The geometric tail beyond TRT leaves in about the same directions after blurring, so TRT carries it too.
    crossing.attenuation[2][c] = crossing.attenuation[1][c] * t * f / (1 - t * f);
  }
  return crossing;
}

// One row of one lobe: N_p with and without absorption over phi.
struct Row {
  std::array<Float3, kScatterPhi> scattered{};
  std::array<float, kScatterPhi> lossless{};

  float albedo() const {
    float sum = 0;
    for (int j = 0; j < kScatterPhi; ++j) sum += azimuthWeight(j) * lossless[j];
    return sum;
  }
};

void fillRows(float cos_d, float eta, const Float3& sigma_a, const TrimmedLogistic& blur,
              std::array<Row, kLobes>& rows) {
  for (int i = 0; i < kOffsets; ++i) {
    const float h = -1 + 2 * (i + 0.5f) / kOffsets;
    const Crossing crossing = crossFiber(h, cos_d, eta, sigma_a);
    for (int lobe = 0; lobe < kLobes; ++lobe) {
      const float exit = 2 * lobe * crossing.gamma_t - 2 * crossing.gamma_i + lobe * kPi;
      for (int j = 0; j < kScatterPhi; ++j) {
        const float n = blur(std::remainder(kPi * j / (kScatterPhi - 1) - exit, 2 * kPi)) / kOffsets;
        for (int c = 0; c < 3; ++c) rows[lobe].scattered[j][c] += crossing.attenuation[lobe][c] * n;
        rows[lobe].lossless[j] += crossing.lossless[lobe] * n;
      }
    }
  }
}

}  // namespace

float azimuthWeight(int phi) {
  return 2 * kPi / (kScatterPhi - 1) * (phi == 0 || phi == kScatterPhi - 1 ? 0.5f : 1.0f);
}

AzimuthalLobes tabulateAzimuth(const HairLook& look, const Float3& absorption) {
  const float eta = std::clamp(look.eta, 1.05f, 3.0f), b = std::clamp(look.beta_n, 0.05f, 1.0f);
  const TrimmedLogistic blur(std::sqrt(kPi / 8) * (0.265f * b + 1.194f * b * b + 5.372f * std::pow(b, 22.0f)));
  AzimuthalLobes lobes;
  lobes.scattered.resize(static_cast<std::size_t>(kLobes * kScatterTheta * kScatterPhi));
  for (int row = 0; row < kScatterTheta; ++row) {
    const float cos_d = std::max(static_cast<float>(row) / (kScatterTheta - 1), 0.02f);
    std::array<Row, kLobes> rows{};
    fillRows(cos_d, eta, absorption, blur, rows);
    const float albedo = rows[0].albedo() + rows[1].albedo() + rows[2].albedo();
    // What reflection gains, the light that passes through loses.
    const float shine = (rows[0].albedo() + rows[2].albedo()) / albedo;
    const float specular = std::min(std::max(look.specular, 0.0f), 1 / std::max(shine, 1e-6f));
    const std::array<float, kLobes> gain{specular, (1 - specular * shine) / std::max(1 - shine, 1e-6f), specular};
    for (int lobe = 0; lobe < kLobes; ++lobe) {
      lobes.share[lobe][row] = gain[lobe] * rows[lobe].albedo() / albedo;
      for (int j = 0; j < kScatterPhi; ++j) {
        Float3& n = lobes.scattered[static_cast<std::size_t>((lobe * kScatterTheta + row) * kScatterPhi + j)];
        for (int c = 0; c < 3; ++c) n[c] = gain[lobe] / albedo * rows[lobe].scattered[j][c];
      }
    }
  }
  return lobes;
}

}  // namespace render
