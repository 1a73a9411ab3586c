// Contacts of external vertices with the colliders: find, constrain, correct.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "sim/colliders.h"
#include "sim/hair_mesh.h"
#include "sim/hair_state.h"
#include "sim/sim_params.h"

namespace sim {

// A penetration found at the end of a step: the vertex lies nearer to the collider than the contact offset.
struct Penetration {
  int vertex, collider;
  Vec3 target;   // m, where the vertex belongs: on the surface's offset
  Vec3 normal;   // outward unit normal there
  double depth;  // m, how far inside the offset it lay
};

// Brings carried contacts to this step: normal and velocity from where the collider's motion carries the vertex, the
// gap to the offset closed at no more than max_depenetration. Contacts with colliders that are gone are dropped.
void carryContacts(std::span<const Ellipsoid> ellipsoids, const SimParams& params, double dt, HairState& state);

// Penetrations of the external vertices, each resolved against every ellipsoid it lies in (alternating projections, so
// that a crease between two bodies is left too). Found in vertex order.
void findPenetrations(const HairMesh& mesh, std::span<const Ellipsoid> ellipsoids, double offset,
                      std::span<const Vec3> positions, std::vector<Penetration>& found);

// The constraint of one vertex: velocity = keep * (free velocity) + prescribed.
struct VertexConstraint {
  int vertex;
  Eigen::Matrix3d keep;              // projector onto the free directions
  Vec3 prescribed;                   // m/s, within the removed directions
  int removed = 0;                   // how many directions are
  std::array<Vec3, 3> directions{};  // orthonormal basis of them
};

// One constraint per vertex in contact (contacts are sorted by vertex): a single normal, a crease of two or three, or
// all directions where one of its contacts sticks.
void constrainContacts(std::span<const Contact> contacts, std::vector<VertexConstraint>& constraints);

}  // namespace sim
