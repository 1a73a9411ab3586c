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
inline constexpr double kCrush =
    8;  // second derivatives of fade and angle: about the squared inverse of the height left
// What `crush` weighs between two of a hinge's vertices: both far sides' middles against the hinge's.
constexpr double crushWeight(int u, int v) {
  const int apart = u / 2 < v / 2 ? v / 2 - u / 2 : u / 2 - v / 2;
  return apart == 0 ? (u / 2 == 1 ? 0.5 : 0.25) : apart == 1 ? -0.25 : 0;
}

// A hinge whose walls have collapsed: their angle is nothing then, and jumps. So that no energy jumps with it (hair
// that wind had crushed was kept buzzing for ever by what each jump gave away), the condition goes to zero with a
// collapsing wall's squared area s, as r (2 - r), r = s / smallest_square, for the walls together as the product of
// both; and the gradient is that of this condition, so that what it takes to collapse a wall comes back when it is
// drawn out. `e`, `a`, `b`: as in bendCondition; `angle`: rad from rest.
template <class T>
HAIRMESH_INLINE void fadeCollapsed(const V3<T>& e, const V3<T>& a, const V3<T>& b, T angle, T inverse_length,
                                   T smallest_square, BendCondition<T>& c) {
  const T zero = constant<T>(0), one = constant<T>(1), two = constant<T>(2), half = constant<T>(0.5);
  const V3<T> n1 = cross(e, a), n2 = cross(b, e);
  const T s1 = dot(n1, n1), s2 = dot(n2, n2), inverse_square = one / smallest_square;
  const T r1 = s1 < smallest_square ? s1 * inverse_square : one, r2 = s2 < smallest_square ? s2 * inverse_square : one;
  const T fade1 = r1 * (two - r1), fade2 = r2 * (two - r2), fade = fade1 * fade2;
  const T length_square = dot(e, e), length = squareRoot(length_square);
  const T inverse_e = length_square > zero ? one / (length_square > zero ? length_square : one) : zero;
  // Fade times the angle's gradient along the normals: a wall's share of it goes with its area, and stays finite.
  const T per1 = s1 < smallest_square ? (two - r1) * inverse_square : one / (s1 < smallest_square ? one : s1);
  const T per2 = s2 < smallest_square ? (two - r2) * inverse_square : one / (s2 < smallest_square ? one : s2);
  const T scale = -length * inverse_length;
  const V3<T> turn1 = (scale * per1 * fade2) * n1, turn2 = (scale * per2 * fade1) * n2;
  // Angle times the fade's gradient; d s1 = 2 n1 . (de x a + e x da).
  const T grow = constant<T>(4) * angle * inverse_length * inverse_square;
  const T grow1 = grow * fade2 * (one - r1), grow2 = grow * fade1 * (one - r2);
  const V3<T> area_a = grow1 * cross(n1, e), area_b = grow2 * cross(e, n2);
  const V3<T> area_e = grow1 * cross(a, n1) + grow2 * cross(n2, b);
  const T t1 = dot(a, e) * inverse_e, t2 = dot(b, e) * inverse_e;
  const V3<T> g1 = turn1 + area_a, g2 = turn2 + area_b;
  const V3<T> g[6] = {half * g1,
                      half * g1,
                      (t1 - one) * turn1 + (t2 - one) * turn2 - area_a - area_b - area_e,
                      (-t1) * turn1 + (-t2) * turn2 + area_e,
                      half * g2,
                      half * g2};
  const auto collapsed = (s1 < smallest_square) | (s2 < smallest_square);
  c.value = collapsed ? fade * angle * inverse_length : c.value;
  const T size = c.value < zero ? -c.value : c.value;
  c.crush = collapsed ? constant<T>(kCrush) * size * inverse_length * length_square * inverse_square : zero;
  for (int k = 0; k < 6; ++k) {
    c.g[k] = {collapsed ? g[k].x : c.g[k].x, collapsed ? g[k].y : c.g[k].y, collapsed ? g[k].z : c.g[k].z};
  }
}

// Bend of two consecutive walls about their common horizontal edge x[2]-x[3]: C = (theta - theta_0) / length, the
// change of curvature. x: (a, b) of the layer below, of the hinge, and above; the walls' far sides act through their
// midpoints. `smallest_square` (m^4) is the square of the doubled area below which a wall counts as collapsed: there
// the condition fades.
template <class T>
HAIRMESH_INLINE BendCondition<T> bendCondition(const V3<T>* x, T rest_angle, T inverse_length, T smallest_square) {
  const T zero = constant<T>(0), one = constant<T>(1), half = constant<T>(0.5);
  const V3<T> p = x[2], q = x[3];
  const V3<T> m1 = half * (x[0] + x[1]), m2 = half * (x[4] + x[5]);
  const V3<T> e = q - p, a = m1 - p, b = m2 - p;
  const V3<T> n1 = cross(e, a), n2 = cross(b, e);
  const T length = squareRoot(dot(e, e));
  const auto no_edge = length < constant<T>(1e-9);
  const T inverse_e = no_edge ? zero : one / (no_edge ? one : length);
  const T pi = constant<T>(3.14159265358979323846);
  T angle = arcTangent2<T>(dot(cross(n1, n2), e) * inverse_e, dot(n1, n2)) - rest_angle;
  angle = angle > pi ? angle - (pi + pi) : angle;
  angle = angle < -pi ? angle + (pi + pi) : angle;
  const T s1 = dot(n1, n1), s2 = dot(n2, n2);
  const auto collapsed1 = s1 < smallest_square, collapsed2 = s2 < smallest_square;
  // Torques go as s1 w1 and s2 w2 and are equal to the last bit: the smaller share, of one but for its rounding, holds
  // for both.
  const T bound1 = one / (collapsed1 ? smallest_square : s1), bound2 = one / (collapsed2 ? smallest_square : s2);
  const T share1 = s1 * bound1, share2 = s2 * bound2;
  const T w1 = share2 < share1 ? share2 / s1 : bound1, w2 = share1 < share2 ? share1 / s2 : bound2;
  const T scale = -length * inverse_length;
  const V3<T> g1 = (scale * w1) * n1, g2 = (scale * w2) * n2;
  const T t1 = dot(a, e) * inverse_e * inverse_e, t2 = dot(b, e) * inverse_e * inverse_e;
  BendCondition<T> c;
  c.crush = zero;
  c.value = angle * inverse_length;
  c.g[0] = c.g[1] = half * g1;
  c.g[4] = c.g[5] = half * g2;
  c.g[2] = (t1 - one) * g1 + (t2 - one) * g2;
  c.g[3] = (-t1) * g1 + (-t2) * g2;
  if (anyOf(collapsed1 | collapsed2)) fadeCollapsed(e, a, b, angle, inverse_length, smallest_square, c);
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
