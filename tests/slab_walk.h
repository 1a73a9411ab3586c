// Light through a slab of parallel fibres by a random walk with the renderer's lobes: what the shaders' closed solution
// is held to. Light falls in straight on, across the fibres.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

#include "render/light/azimuthal_lobes.h"
#include "render/light/fiber_scattering.h"
#include "render/light/hair_volume.h"
#include "render/light/longitudinal_lobes.h"

namespace slab_walk {

struct Result {
  render::Float3 back{}, through{};  // shares of the light
};

class Walk {
 public:
  explicit Walk(const render::HairLook& look)
      : azimuth_(render::tabulateAzimuth(look, render::absorptionOf(look))),
        clear_(render::tabulateAzimuth(look, {0, 0, 0})) {
    fillInclinations(look);
    fillAzimuths();
  }

  Result through(double thickness, int photons, unsigned seed) const {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> unit(0, 1);
    Result result;
    for (int n = 0; n < photons; ++n) {
      int inclination = kBins / 2;
      double psi = 0, depth = 0;  // psi: azimuth of flight, 0 into the slab
      bool scattered = false;
      render::Float3 weight{1, 1, 1};
      while (std::max({weight[0], weight[1], weight[2]}) > 1e-4f) {
        depth -= std::log(1 - unit(random)) * std::cos(psi);
        if (depth < 0 || depth > thickness) {
          for (int c = 0; c < 3; ++c) (depth < 0 ? result.back : result.through)[c] += weight[c] / photons;
          break;
        }
        // Between two fibres some of it leaves the lock at its sides.
        if (std::exchange(scattered, true))
          for (float& share : weight) share *= static_cast<float>(1 - render::kSideLoss);
        const int drawn = draw(&exits_[static_cast<std::size_t>(inclination * kExits)], kExits, unit(random));
        const int lobe = drawn / kBins, out = drawn % kBins;
        const double cos_d = std::cos(0.5 * (angle(out) - angle(inclination)));
        const int row = static_cast<int>(std::lround(cos_d * (render::shared::kScatterTheta - 1)));
        const int phi = draw(&turns_[turnsAt(lobe, row)], kPhi, unit(random));
        const render::Float3 &kept = azimuth_.at(lobe, row, phi), &all = clear_.at(lobe, row, phi);
        for (int c = 0; c < 3; ++c) weight[c] *= kept[c] / std::max(all[c], 1e-20f);
        const double turn = std::numbers::pi * phi / (kPhi - 1);
        psi += std::numbers::pi + (unit(random) < 0.5 ? turn : -turn);
        inclination = kBins - 1 - out;
      }
    }
    return result;
  }

 private:
  static constexpr int kBins = 121, kExits = render::kLobes * kBins, kPhi = render::shared::kScatterPhi;

  static double angle(int bin) { return std::numbers::pi * ((bin + 0.5) / kBins - 0.5); }
  static std::size_t turnsAt(int lobe, int row) {
    return static_cast<std::size_t>((lobe * render::shared::kScatterTheta + row) * kPhi);
  }
  static int draw(const float* sums, int count, double u) {
    const float wanted = static_cast<float>(u) * sums[count - 1];
    return std::min(static_cast<int>(std::upper_bound(sums, sums + count, wanted) - sums), count - 1);
  }

  // Running sums over lobe and exit inclination, for each inclination of the light.
  void fillInclinations(const render::HairLook& look) {
    const render::Float3 widths = render::lobeWidths(look.beta_m);
    const auto shifts = render::lobeShifts(look.cuticle_angle);
    const render::LongitudinalLobes lobes = render::tabulateInclinations(widths, look.cuticle_angle, clear_);
    const auto at = [](double theta) {
      return static_cast<std::size_t>(std::lround((theta / std::numbers::pi + 0.5) * (kPhi - 1)));
    };
    exits_.resize(static_cast<std::size_t>(kBins * kExits));
    for (int in = 0; in < kBins; ++in) {
      float sum = 0;
      for (int lobe = 0; lobe < render::kLobes; ++lobe) {
        for (int out = 0; out < kBins; ++out) {
          const double i = angle(in), r = angle(out), cos_d = std::cos(0.5 * (r - i));
          const auto row = static_cast<std::size_t>(std::lround(cos_d * (render::shared::kScatterTheta - 1)));
          const auto shape = render::longitudinalShape(static_cast<float>(0.5 * (i + r) + shifts[lobe] * cos_d),
                                                       static_cast<float>(std::cos(i) * std::cos(r)), widths[lobe]);
          sum += lobes.norm[at(i)][lobe] * lobes.norm[at(r)][lobe] * lobes.eye[at(r)] * shape *
                 clear_.share[lobe][row] * static_cast<float>(std::cos(r) * std::cos(r));
          exits_[static_cast<std::size_t>(in * kExits + lobe * kBins + out)] = sum;
        }
      }
    }
  }

  void fillAzimuths() {
    turns_.resize(clear_.scattered.size());
    for (int lobe = 0; lobe < render::kLobes; ++lobe) {
      for (int row = 0; row < render::shared::kScatterTheta; ++row) {
        float sum = 0;
        for (int phi = 0; phi < kPhi; ++phi)
          turns_[turnsAt(lobe, row) + static_cast<std::size_t>(phi)] = sum +=
              render::azimuthWeight(phi) * clear_.at(lobe, row, phi)[0];
      }
    }
  }

  render::AzimuthalLobes azimuth_, clear_;
  std::vector<float> exits_, turns_;
};

}  // namespace slab_walk
