// Stretch of an edge: C = |x1 - x0| / L - 1. Baraff and Witkin's |w_u| - 1 and |w_v| - 1, with a wall's material axes
// along its sides, are this condition on the sides; a side that walls share is evaluated once with their summed volume.
#pragma once

#include "sim/forces/force_kind.h"

namespace sim {

// `tension_slope` is 1 / (L |x1 - x0|): k max(C, 0) times it, across the edge, is the positive semi-definite part of
// k C d2C/dx2.
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
  // An edge below a millionth of its length has no direction.
  const auto collapsed = length * inverse_length < constant<T>(1e-6);
  const T inverse = collapsed ? zero : one / (collapsed ? one : length);
  return {length * inverse_length - one, inverse * d, inverse_length, inverse_length * inverse};
}

struct Stretch {
  static constexpr const char* kName = "stretch";
  static constexpr const char* kUnit = "1";
  static constexpr int kVertices = 2;
  static constexpr int kRest = 1;  // inverse length, 1/m
  static constexpr std::array kModuli{
      Modulus{.param = &SimParams::stretch_along, .gentle = 4e5, .uneven = 3e4},  // every style is stiffer along
      Modulus{.param = &SimParams::stretch_across, .gentle = 6e4, .yields = true, .uneven = 100},
      Modulus{.param = &SimParams::stretch_edge, .yields = true, .uneven = 100}};

  static void collect(const ForceSource& source, const auto& add) {
    const SimParams& params = source.params;
    const auto edge = [&](const Edge& e, double modulus) {
      add(ElementOf<Stretch>{{e.a, e.b}, modulus * e.volume, {1 / e.rest_length}});
    };
    for (const Edge& e : source.mesh.vertical_edges) edge(e, params.stretch_along);
    // Horizontal edges: the walls' stretch across the hair, and the edges' own.
    for (const Edge& e : source.mesh.horizontal_edges) edge(e, params.stretch_across + params.stretch_edge);
  }

  template <class T>
  struct Result : Condition<T, 2> {
    V3<T> direction;
    T tension_slope;
  };
  template <class T>
  static Result<T> condition(const V3<T>* x, const std::array<T, kRest>& rest, T shift) {
    const StretchCondition<T> s = stretchCondition(x[0], x[1], rest[0]);
    const V3<T> g = s.inverse_length * s.direction;
    return {{s.value - shift, {T(-1) * g, g}}, s.direction, s.tension_slope};
  }

  static double maxShift(const std::array<double, kRest>&) { return 0.5; }

  // Under tension an edge also resists turning: C / (L |d|) (I - direction direction^T).
  static constexpr bool kCurved = true;
  template <class T>
  static M3<T> curvature(const Result<T>& c, int p, int q) {
    const T turn = c.value > 0 ? (p == q ? c.value : -c.value) * c.tension_slope : T(0);
    const V3<T>& d = c.direction;
    const V3<T> t = turn * d;
    return {turn - t.x * d.x, -t.x * d.y, -t.x * d.z, -t.y * d.x,      turn - t.y * d.y,
            -t.y * d.z,       -t.z * d.x, -t.z * d.y, turn - t.z * d.z};
  }
};

}  // namespace sim
