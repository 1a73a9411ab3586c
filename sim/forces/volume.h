// Volume of a corner tetrahedron, equation (1): C = e1 . (e2 x e3) / 6 - V0, with equation (2)'s gradient. (The paper's
// forces have the sixth in k; here it is in the gradient, so that f = -k C dC/dx.)
#pragma once

#include <algorithm>

#include "sim/forces/force_kind.h"

namespace sim {

template <class T>
HAIRMESH_INLINE Condition<T, 4> volumeCondition(const V3<T>* x, T rest_volume) {
  const V3<T> e1 = x[1] - x[0], e2 = x[2] - x[0], e3 = x[3] - x[0];
  const T sixth = constant<T>(1.0 / 6.0);
  Condition<T, 4> c;
  c.g[1] = sixth * cross(e2, e3);
  c.g[2] = sixth * cross(e3, e1);
  c.g[3] = sixth * cross(e1, e2);
  c.g[0] = constant<T>(-1) * (c.g[1] + c.g[2] + c.g[3]);
  c.value = dot(e1, c.g[1]) - rest_volume;
  return c;
}

// The modulus (Pa) of this mesh's prisms: params.volume for sections up to 1.5 cm^2 across the hair, less in inverse
// proportion for wider ones, which cannot narrow and widen within themselves as hair does in a bend
// (docs/consistency.md). At least twice the density times 9.81 m/s^2 times the hair length: hair carries its weight.
inline double volumeModulus(const HairMesh& mesh, const SimParams& params) {
  constexpr double kResolvedSection = 1.5e-4;  // m^2
  constexpr double kCarrying = 2 * 9.81;       // m/s^2
  double section = 0;                          // m^2, of a prism across the hair, mean by volume
  for (const Prism& prism : mesh.prisms) {
    double along = 0;
    for (int k = 0; k < prism.corner_count; ++k) along += restLength(mesh, prism.v[k], prism.v[prism.corner_count + k]);
    section += prism.volume * prism.volume * prism.corner_count / along;
  }
  section /= mesh.total_volume;
  const double yielding = params.volume * std::min(1.0, kResolvedSection / section);
  return std::max(yielding, std::min(params.volume, kCarrying * params.density * mesh.hair_length));
}

struct Volume {
  static constexpr const char* kName = "volume";
  static constexpr const char* kUnit = "m^3";
  static constexpr int kVertices = 4;
  static constexpr int kRest = 1;  // volume, m^3
  static constexpr std::array kModuli{Modulus{.param = &SimParams::volume, .gentle = 1e4, .yields = true}};

  static void collect(const ForceSource& source, const auto& add) {
    const double modulus = source.params.volume > 0 ? volumeModulus(source.mesh, source.params) : 0;
    for (const CornerTet& tet : source.mesh.tets) {
      const double square = tet.rest_volume * tet.rest_volume;
      add(ElementOf<Volume>{tet.v, modulus * tet.volume / square, {tet.rest_volume}});
    }
  }

  template <class T>
  static Condition<T, 4> condition(const V3<T>* x, const std::array<T, kRest>& rest, T shift) {
    Condition<T, 4> c = volumeCondition(x, rest[0]);
    c.value -= shift;
    return c;
  }

  static double maxShift(const std::array<double, kRest>& rest) { return 0.5 * rest[0]; }
  static constexpr bool kCurved = false;
};

}  // namespace sim
