// The spring of a pin between a vertex and a point that the step's input moves: C = axis . (x - target), one element an
// axis. A pin of infinite stiffness is a constraint of the solve instead; see pinned_vertex.h.
#pragma once

#include "sim/forces/force_kind.h"

namespace sim {

struct Pin {
  static constexpr const char* kName = "pin";
  static constexpr const char* kUnit = "m";
  static constexpr int kVertices = 1;
  static constexpr int kRest = 5;  // axis (x, y, z); of the target along it: place (m) and speed (m/s)
  static constexpr std::array<Modulus, 0> kModuli{};  // each has a stiffness of its own

  static void collect(const ForceSource& source, const auto& add) {
    for (const PinnedVertex& pin : source.pins) {
      if (pin.firm()) continue;
      for (int axis = 0; axis < 3; ++axis) {
        ElementOf<Pin> element{{pin.vertex}, pin.stiffness, {0, 0, 0, pin.target[axis], pin.velocity[axis]}};
        element.rest[axis] = 1;
        add(element);
      }
    }
  }

  template <class T>
  static Condition<T, 1> condition(const V3<T>* x, const std::array<T, kRest>& rest, T shift) {
    const V3<T> axis{rest[0], rest[1], rest[2]};
    return {dot(axis, x[0]) - rest[3] - shift, {axis}};
  }

  static double maxShift(const std::array<double, kRest>&) { return 0; }
  static constexpr bool kCurved = false;

  template <class T>
  static T drift(const std::array<T, kRest>& rest) {
    return -rest[4];
  }
  static std::array<double, kRest> relativeTo(const Vec3& origin, std::array<double, kRest> rest) {
    rest[3] -= rest[0] * origin.x() + rest[1] * origin.y() + rest[2] * origin.z();
    return rest;
  }
};

}  // namespace sim
