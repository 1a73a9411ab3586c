// What a force kind is. One header a kind, one line in kinds.h; all else loops over that list.
//
// An element's energy is that of a condition function C of its vertices, after Baraff and Witkin, "Large Steps in Cloth
// Simulation" (1998), and Wu and Yuksel (2016), equations (1) and (2):
//
//   energy    E = k (C - s)^2 / 2                      (s: shift, the value at which the element is at rest)
//   force     f = -k (C - s) dC/dx - d (dC/dt) dC/dx   (d: damping)
//   Hessian   K = k dC/dx dC/dx^T + (positive semi-definite part of k (C - s) d2C/dx2)
//
// The second term of K is a kind's `curvature`. Only stretch under tension has one that is positive semi-definite as it
// stands; shear and volume are indefinite there and drop it, bend has a bound of it. So K is positive semi-definite in
// every state, flattened and inverted ones included.
#pragma once

#include <array>
#include <cmath>
#include <concepts>
#include <span>

#include "sim/forces/pinned_vertex.h"
#include "sim/linear/vector3.h"
#include "sim/mesh/hair_mesh.h"
#include "sim/sim_params.h"

namespace sim {

// x: positions (m). value: C; g[i]: dC/dx_i. Finite for finite input, degenerate elements included.
template <class T, int N>
struct Condition {
  T value;
  V3<T> g[N];
};

// What elements are made from. Of a step's input only kinds that move may make elements.
struct ForceSource {
  const HairMesh& mesh;
  const SimParams& params;
  std::span<const PinnedVertex> pins{};
};

// One element as its kind makes it. `rest`: the constants of its condition, as the kind's header names them.
template <class Kind>
struct ElementOf {
  std::array<int, Kind::kVertices> vertices;
  double stiffness = 0;  // J over the square of the condition's unit; an element without stiffness is left out
  std::array<double, Kind::kRest> rest{};
  double shift = 0;  // at which it is at rest before gravity is balanced
};

// A parameter that stiffnesses follow, and what the energy limit (stabilization/energy_limit.h) concludes from it.
struct Modulus {
  double SimParams::*param;
  // Pa: a step stays near to linear over a way shorter by sqrt(gentle / modulus) where the modulus is larger.
  double gentle = INFINITY;
  bool yields = false;       // among the moduli of which the softest decides whether hair is limp
  double uneven = INFINITY;  // times the softest: hair that is stiffer than that buckles
  bool over_length = false;  // Pa m^2, counted over the square of a segment's length
};

// A kind has all of this, or kinds.h does not compile:
//   kName, kUnit         of the kind; of its condition ("1" for none)
//   kVertices, kRest     how many vertices and how many constants an element has
//   kModuli              the parameters that its stiffnesses follow, beside the density
//   collect(source, add) calls add(ElementOf<Kind>) for every element, always in the same order
//   condition(x, rest, shift)         C - s and its gradient, or a type derived from Condition that tells curvature
//   more maxShift(rest)                    bound of what the balance of gravity may add to the shift kCurved whether
//   there is curvature(condition, p, q)        the part of (C - s) d2C/dx_p dx_q that the Hessian keeps
template <class Kind>
concept ForceKind = requires(const ForceSource& source, const V3<double>* x, const V3<float>* y,
                             const std::array<double, Kind::kRest>& rest, const std::array<float, Kind::kRest>& low) {
  { Kind::kName } -> std::convertible_to<const char*>;
  { Kind::kUnit } -> std::convertible_to<const char*>;
  requires Kind::kVertices >= 1;
  {std::span<const Modulus>(Kind::kModuli)};
  Kind::collect(source, [](const ElementOf<Kind>&) {});
  { Kind::condition(x, rest, 0.0) } -> std::convertible_to<Condition<double, Kind::kVertices>>;
  { Kind::condition(y, low, 0.0f) } -> std::convertible_to<Condition<float, Kind::kVertices>>;
  { Kind::maxShift(rest) } -> std::same_as<double>;
  { Kind::kCurved } -> std::convertible_to<bool>;
  requires !Kind::kCurved || requires {
    { Kind::curvature(Kind::condition(x, rest, 0.0), 0, 0) } -> std::same_as<M3<double>>;
  };
};

// A kind whose elements are made anew in every step, of the step's input. They are at rest where the input says, and
// take no share in the balance of gravity.
//   drift(rest)                       dC/dt with the vertices still
//   relativeTo(origin, rest)          the constants where positions are relative to `origin` (m)
template <class Kind>
concept MovingKind = ForceKind<Kind> && requires(const std::array<double, Kind::kRest>& rest, const Vec3& origin) {
  { Kind::drift(rest) } -> std::same_as<double>;
  { Kind::relativeTo(origin, rest) } -> std::same_as<std::array<double, Kind::kRest>>;
};

// m between two vertices of the styled pose.
inline double restLength(const HairMesh& mesh, int a, int b) {
  return (mesh.shape.positions[b] - mesh.shape.positions[a]).norm();
}

}  // namespace sim
