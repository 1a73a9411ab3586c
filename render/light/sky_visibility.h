// How much light of the sky, the fill and the rim light reaches each hair mesh vertex: optical depths through a lattice
// of hair density that is fixed to the head, the head as a ball fitted to the roots, and before fill and rim the body's
// ellipsoids. The key light has its deep opacity maps. A hair mesh knows its prisms' volumes, so the density is exact
// when hair is squeezed or spread.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "render/frame_input.h"
#include "render/light/density_grid.h"
#include "render/strands/hair_layout.h"

namespace render {

// The rigid motion of the roots since they were at rest: least squares (Kabsch 1976).
Eigen::Isometry3f headFrame(const HairLayout& layout, std::span<const float> positions);

// Optical depths of a light: between it and the vertex, and behind the vertex as far as light comes back from.
struct LightDepths {
  float front = 0, behind = 0;
};
// Both in one float, as the shaders read them; see shared.h.
float packDepths(const LightDepths& depths);

struct SoftLight {
  float sky = 1;  // 0..1, mean transmittance over the upper directions
  LightDepths fill, rim;
};

// What the hair lets through to a surface beside it, from any side: at nodes of the lattice 24 mm apart the
// transmittance T(w) = a + b . w, fitted to the sky's directions. RGBA8: a, (b + 1) / 2. The outermost let all through,
// so that it has no edge where the lattice ends.
struct HairOpenness {
  std::array<int, 3> size{};  // texels along u, v, w: the lattice's z, y, x, and room for it to grow
  std::vector<std::array<std::uint8_t, 4>> texels;
  Eigen::Matrix4f from_head = Eigen::Matrix4f::Identity();  // the head's frame to u, v, w in 0..1
};

class SkyVisibility {
 public:
  // hair_width: summed projected diameter of all hairs, m (number of hairs times diameter). length_variation: of the
  // look: strands end that share of their length early, more or less. to_fill, to_rim: unit. skin: of the body, which
  // stands in the way of fill and rim.
  void compute(const HairLayout& layout, std::span<const float> positions, float hair_width, float length_variation,
               const Eigen::Vector3f& to_fill, const Eigen::Vector3f& to_rim, std::span<const SkinEllipsoid> skin = {});
  std::span<const SoftLight> values() const { return values_; }  // one a vertex
  const HeadBall& head() const { return head_; }
  const HairOpenness& openness() const { return openness_; }

 private:
  void placeVertices(const HairLayout& layout, std::span<const float> positions);
  void fillGrid(const HairLayout& layout, float hair_width, float length_variation);
  // Optical depths towards a direction of the head's frame, for all vertices; see depths_.
  void lookTowards(const Eigen::Vector3f& direction);
  // Adds a direction's share to the fit, from the depths that were swept last.
  void addOpenness(std::size_t direction);
  void packOpenness();
  float depthBehind(const Eigen::Vector3f& from, const Eigen::Vector3f& to_light) const;

  DensityGrid grid_;
  HeadBall head_;
  Eigen::Vector3f head_center_ = Eigen::Vector3f::Zero();  // in the head's frame
  Eigen::Isometry3f frame_ = Eigen::Isometry3f::Identity();
  std::vector<Eigen::Vector3f> vertices_;  // in the head's frame
  std::vector<float> blurred_;             // optical depth that the lattice's blur puts before each vertex
  std::vector<float> swept_, depths_;
  std::vector<SoftLight> values_;
  std::array<int, 3> open_nodes_{};                // a side, x first
  Eigen::ArrayXf open_depths_;                     // of one direction
  Eigen::Array<float, Eigen::Dynamic, 4> fitted_;  // a and b
  HairOpenness openness_;
};

}  // namespace render
