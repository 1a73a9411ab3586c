// The strand curve once more, on the CPU and in double precision, from its definition: what the shaders must grow when
// every variation is off. Coons and Bezier patches are built from their edge curves here, not from the shaders' folded
// weights.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "render/strands/hair_layout.h"

namespace strand_reference {

using Vec2 = Eigen::Vector2d;
using Vec3 = Eigen::Vector3d;

inline std::uint32_t hash(std::uint32_t x) {
  const std::uint32_t state = x * 747796405u + 2891336453u;
  const std::uint32_t word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
  return (word >> 22u) ^ word;
}
inline std::uint32_t hash(std::uint32_t x, std::uint32_t y) {
  return hash(x ^ hash(y));
}
inline float unitFloat(std::uint32_t x) {
  return static_cast<float>(x >> 8u) * (1.0f / 16777216.0f);
}
inline float randomOf(std::uint32_t key, std::uint32_t n) {
  return unitFloat(hash(key + n * 0x9e3779b9u));
}

class Reference {
 public:
  Reference(const render::HairLayout& layout, std::span<const float> positions)
      : layout_(layout), positions_(positions) {
    render::inLayerGradients(layout, positions, gradients_);
  }

  // Where in its face's unit square the strand `index` of a face roots.
  static Vec2 facePoint(std::uint32_t face, std::uint32_t index, std::uint32_t seed) {
    const std::uint32_t key = hash(hash(face, index), seed);
    const float jitter = 0.7f / std::sqrt(static_cast<float>(index) + 1.0f);
    const float x =
        unitFloat(hash(face, seed)) + unitFloat((index + 1) * 3242174889u) + (randomOf(key, 1) - 0.5f) * jitter;
    const float y = unitFloat(hash(face + 0x51ed27u, seed)) + unitFloat((index + 1) * 2447445414u) +
                    (randomOf(key, 2) - 0.5f) * jitter;
    return Vec2(x - std::floor(x), y - std::floor(y));
  }

  // A layer's patch over a face at p in the unit square (folded into the triangle for triangles).
  Vec3 patch(int face, Vec2 p, int layer) const {
    const bool triangle = layout_.face_columns[face][3] < 0;
    if (!triangle) return coons(face, p, layer);
    if (p.x() + p.y() > 1 + 1e-9) p = Vec2(1 - p.x(), 1 - p.y());
    return bezier(face, Vec3(1 - p.x() - p.y(), p.x(), p.y()), layer);
  }

  Vec3 curve(int face, const Vec2& p, double s) const {
    const int layers = layout_.faces[face].layers;
    const int layer = std::min(static_cast<int>(s), layers - 2);
    const double f = s - layer;
    const Vec3 b = patch(face, p, layer), c = patch(face, p, layer + 1);
    const Vec3 a = layer > 0 ? patch(face, p, layer - 1) : (2 * b - c).eval();
    const Vec3 d = layer + 2 < layers ? patch(face, p, layer + 2) : (2 * c - b).eval();
    // Catmull-Rom as a cubic Hermite segment with central differences.
    const Vec3 m0 = 0.5 * (c - a), m1 = 0.5 * (d - b);
    return hermite(b, m0, c, m1, f);
  }

 private:
  static Vec3 hermite(const Vec3& p0, const Vec3& m0, const Vec3& p1, const Vec3& m1, double t) {
    const double t2 = t * t, t3 = t2 * t;
    return (2 * t3 - 3 * t2 + 1) * p0 + (t3 - 2 * t2 + t) * m0 + (3 * t2 - 2 * t3) * p1 + (t3 - t2) * m1;
  }

  const render::HairColumn& column(int face, int corner) const {
    return layout_.columns[layout_.face_columns[face][corner]];
  }
  Vec3 corner(int face, int k, int layer) const {
    const int v = column(face, k).first_vertex + layer;
    return Vec3(positions_[3 * v], positions_[3 * v + 1], positions_[3 * v + 2]);
  }
  // Tangent at corner `from` along the edge to corner `to`.
  Vec3 tangent(int face, int from, int to, int layer) const {
    const render::HairColumn& a = column(face, from);
    const Eigen::Vector3f gap = column(face, to).rest - a.rest;
    const Eigen::Vector2f d(gap.dot(a.axis_u), gap.dot(a.axis_v));
    return (gradients_[a.first_vertex + layer] * d).cast<double>();
  }
  Vec3 edge(int face, int from, int to, int layer, double t) const {
    return hermite(corner(face, from, layer), tangent(face, from, to, layer), corner(face, to, layer),
                   -tangent(face, to, from, layer), t);
  }
  Vec3 coons(int face, const Vec2& p, int layer) const {
    const double u = p.x(), v = p.y();
    const Vec3 flat = (1 - v) * ((1 - u) * corner(face, 0, layer) + u * corner(face, 1, layer)) +
                      v * ((1 - u) * corner(face, 3, layer) + u * corner(face, 2, layer));
    return (1 - v) * edge(face, 0, 1, layer, u) + v * edge(face, 3, 2, layer, u) +
           (1 - u) * edge(face, 0, 3, layer, v) + u * edge(face, 1, 2, layer, v) - flat;
  }
  Vec3 bezier(int face, const Vec3& b, int layer) const {
    Vec3 sum = Vec3::Zero(), edges = Vec3::Zero(), corners = Vec3::Zero();
    for (int k = 0; k < 3; ++k) {
      const Vec3 at = corner(face, k, layer);
      corners += at;
      sum += b[k] * b[k] * b[k] * at;
      for (int j = 0; j < 3; ++j) {
        if (j == k) continue;
        const Vec3 control = at + tangent(face, k, j, layer) / 3;
        edges += control;
        sum += 3 * b[k] * b[k] * b[j] * control;
      }
    }
    return sum + 6 * b[0] * b[1] * b[2] * (edges / 4 - corners / 6);
  }

  const render::HairLayout& layout_;
  std::span<const float> positions_;
  std::vector<Eigen::Matrix<float, 3, 2>> gradients_;
};

}  // namespace strand_reference
