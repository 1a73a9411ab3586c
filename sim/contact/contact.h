// Contacts of hair mesh vertices with the colliders: carry, find, constrain.
#pragma once

#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "sim/contact/colliders.h"
#include "sim/contact/passage.h"
#include "sim/mesh/hair_mesh.h"
#include "sim/mesh/hair_state.h"
#include "sim/mesh/vertex_constraint.h"
#include "sim/sim_params.h"
#include "sim/skip_count.h"

namespace sim {

// A vertex nearer to a collider than the contact offset at the end of a step.
struct Penetration {
  int vertex, collider;
  Vec3 target;           // m, corrected position
  Vec3 normal;           // outward unit normal there
  double depth;          // m, below the offset
  bool initial_overlap;  // it lay inside before the step: the correction is bounded by max_depenetration
  double left;           // m, depth of the target below the offset
};

struct ContactMargins {
  double offset;  // m off the surface at which contacts are held
  double slack;   // m below the offset that is left; more is corrected
  double escape;  // m that an initial overlap is resolved by in one step
};
ContactMargins contactMargins(const SimParams& params, double dt);

// Input of findPenetrations.
struct ContactSearch {
  std::span<const int> vertices;
  Colliders colliders;
  std::span<const Vec3> start;  // m, positions at the step's start; empty: no paths, no initial overlaps
  double dt = 0;                // s
  ContactMargins margins{};
  // Closest points counted by the colliders, beyond which a vertex has one passage and few projections.
  long max_points = std::numeric_limits<long>::max();
};

// Positions (m) of some vertices at the start (0) and at the end (1) of a step.
struct SweptBox {
  int vertices = 0;
  std::array<Vec3, 2> low, high;
};

// Scratch of the searches, sized once.
struct ContactScratch {
  std::vector<NearCollider> near;
  // Clusters of neighbouring vertices: a collider out of reach of a cluster's bounds is tested with none of its
  // vertices. Empty: every vertex is tested with all of `near`.
  std::vector<int> cluster_of;   // per vertex
  std::vector<SweptBox> boxes;   // per cluster
  std::vector<int> reached;      // places in `near`, cluster by cluster
  std::vector<int> reached_end;  // per cluster: end of its part of `reached`
  SkipCount tests;               // of a vertex with a collider, over all searches
};

// Splits the mesh into clusters by its rest shape. Call once.
void clusterVertices(const HairMesh& mesh, ContactScratch& scratch);

// Brings carried contacts to this step: normal and velocity are those at the place to which the collider's motion
// carries the vertex. A contact out of reach, or without its collider, is dropped. The velocity lifts nothing, for that
// would be work: what lies below the offset by more than the slack is resolved by positions (position_correction.h).
void carryContacts(const Colliders& colliders, const SimParams& params, double dt, HairState& state);

// Penetrations of the vertices, in their order: of every collider that a vertex lies in, or that it went through within
// the step. Resolved by alternating projections, so that targets lie outside creases between bodies too.
void findPenetrations(const ContactSearch& search, std::span<const Vec3> positions, ContactScratch& scratch,
                      std::vector<Penetration>& found);

// Coulomb's law at the start of a solve, from the vertex's velocity (m/s) and mobility (step over mass, s/kg). A
// sliding contact goes on sliding until its slip has turned; any other sticks if friction can stop it within the step.
void chooseSticking(double friction, double mobility, const Vec3& velocity, Contact& contact);

// What friction may do in a step.
struct FrictionLaw {
  double coefficient;
  double h;          // s, the step
  double most_work;  // J, bound of the work of friction on a vertex that it turns back
};

// Coulomb's law after a solve, from the vertex's reaction (N) and velocity (m/s). Needs a solve to full tolerance.
//   sticks, pulls:                  slides, without pressure
//   sticks, beyond friction's cone: slides, pressed no harder than in the step before
//   slides, turned back by more than `most_work`: sticks for the rest of the step
//   slides, pulls:                  is left with a negative pressure; the caller drops it
// Returns whether the constraint or the friction changed.
bool updateSticking(const FrictionLaw& law, const Vec3& reaction, const Vec3& velocity, Contact& contact);

// One constraint per vertex in contact (contacts are sorted by vertex): a single normal, a crease of two or three, or
// all directions where one of its contacts sticks.
void constrainContacts(std::span<const Contact> contacts, std::vector<VertexConstraint>& constraints);

}  // namespace sim
