// A hair fibre's scattering on the CPU, from the tables that the shaders read: its value, and directions drawn from it.
#pragma once

#include <Eigen/Core>
#include <array>
#include <random>
#include <vector>

#include "render/frame_input.h"
#include "render/light/azimuthal_lobes.h"

namespace reference {

using Eigen::Vector3f;
using Random = std::mt19937;

inline float unit(Random& random) {
  return static_cast<float>(random() >> 8) * (1.0f / 16777216.0f);
}

class Fiber {
 public:
  explicit Fiber(const render::HairLook& look);

  // Radiance towards the eye per irradiance of a light, RGB. Directions are unit.
  Vector3f scattered(const Vector3f& tangent, const Vector3f& to_eye, const Vector3f& to_light) const;

  // Where the light that goes to the eye comes from: a direction in proportion to what a fibre without absorption
  // scatters, and the share of it that this one leaves.
  struct Sample {
    Vector3f to_light, share;
  };
  Sample drawLight(const Vector3f& tangent, const Vector3f& to_eye, Random& random) const;

 private:
  static constexpr int kBins = 181, kExits = render::kLobes * kBins;
  std::array<float, 4> texel(int slice, float row, float column) const;
  // S cos^2 of one lobe without absorption, without its azimuth.
  float inclined(int lobe, float light, float eye) const;

  std::vector<float> table_;  // see fiber_scattering.h
  std::array<float, render::kLobes> deviation_, shift_;
  render::AzimuthalLobes azimuth_, clear_;
  std::vector<float> inclinations_;  // [eye's bin][lobe][light's bin], running sums
  std::vector<float> azimuths_;      // [lobe][row][phi], running sums
};

}  // namespace reference
