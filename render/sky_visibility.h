// How much light of the sky, the fill and the rim light reaches each hair mesh vertex: optical depths through a coarse
// grid of hair density, and the head as a ball fitted to the roots. Soft light needs no more; the key light has its
// deep opacity maps. A hair mesh knows its prisms' volumes, so the density is exact when hair is squeezed or spread.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "render/frame_input.h"
#include "render/hair_layout.h"

namespace render {

struct HeadBall {
  Eigen::Vector3f center = Eigen::Vector3f::Zero();
  float radius = 0;  // m; 0: the roots do not lie on anything like a head
};

// Least-squares sphere through the roots.
HeadBall fitHead(const HairLayout& layout, std::span<const float> positions);

// Per vertex: x sky visibility (0..1, mean transmittance over the upper directions), y and z optical depth towards
// the two given unit directions. hair_width: summed projected diameter of all hairs, m (number of hairs times
// diameter).
class SkyVisibility {
 public:
  void compute(const HairLayout& layout, std::span<const float> positions, float hair_width,
               const Eigen::Vector3f& to_fill, const Eigen::Vector3f& to_rim);
  std::span<const Eigen::Vector3f> values() const { return values_; }
  const HeadBall& head() const { return head_; }

 private:
  void fillGrid(const HairLayout& layout, std::span<const float> positions, float hair_width);
  void splat(const Eigen::Vector3f& at, float extinction);
  float density(const Eigen::Vector3f& at) const;
  float opticalDepth(const Eigen::Vector3f& from, const Eigen::Vector3f& direction) const;

  std::vector<float> grid_;  // 1/m, kGridSize^3
  Eigen::Vector3f low_ = Eigen::Vector3f::Zero();
  float cell_ = 0.01f;
  HeadBall head_;
  std::vector<Eigen::Vector3f> values_;
};

}  // namespace render
