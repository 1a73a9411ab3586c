// Bend of two consecutive walls about their common horizontal edge x[2]-x[3]: C = fade (theta - theta_0) / length, the
// change of curvature. x: (a, b) of the layer below, of the hinge, and above; the walls' far sides act through their
// midpoints. theta_0 is where the hinge is at rest, its shift included, so that a hinge that folds over passes from pi
// to -pi off it at one energy.
//
// A wall without area has no angle. Let s be the square of a wall's doubled area: below `smallest_square` (m^4) the
// angle fades by t (2 - t), t = s / smallest_square, so that energy and forces vanish with the area and stay bounded.
#pragma once

#include "sim/forces/force_kind.h"

namespace sim {

// `crush` (1/m^2): bound of C d2C/dx2 where a wall has collapsed. Without it hair crushed by wind oscillates.
template <class T>
struct BendCondition : Condition<T, 6> {
  T crush;
};
// Times the squared inverse of the height left, the scale of the second derivatives of fade and angle. 8 makes violent
// motion too stiff.
inline constexpr double kCrush = 2;
// Weight of `crush` between two of a hinge's vertices: the middles of both far sides against the hinge's.
constexpr double crushWeight(int u, int v) {
  const int apart = u / 2 < v / 2 ? v / 2 - u / 2 : u / 2 - v / 2;
  return apart == 0 ? (u / 2 == 1 ? 0.5 : 0.25) : apart == 1 ? -0.25 : 0;
}

template <class T>
HAIRMESH_INLINE BendCondition<T> bendCondition(const V3<T>* x, T rest_angle, T inverse_length, T smallest_square) {
  const T zero = constant<T>(0), one = constant<T>(1), two = constant<T>(2), half = constant<T>(0.5);
  const V3<T> p = x[2], q = x[3];
  const V3<T> m1 = half * (x[0] + x[1]), m2 = half * (x[4] + x[5]);
  const V3<T> e = q - p, a = m1 - p, b = m2 - p;
  const V3<T> n1 = cross(e, a), n2 = cross(b, e);
  const T length = squareRoot(dot(e, e));
  const auto collapsed = length < constant<T>(1e-9);
  const T inverse_e = collapsed ? zero : one / (collapsed ? one : length);
  const T pi = constant<T>(3.14159265358979323846);
  T angle = arcTangent2<T>(dot(cross(n1, n2), e) * inverse_e, dot(n1, n2)) - rest_angle;
  angle = angle > pi ? angle - (pi + pi) : angle;
  angle = angle < -pi ? angle + (pi + pi) : angle;
  const T s1 = dot(n1, n1), s2 = dot(n2, n2);
  const auto small1 = s1 < smallest_square, small2 = s2 < smallest_square;
  const T bound1 = small1 ? smallest_square : s1, bound2 = small2 ? smallest_square : s2;
  const T inverse_s1 = one / (bound1 > zero ? bound1 : one), inverse_s2 = one / (bound2 > zero ? bound2 : one);
  const T t1 = small1 ? s1 * inverse_s1 : one, t2 = small2 ? s2 * inverse_s2 : one;
  const T fade1 = t1 * (two - t1), fade2 = t2 * (two - t2), fade = fade1 * fade2;
  // d theta / d x is along n / s, unbounded as the area vanishes; fade / s is finite.
  const T w1 = (two - t1) * inverse_s1 * fade2, w2 = (two - t2) * inverse_s2 * fade1;
  const T scale = -length * inverse_length;
  const V3<T> g1 = (scale * w1) * n1, g2 = (scale * w2) * n2;
  const T along1 = dot(a, e) * inverse_e * inverse_e, along2 = dot(b, e) * inverse_e * inverse_e;
  BendCondition<T> c;
  c.crush = zero;
  c.value = fade * (angle * inverse_length);
  c.g[0] = c.g[1] = half * g1;
  c.g[4] = c.g[5] = half * g2;
  c.g[2] = (along1 - one) * g1 + (along2 - one) * g2;
  c.g[3] = (-along1) * g1 + (-along2) * g2;
  if (anyOf(small1) || anyOf(small2)) {
    // The fade's derivative, C d fade / fade, by ds1 = 2 n1 . (de x a + e x da), ds2 = 2 n2 . (db x e + b x de).
    const T slope = constant<T>(4) * (angle * inverse_length);
    const V3<T> r1 = (slope * (one - t1) * inverse_s1 * fade2) * n1,
                r2 = (slope * (one - t2) * inverse_s2 * fade1) * n2;
    const V3<T> by_a = cross(r1, e), by_b = cross(e, r2), by_e = cross(a, r1) + cross(r2, b);
    c.g[0] += half * by_a, c.g[1] += half * by_a;
    c.g[4] += half * by_b, c.g[5] += half * by_b;
    c.g[3] += by_e;
    c.g[2] -= by_a + by_b + by_e;
    const T size = c.value < zero ? -c.value : c.value;
    const T crush = constant<T>(kCrush) * size * inverse_length * dot(e, e);
    const T crush1 = small1 ? crush * inverse_s1 : zero, crush2 = small2 ? crush * inverse_s2 : zero;
    c.crush = crush1 > crush2 ? crush1 : crush2;
  }
  return c;
}

struct Bend {
  static constexpr const char* kName = "bend";
  static constexpr const char* kUnit = "1/m";
  static constexpr int kVertices = 6;
  static constexpr int kRest = 3;  // angle at rest (rad), inverse length (1/m), smallest_square (m^4)
  static constexpr std::array kModuli{Modulus{.param = &SimParams::bend, .uneven = 100, .over_length = true}};

  static void collect(const ForceSource& source, const auto& add) {
    for (const Hinge& hinge : source.mesh.hinges) {
      // A wall below three tenths of its rest height has collapsed.
      const double area = 0.3 * hinge.length * restLength(source.mesh, hinge.v[2], hinge.v[3]);
      add(ElementOf<Bend>{
          hinge.v, source.params.bend * hinge.volume, {hinge.rest_angle, 1 / hinge.length, area * area}});
    }
  }

  // The shift is one of the rest angle, so that the energy is continuous where the angle jumps by a full turn.
  template <class T>
  static T restAngle(const std::array<T, kRest>& rest, T shift) {
    return rest[0] + shift / rest[1];
  }
  template <class T>
  static BendCondition<T> condition(const V3<T>* x, const std::array<T, kRest>& rest, T shift) {
    return bendCondition(x, restAngle(rest, shift), rest[1], rest[2]);
  }

  static double maxShift(const std::array<double, kRest>& rest) { return 1 * rest[1]; }  // 1 rad

  static constexpr bool kCurved = true;
  template <class T>
  static M3<T> curvature(const BendCondition<T>& c, int p, int q) {
    const T crush = c.crush * static_cast<T>(crushWeight(p, q));
    return {crush, 0, 0, 0, crush, 0, 0, 0, crush};
  }
};

}  // namespace sim
