// Shear of a wall with corners x0, x1 (lower), x2, x3 (upper): C = w_u . w_v at its centre, where w_u and w_v are the
// derivatives of position along the hair and across it, scaled by the rest lengths.
#pragma once

#include "sim/forces/force_kind.h"

namespace sim {

template <class T>
HAIRMESH_INLINE Condition<T, 4> shearCondition(const V3<T>* x, T inverse_along, T inverse_across) {
  const T half = constant<T>(0.5), along = half * inverse_along, across = half * inverse_across;
  const V3<T> u = along * ((x[3] - x[0]) + (x[2] - x[1]));
  const V3<T> v = across * ((x[1] - x[0]) + (x[2] - x[3]));
  const V3<T> au = across * u, av = along * v;
  Condition<T, 4> c;
  c.value = dot(u, v);
  c.g[0] = constant<T>(-1) * (au + av);
  c.g[1] = au - av;
  c.g[2] = au + av;
  c.g[3] = av - au;
  return c;
}

struct Shear {
  static constexpr const char* kName = "shear";
  static constexpr const char* kUnit = "1";
  static constexpr int kVertices = 4;
  static constexpr int kRest = 2;  // inverse lengths along and across the hair, 1/m
  static constexpr std::array kModuli{Modulus{.param = &SimParams::shear, .yields = true}};

  static void collect(const ForceSource& source, const auto& add) {
    const HairMesh& mesh = source.mesh;
    for (const Wall& wall : mesh.walls) {
      const double along = (restLength(mesh, wall.v[0], wall.v[3]) + restLength(mesh, wall.v[1], wall.v[2])) / 2;
      const double across = (restLength(mesh, wall.v[0], wall.v[1]) + restLength(mesh, wall.v[3], wall.v[2])) / 2;
      V3<double> p[4];
      for (int k = 0; k < 4; ++k) {
        const Vec3& at = mesh.shape.positions[wall.v[k]];
        p[k] = {at.x(), at.y(), at.z()};
      }
      const double skew = shearCondition(p, 1 / along, 1 / across).value;  // of the styled pose
      add(ElementOf<Shear>{wall.v, source.params.shear * wall.volume, {1 / along, 1 / across}, skew});
    }
  }

  template <class T>
  static Condition<T, 4> condition(const V3<T>* x, const std::array<T, kRest>& rest, T shift) {
    Condition<T, 4> c = shearCondition(x, rest[0], rest[1]);
    c.value -= shift;
    return c;
  }

  static double maxShift(const std::array<double, kRest>&) { return 0.5; }
  static constexpr bool kCurved = false;
};

}  // namespace sim
