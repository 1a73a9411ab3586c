// Fold of a column: C = -cos(u, w) - s0 where that is above zero, else none. u, w: consecutive segments, the lower one
// first. s0 leaves free what turns by 45 degrees, and more where the styled pose turns by more.
//
// Not in the paper. A column folded back on itself keeps the lengths of all edges and, beside upright neighbours, the
// angles of all walls and hinges: no other kind unfolds it (docs/safety_nets.md).
#pragma once

#include <algorithm>

#include "sim/forces/force_kind.h"

namespace sim {

struct Fold {
  static constexpr const char* kName = "fold";
  static constexpr const char* kUnit = "1";
  static constexpr int kVertices = 3;  // of a column, from the root
  static constexpr int kRest = 3;      // u2, w2 (m^2, kPointlike times the rest lengths, squared), s0
  static constexpr std::array kModuli{Modulus{.param = &SimParams::shear}, Modulus{.param = &SimParams::volume}};
  static constexpr double kOverShear = 64;   // its modulus; with 16 half as many more columns stay folded
  static constexpr double kOverVolume = 20;  // and at most so much: hair without volume may fold
  static constexpr double kFreeTurn = 0.3;   // of the cosine
  static constexpr double kPointlike = 0.2;  // of a segment's rest length: shorter ones have no direction

  static void collect(const ForceSource& source, const auto& add) {
    if (source.params.solver == Solver::kPaper) return;
    const HairMesh& mesh = source.mesh;
    const double modulus = std::min(kOverShear * source.params.shear, kOverVolume * source.params.volume);
    for (int i = 0; i < mesh.vertexCount(); ++i) {
      if (mesh.layer_of[i] < 2) continue;
      const Vec3 u = kPointlike * (mesh.shape.positions[i - 1] - mesh.shape.positions[i - 2]);
      const Vec3 w = kPointlike * (mesh.shape.positions[i] - mesh.shape.positions[i - 1]);
      const double cosine = u.dot(w) / (u.norm() * w.norm());
      add(ElementOf<Fold>{{i - 2, i - 1, i},
                          modulus * mesh.vertex_volume[i - 1],
                          {u.squaredNorm(), w.squaredNorm(), kFreeTurn - cosine}});
    }
  }

  template <class T>
  static Condition<T, 3> condition(const V3<T>* x, const std::array<T, kRest>& rest, T shift) {
    const V3<T> u = x[1] - x[0], w = x[2] - x[1];
    const T u2 = dot(u, u) + rest[0], w2 = dot(w, w) + rest[1], s0 = rest[2] + shift, between = dot(u, w);
    if (between > 0 && s0 < 0 && between * between > s0 * s0 * u2 * w2) return {};
    const T inverse = T(1) / squareRoot(u2 * w2), cosine = inverse * between;
    if (!(-cosine > s0)) return {};
    const V3<T> by_u = (cosine / u2) * u - inverse * w, by_w = (cosine / w2) * w - inverse * u;
    return {-cosine - s0, {T(-1) * by_u, by_u - by_w, by_w}};
  }

  static double maxShift(const std::array<double, kRest>&) { return 0; }
  static constexpr bool kCurved = false, kOneSided = true;
};

}  // namespace sim
