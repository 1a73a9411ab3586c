// The body as rigid parts with signed distances, for contacts closer to the skin than ellipsoids come.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "app/figure/character.h"
#include "app/figure/signed_grid.h"

namespace app {

// A piece of the skin that moves with one joint, closed where it was cut off from the others. The grid's frame is the
// joint's.
struct PartDistance {
  int joint = 0;
  std::uint64_t id = 0;  // of the figure's owner, where what is made of the grid is kept
  SignedGrid grid;
  double deepest = 0;            // m, the least distance, negated
  Vec3 center = Vec3::Zero();    // m, of the grid's box
  double radius = 0;             // m, of the ball around it
  int triangles = 0, holes = 0;  // of the skin; closed by a cap each
};

// One part for every joint that carries a collision ellipsoid, from the skin that hangs on it and on the joints below
// it that carry none. Takes a good part of a second: called when first asked for, by the window on a thread of its
// own.
std::vector<PartDistance> partDistances(const Character& character);

// The same of the parts whose ellipsoids do not fit alone. A part whose skin encloses nothing keeps its ellipsoids. Skin
// that hangs on such a part by four fifths of its weights or more hangs on it alone from then on.
std::vector<PartDistance> unfitPartDistances(Character& character);

// One part in a pose, with velocities from `previous` over dt when dt > 0. The span points into `part`.
void posePartDistance(const PartDistance& part, const Pose& pose, const Pose& previous, double dt, sim::BodySdf& posed);

// The parts of a pose, with velocities from `previous` over dt when dt > 0. Spans point into `parts`.
void posePartDistances(const std::vector<PartDistance>& parts, const Pose& pose, const Pose& previous, double dt,
                       std::vector<sim::BodySdf>& posed);

}  // namespace app
