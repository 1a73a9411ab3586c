// The condition functions of one element, after Baraff and Witkin, "Large Steps in Cloth Simulation" (1998), and Wu and
// Yuksel (2016), equations (1) and (2).
//
//   energy    E = k C^2 / 2
//   force     f = -k C dC/dx - d (dC/dt) dC/dx         (d: damping)
//   Hessian   K = k dC/dx dC/dx^T + (positive semi-definite part of k C d2C/dx2)
//
// The second term is kept only for stretch under tension, where it is positive semi-definite as it stands; for shear,
// bend and volume it is indefinite and dropped, so that K is positive semi-definite in every state, flattened and
// inverted ones included.
//
// x: positions (m). C: value; g[i]: dC/dx_i. Every function is finite for finite input, degenerate elements included.
#pragma once

#include "sim/forces/vector3.h"

namespace sim {

template <class T, int N>
struct Condition {
  T value;
  V3<T> g[N];
};

// Stretch of an edge (a wall's side): C = |x1 - x0| / L - 1. With a wall's material axes laid along its sides, Baraff
// and Witkin's |w_u| - 1 and |w_v| - 1 are this condition on its sides, so that sides shared by walls are evaluated
// once with the walls' summed volume. `tension_slope` is 1 / (L |x1 - x0|): k max(C, 0) times it, across the edge, is
// the positive semi-definite part of k C d2C/dx2.
template <class T>
struct StretchCondition {
  T value;
  V3<T> direction;  // dC/dx1 = direction / L = -dC/dx0; zero for an edge without length
  T inverse_length;
  T tension_slope;
};

template <class T>
HAIRMESH_INLINE StretchCondition<T> stretchCondition(const V3<T>& x0, const V3<T>& x1, T inverse_length) {
  const T zero = constant<T>(0), one = constant<T>(1);
  const V3<T> d = x1 - x0;
  const T length = squareRoot(dot(d, d));
  // An edge collapsed to a millionth of its length has no direction; other forces part its ends.
  const auto collapsed = length * inverse_length < constant<T>(1e-6);
  const T inverse = collapsed ? zero : one / (collapsed ? one : length);
  return {length * inverse_length - one, inverse * d, inverse_length, inverse_length * inverse};
}

// Shear of a wall with corners x0, x1 (lower), x2, x3 (upper): C = w_u . w_v at its centre, where w_u and w_v are the
// derivatives of position along the hair and across it, scaled by the rest lengths.
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

// A hinge's condition, and how much stiffer a step has to take it where a wall has collapsed: `crush` (1/m^2) times the
// stiffness, along each wall's way out of its collapse. The matrix keeps no curvature of the condition itself, and in a
// collapsed wall that is so large that hair crushed by wind was thrown to and fro from step to step.
template <class T>
struct BendCondition : Condition<T, 6> {
  T crush;
};
// Second derivatives of fade and angle are some times the squared inverse of the height left. With 8 limp hair comes to
// rest no oftener, and steps of violent motion go so far short that loose solves look as good as the default's.
inline constexpr double kCrush = 2;
// What `crush` weighs between two of a hinge's vertices: both far sides' middles against the hinge's.
constexpr double crushWeight(int u, int v) {
  const int apart = u / 2 < v / 2 ? v / 2 - u / 2 : u / 2 - v / 2;
  return apart == 0 ? (u / 2 == 1 ? 0.5 : 0.25) : apart == 1 ? -0.25 : 0;
}

// Bend of two consecutive walls about their common horizontal edge x[2]-x[3]: C = fade (theta - theta_0) / length, the
// change of curvature. x: (a, b) of the layer below, of the hinge, and above; the walls' far sides act through their
// midpoints. theta_0 is where the hinge is at rest, its shift included, so that a hinge that folds over passes from pi
// to -pi off it at one energy.
//
// A wall without area has no angle: passing through there, it jumps by anything up to pi, and so would the energy (hair
// was thrown as far as the watchdog, or kept buzzing for ever by what the jumps gave away). So the angle counts for
// less in a wall whose doubled area has a square s below `smallest_square` (m^4), by t (2 - t), t = s /
// smallest_square: energy and forces go to nothing with the area, the pull on a wall stays bounded, and, C being one
// function of the shape, the hinge turns and pushes nothing as a whole.
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
  // d theta / d x is along n / s, which grows without bound as the area goes: fade / s is finite.
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
    // What the area's change adds: C d fade / fade, by ds1 = 2 n1 . (de x a + e x da), ds2 = 2 n2 . (db x e + b x de).
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

// The volume force's condition, equation (1): C = e1 . (e2 x e3) / 6 - V0, with equation (2)'s gradient. (The paper
// prints the forces with the sixth taken into k; here it stays in the gradient, so that f = -k C dC/dx holds to the
// letter.)
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

}  // namespace sim
