#include "render/light/fiber_scattering.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "render/light/azimuthal_lobes.h"
#include "render/light/hair_volume.h"
#include "render/light/longitudinal_lobes.h"

namespace render {
namespace {

using shared::kScatterPhi;
using shared::kScatterTheta;
using shared::kVolumeSteps;

std::size_t texelAt(int slice, int row, int column) {
  return 4 * static_cast<std::size_t>((slice * kScatterTheta + row) * kScatterPhi + column);
}

void write(const Float3& rgb, float* texel) {
  std::copy(rgb.begin(), rgb.end(), texel);
}

// Even light from everywhere meets a fibre at inclination theta in proportion to cos^2 theta.
void meanAlbedo(const AzimuthalLobes& azimuth, FiberScattering& result) {
  float weight_sum = 0;
  for (int row = 0; row < kScatterTheta; ++row) {
    const float cos_d = static_cast<float>(row) / (kScatterTheta - 1), weight = cos_d * cos_d;
    weight_sum += weight;
    for (int lobe = 0; lobe < kLobes; ++lobe) {
      for (int j = 0; j < kScatterPhi; ++j) {
        Float3& side = 2 * j >= kScatterPhi ? result.forward_albedo : result.backward_albedo;
        for (int c = 0; c < 3; ++c) side[c] += weight * azimuthWeight(j) * azimuth.at(lobe, row, j)[c];
      }
    }
  }
  for (int c = 0; c < 3; ++c) {
    result.forward_albedo[c] /= weight_sum;
    result.backward_albedo[c] /= weight_sum;
  }
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
  const AzimuthalLobes azimuth = tabulateAzimuth(look, absorptionOf(look));
  const LongitudinalLobes inclinations = tabulateInclinations(lobeWidths(look.beta_m), look.cuticle_angle, azimuth);
  const std::vector<VolumeLight> volume = tabulateVolume(azimuth);
  FiberScattering result;
  result.table.assign(texelAt(shared::kScatterSlices, 0, 0), 0.0f);
  for (int lobe = 0; lobe < kLobes; ++lobe) {
    for (int row = 0; row < kScatterTheta; ++row) {
      for (int j = 0; j < kScatterPhi; ++j) write(azimuth.at(lobe, row, j), &result.table[texelAt(lobe, row, j)]);
    }
  }
  for (int i = 0; i < kScatterPhi; ++i) {
    std::copy(inclinations.norm[i].begin(), inclinations.norm[i].end(), &result.table[texelAt(kLobes, 0, i)]);
    result.table[texelAt(kLobes, kScatterTheta - 1, i)] = inclinations.eye[i];
  }
  static_assert(kVolumeSteps <= kScatterTheta && 3 * kVolumeSteps <= kScatterPhi);
  for (int behind = 0; behind < kVolumeSteps; ++behind) {
    for (int front = 0; front < kVolumeSteps; ++front) {
      const VolumeLight& light = volume[static_cast<std::size_t>(behind * kVolumeSteps + front)];
      for (int power = 0; power < 3; ++power)
        write(light.power[power], &result.table[texelAt(kLobes + 1, behind, power * kVolumeSteps + front)]);
    }
  }
  meanAlbedo(azimuth, result);
  return result;
}

}  // namespace render
