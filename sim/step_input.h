// What happens around the hair during a step.
#pragma once

#include <cmath>
#include <span>

#include "sim/contact/colliders.h"
#include "sim/forces/pinned_vertex.h"
#include "sim/mesh/hair_mesh.h"

namespace sim {

// Poses at the step's end.
struct StepInput {
  std::span<const Vec3> roots;            // m, world, one per column
  std::span<const Ellipsoid> ellipsoids;  // with the velocities that brought them there
  double time = 0;                        // s, of the step's end (gusts are a function of it)
  std::span<const BodySdf> parts{};       // the same body as signed distances, for ColliderKind::kSdf; may be none
  std::span<const PinnedVertex> pins{};   // vertices drawn to points that move with joints, the scalp or not at all
  double max_work = INFINITY;             // workUnits (step_work.h) that the step should keep within
  std::span<const BodySdf> attached{};    // collided with beside the body, whatever its kind: hats and the like
};

}  // namespace sim
