// Force kinds: one header a kind, one line in kinds.h; all else loops over that list.
//
// An element has a condition function C of its vertices (Baraff and Witkin, "Large Steps in Cloth Simulation" (1998);
// Wu and Yuksel (2016), equations (1) and (2)):
//
//   energy    E = k (C - s)^2 / 2                      (s: shift, the value at which the element is at rest)
//   force     f = -k (C - s) dC/dx - d (dC/dt) dC/dx   (d: damping)
//   Hessian   K = k dC/dx dC/dx^T + (positive semi-definite part of k (C - s) d2C/dx2)
//
// The second term of K is a kind's `curvature`: exact for stretch under tension, dropped by shear and volume, where it
// is indefinite, a bound for bend. K is positive semi-definite in every state, flattened and inverted ones included.
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

// The source of elements. Only moving kinds make elements of a step's input.
struct ForceSource {
  const HairMesh& mesh;
  const SimParams& params;
  std::span<const PinnedVertex> pins{};
};

// One element. `rest`: the constants of its condition, as the kind's header names them.
template <class Kind>
struct ElementOf {
  std::array<int, Kind::kVertices> vertices;
  double stiffness = 0;  // J over the square of the condition's unit; elements of zero stiffness are left out
  std::array<double, Kind::kRest> rest{};
  double shift = 0;  // C at rest, before gravity is balanced
};

// A parameter that stiffnesses follow, and its place in the energy limit (stabilization/energy_limit.h).
struct Modulus {
  double SimParams::*param;
  double gentle = INFINITY;  // Pa; above, the way over which a step is near to linear shrinks by sqrt(gentle / modulus)
  bool yields = false;       // the softest of these decides whether hair is limp
  double uneven = INFINITY;  // times the softest: stiffer hair buckles
  bool over_length = false;  // Pa m^2, divided by the square of a segment's length
};

// A kind has all of this, or kinds.h does not compile:
//   kName, kUnit                of the kind; of its condition ("1" for none)
//   kVertices, kRest            number of vertices and of constants of an element
//   kModuli                     the parameters that its stiffnesses follow, beside the density
//   collect(source, add)        calls add(ElementOf<Kind>) for every element, always in the same order
//   condition(x, rest, shift)   C - s and its gradient; a type derived from Condition may carry more for `curvature`
//   maxShift(rest)              bound of the balance of gravity's share of the shift
//   kCurved                     whether there is a curvature
//   kOneSided                   optional: where C - s is none, there is neither force nor Hessian
//   curvature(condition, p, q)  the part of (C - s) d2C/dx_p dx_q that the Hessian keeps
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

// A kind whose elements are made anew in every step, of the step's input. It has no part in the balance of gravity.
//   drift(rest)               dC/dt with the vertices still
//   relativeTo(origin, rest)  the constants for positions relative to `origin` (m)
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
