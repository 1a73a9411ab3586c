#include "tests/reference/fiber.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "render/light/fiber_scattering.h"
#include "render/light/longitudinal_lobes.h"

namespace reference {
namespace {

using render::kLobes;
using render::shared::kScatterPhi;
using render::shared::kScatterTheta;
constexpr float kPi = std::numbers::pi_v<float>;

float binAngle(int bin, int bins) {
  return kPi * ((static_cast<float>(bin) + 0.5f) / static_cast<float>(bins) - 0.5f);
}

int drawFrom(const float* sums, int count, float u) {
  return std::min(static_cast<int>(std::upper_bound(sums, sums + count, u * sums[count - 1]) - sums), count - 1);
}

float inclinationColumn(float theta) {
  return (theta / kPi + 0.5f) * (kScatterPhi - 1);
}

}  // namespace

// Linear between texels, as the shaders' sampler is.
std::array<float, 4> Fiber::texel(int slice, float row, float column) const {
  const int r = std::clamp(static_cast<int>(row), 0, kScatterTheta - 2),
            c = std::clamp(static_cast<int>(column), 0, kScatterPhi - 2);
  const float fr = std::clamp(row - static_cast<float>(r), 0.0f, 1.0f),
              fc = std::clamp(column - static_cast<float>(c), 0.0f, 1.0f);
  std::array<float, 4> sum{};
  for (int corner = 0; corner < 4; ++corner) {
    const int dr = corner / 2, dc = corner % 2;
    const float weight = (dr != 0 ? fr : 1 - fr) * (dc != 0 ? fc : 1 - fc);
    const float* at = &table_[4 * static_cast<std::size_t>((slice * kScatterTheta + r + dr) * kScatterPhi + c + dc)];
    for (std::size_t k = 0; k < 4; ++k) sum[k] += weight * at[k];
  }
  return sum;
}

float Fiber::inclined(int lobe, float light, float eye) const {
  const auto index = static_cast<std::size_t>(lobe);
  const float cos_d = std::cos(0.5f * (eye - light)), cos_i = std::cos(light);
  const float row = cos_d * (kScatterTheta - 1);
  const int low = std::min(static_cast<int>(row), kScatterTheta - 2);
  const float into = row - static_cast<float>(low);
  const auto& share = clear_.share[index];
  const auto at = static_cast<std::size_t>(low);
  return texel(kLobes, 0, inclinationColumn(light))[index] * texel(kLobes, 0, inclinationColumn(eye))[index] *
         ((1 - into) * share[at] + into * share[at + 1]) * cos_i * cos_i *
         render::longitudinalShape(0.5f * (light + eye) + shift_[index] * cos_d, cos_i * std::cos(eye),
                                   deviation_[index]);
}

Fiber::Fiber(const render::HairLook& look)
    : table_(render::tabulateScattering(look).table),
      deviation_(render::lobeWidths(look.beta_m)),
      shift_(render::lobeShifts(look.cuticle_angle)),
      azimuth_(render::tabulateAzimuth(look, render::absorptionOf(look))),
      clear_(render::tabulateAzimuth(look, {0, 0, 0})) {
  inclinations_.resize(static_cast<std::size_t>(kBins * kExits));
  for (int eye = 0; eye < kBins; ++eye) {
    float sum = 0;
    for (int lobe = 0; lobe < kLobes; ++lobe) {
      for (int light = 0; light < kBins; ++light)
        inclinations_[static_cast<std::size_t>(eye * kExits + lobe * kBins + light)] = sum +=
            inclined(lobe, binAngle(light, kBins), binAngle(eye, kBins));
    }
  }
  azimuths_.resize(clear_.scattered.size());
  for (int row = 0; row < kLobes * kScatterTheta; ++row) {
    float sum = 0;
    for (int phi = 0; phi < kScatterPhi; ++phi)
      azimuths_[static_cast<std::size_t>(row * kScatterPhi + phi)] = sum +=
          render::azimuthWeight(phi) * clear_.at(row / kScatterTheta, row % kScatterTheta, phi)[0];
  }
}

// scatterLight of shaders/common/hair_shading.glsl without the light of several fibres.
Vector3f Fiber::scattered(const Vector3f& tangent, const Vector3f& to_eye, const Vector3f& to_light) const {
  const float sin_r = std::clamp(tangent.dot(to_eye), -1.0f, 1.0f),
              sin_i = std::clamp(tangent.dot(to_light), -1.0f, 1.0f);
  const float theta_r = std::asin(sin_r), theta_i = std::asin(sin_i);
  const Vector3f eye_across = to_eye - sin_r * tangent, light_across = to_light - sin_i * tangent;
  const float lengths = eye_across.norm() * light_across.norm();
  const float cos_phi = lengths > 1e-6f ? std::clamp(eye_across.dot(light_across) / lengths, -1.0f, 1.0f) : 1.0f;
  const float cos_i = std::cos(theta_i), cos_d = std::cos(0.5f * (theta_r - theta_i));
  const std::array<float, 4> norm_r = texel(kLobes, 0, inclinationColumn(theta_r)),
                             norm_i = texel(kLobes, 0, inclinationColumn(theta_i));
  const float eye = texel(kLobes, kScatterTheta - 1, inclinationColumn(theta_r))[0];
  Vector3f sum = Vector3f::Zero();
  for (int lobe = 0; lobe < kLobes; ++lobe) {
    const auto index = static_cast<std::size_t>(lobe);
    const float m = norm_r[index] * norm_i[index] * eye *
                    render::longitudinalShape(0.5f * (theta_i + theta_r) + shift_[index] * cos_d,
                                              cos_i * std::cos(theta_r), deviation_[index]);
    const std::array<float, 4> n =
        texel(lobe, cos_d * (kScatterTheta - 1), std::acos(cos_phi) / kPi * (kScatterPhi - 1));
    sum += m * Vector3f(n[0], n[1], n[2]);
  }
  return cos_i * sum;
}

Fiber::Sample Fiber::drawLight(const Vector3f& tangent, const Vector3f& to_eye, Random& random) const {
  const float sin_r = std::clamp(tangent.dot(to_eye), -1.0f, 1.0f), theta_r = std::asin(sin_r);
  const int eye = std::clamp(static_cast<int>((theta_r / kPi + 0.5f) * kBins), 0, kBins - 1);
  const int drawn = drawFrom(&inclinations_[static_cast<std::size_t>(eye * kExits)], kExits, unit(random));
  const int lobe = drawn / kBins;
  const float theta_i = binAngle(drawn % kBins, kBins) + kPi / kBins * (unit(random) - 0.5f);
  const float cos_d = std::cos(0.5f * (theta_r - theta_i));
  const int row = std::clamp(static_cast<int>(cos_d * (kScatterTheta - 1) + unit(random)), 0, kScatterTheta - 1);
  const auto sums = static_cast<std::size_t>((lobe * kScatterTheta + row) * kScatterPhi);
  const int node = drawFrom(&azimuths_[sums], kScatterPhi, unit(random));
  const render::Float3 &kept = azimuth_.at(lobe, row, node), &all = clear_.at(lobe, row, node);
  const float step = kPi / (kScatterPhi - 1);
  const float phi =
      (unit(random) < 0.5f ? 1.0f : -1.0f) * (step * static_cast<float>(node) + step * (unit(random) - 0.5f));
  Vector3f across = to_eye - sin_r * tangent;
  across = across.norm() > 1e-5f ? across.normalized().eval() : tangent.unitOrthogonal();
  const Vector3f round = tangent.cross(across);
  Sample sample;
  sample.to_light =
      (std::sin(theta_i) * tangent + std::cos(theta_i) * (std::cos(phi) * across + std::sin(phi) * round)).normalized();
  for (int c = 0; c < 3; ++c)
    sample.share[c] = kept[static_cast<std::size_t>(c)] / std::max(all[static_cast<std::size_t>(c)], 1e-20f);
  return sample;
}

}  // namespace reference
