// Contacts of hair mesh vertices with the colliders: carry, find, constrain.
#pragma once

#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "sim/contact/colliders.h"
#include "sim/mesh/hair_mesh.h"
#include "sim/mesh/hair_state.h"
#include "sim/sim_params.h"
#include "sim/skip_count.h"

namespace sim {

// A contact found at the end of a step: the vertex lies nearer to the collider than the contact offset.
struct Penetration {
  int vertex, collider;
  Vec3 target;           // m, where the vertex belongs at the step's end
  Vec3 normal;           // outward unit normal there
  double depth;          // m, how far inside the offset it lay
  bool initial_overlap;  // it lay inside before the step: the target is no farther than max_depenetration allows
  double left;           // m, how far below the offset the target lies then
};

// How near a contact may come, m.
struct ContactMargins {
  double offset;  // where contacts are held
  double slack;   // a contact so much nearer is not worth a correction: it is carried out by the next steps
  double escape;  // how far an overlap that stood before the step may be resolved in it
};
ContactMargins contactMargins(const SimParams& params, double dt);

// What a search for penetrations looks at.
struct ContactSearch {
  std::span<const int> vertices;
  Colliders colliders;
  std::span<const Vec3> start;  // m, positions at the step's start; empty: nothing is swept and nothing has stood
  double dt = 0;                // s
  ContactMargins margins{};
};

// A collider that the hair may touch, with the rigid motion of the step.
struct NearCollider {
  int index;
  Vec3 before, after;    // m, its centre
  Eigen::Matrix3d turn;  // by which it turned
  double turned;         // rad
  double reach, thin;    // m, around the centre that a contact may lie; its thickness
  // What moves by s m within the step meets it from no farther than margin + stretch * s off its centre at the end.
  double margin = INFINITY, stretch = 1;

  // Where the motion carries a point that was fixed to it at the step's start.
  Vec3 carried(const Vec3& start) const { return after + turn * (start - before); }
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
  // vertices. None: every vertex is tested with all of `near`.
  std::vector<int> cluster_of;   // per vertex
  std::vector<SweptBox> boxes;   // per cluster
  std::vector<int> reached;      // places in `near`, of one cluster after the other ...
  std::vector<int> reached_end;  // ... up to here
  SkipCount tests;               // of the searches so far: of a vertex with a collider
};

// Splits the mesh into clusters by its rest shape. To be called once.
void clusterVertices(const HairMesh& mesh, ContactScratch& scratch);

// Brings carried contacts to this step: normal and velocity from where the collider's motion carries the vertex.
// Contacts that are out of reach, or whose collider is gone, are dropped. Overlaps are not resolved by velocities,
// which would outlive them, but by positions (position_correction.h); only a dip below the offset is, where the contact
// is not pressed so hard that closing it would store energy worth the name.
void carryContacts(const Colliders& colliders, const SimParams& params, double dt, HairState& state);

// Penetrations of the vertices, each resolved against every collider it lies in (alternating projections, so that a
// crease between two bodies is left too) or whose motion relative to it led through it within the step. In the order of
// the vertices.
void findPenetrations(const ContactSearch& search, std::span<const Vec3> positions, ContactScratch& scratch,
                      std::vector<Penetration>& found);

// Coulomb's law at the start of a solve, from the vertex's velocity (m/s) and mobility (step over mass, s/kg). A
// contact that slid goes on sliding, its friction against the slip, until the slip has turned; any other sticks where
// friction could stop it within the step. So what slides and what rests is solved once, and only what changes twice.
void chooseSticking(double friction, double mobility, const Vec3& velocity, Contact& contact);

// What friction may do in a step.
struct FrictionLaw {
  double coefficient;
  double h;          // s, the step
  double most_work;  // J, that friction may add at this vertex by turning it back
};

// Coulomb's law after a solve, from the vertex's reaction (N) and velocity (m/s). A contact that would pull slides
// first, since it may do so for being held sideways alone; one that slides already is left with a negative pressure: it
// is to be let go. One that friction cannot hold slides, pressed no harder than in the step before: a vertex held at a
// stiff edge presses with a hundred newtons (seen: 153 N on a third of a gram) that are gone once it slides. One that
// friction has thrown back by more than `most_work` sticks for the rest of the step. Returns whether the constraint or
// the friction changed.
// (Judging by a looser solve saves iterations, but lets go of contacts that press: the vertex is then inside at the
// step's end, is corrected and found again, frame after frame.)
bool updateSticking(const FrictionLaw& law, const Vec3& reaction, const Vec3& velocity, Contact& contact);

// The constraint of one vertex: velocity = keep * (free velocity) + prescribed.
struct VertexConstraint {
  int vertex;
  Eigen::Matrix3d keep;                                                      // projector onto the free directions
  Vec3 prescribed;                                                           // m/s, within the removed directions
  int removed = 0;                                                           // how many directions are
  std::array<Vec3, 3> directions{Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};  // orthonormal basis of them
};

// One constraint per vertex in contact (contacts are sorted by vertex): a single normal, a crease of two or three, or
// all directions where one of its contacts sticks.
void constrainContacts(std::span<const Contact> contacts, std::vector<VertexConstraint>& constraints);

}  // namespace sim
