// The caller's numbers as the simulator's, and back. What is not finite is refused, naming the place.
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <string>

#include "app/library/fault.h"
#include "sim/contact/colliders.h"
#include "sim/forces/pinned_vertex.h"

namespace app::library {

using sim::Vec3;

// Element `index` of an array, `count` numbers of it into `numbers`.
void readElement(const hm_array& array, std::size_t index, int count, double* numbers);
void writeElement(const hm_target& target, std::size_t index, int count, const double* numbers);

// Throws Fault where the array has no data, another number of elements than `count`, an unknown type, or a stride below
// an element of three numbers, of a target of `numbers`.
void checkArray(const hm_array& array, std::size_t count, const char* name);
void checkTarget(const hm_target& target, std::size_t count, int numbers, const char* name);

// Element `index`; throws Fault naming it where it is not finite.
Vec3 pointOf(const hm_array& array, std::size_t index, const char* name);

// Names a number of the caller's for a message, which is made only where it is needed: a step takes no memory.
struct Place {
  const char* name;
  std::ptrdiff_t index = -1;  // of an array, or -1
  std::string text(const char* field) const;
};

Eigen::Isometry3d poseOf(const hm_pose& pose, const Place& place);
sim::Ellipsoid ellipsoidOf(const hm_ellipsoid& given, const Place& place);
sim::PinnedVertex pinOf(const hm_pin& given, int vertices, const Place& place);

inline constexpr hm_pose kNoPose{{0, 0, 0}, {0, 0, 0, 1}};

}  // namespace app::library
