// What steps remember beyond positions, velocities and contacts. Part of a hair's state (hair_state.h): data alone,
// empty in a new state and sized by the first step. What follows from mesh and parameters is in StepContext.
#pragma once

#include <array>
#include <vector>

#include "sim/mesh/fields.h"
#include "sim/mesh/hair_mesh.h"
#include "sim/mesh/vertex_constraint.h"
#include "sim/sim_params.h"

namespace sim {

struct HairState;

// The state at the last step's end; empty before there was one (stabilization/state_validation.h).
struct GoodState {
  std::vector<Vec3> positions, velocities;  // m, m/s, one per vertex
  HAIRMESH_FIELDS(positions, velocities)
};

// stabilization/inversion_recovery.h
struct RecoveryMemory {
  struct Column {
    double guided = -1;  // s since guiding began; negative: it is not guided
    double wait = 0;     // s before it may be guided again
    double backoff = 0;  // s that it waits after it was guided
    double upright = 0;  // s since one of its elements was last inverted
    HAIRMESH_FIELDS(guided, wait, backoff, upright)
  };
  std::vector<Column> columns;
  std::vector<double> turned;  // s that each corner tetrahedron has been inverted, weighted
  std::vector<double> folded;  // the same of columns folded back at each vertex
  std::vector<Vec3> target;    // m, seen from the head: where guided columns go, one per vertex
  double since_look = 0;       // s
  int guided_columns = 0;
  HAIRMESH_FIELDS(columns, turned, folded, target, since_look, guided_columns)
};

// stabilization/reference_hair.h
struct RestMemory {
  std::vector<HairState> reference;  // one
  double still = 0;                  // s that the hair has hung still
  double settling = -1;              // s since the reference left the rest shape; negative: there is none
  bool judged = false;               // nothing more to find out before the hair has moved
  double wait = 0, backoff = 0;      // s before it may be guided again, and after the next time
  bool kept_apart = false;           // the reference's bundles are, by self-contact
  HAIRMESH_FIELDS(reference, still, settling, judged, wait, backoff, kept_apart)
};

// The positions (m) between which the list of self-contact candidates was made; empty: there is none
// (contact/self_contact.h).
struct SelfContactMemory {
  std::vector<Vec3> start, end;
  HAIRMESH_FIELDS(start, end)
};

// How the force model follows the parameters (forces/rest_balance.h). The model follows from these and the mesh.
struct MaterialMemory {
  bool known = false;  // it has been made
  SimParams params;    // of the last step
  SimParams balanced;  // for which the balance of gravity in use was solved
  SimParams coming;    // for which the next one is being solved
  int slices = 0;      // of that solve that are done; 0: none is under way; below: so many steps before it begins
  bool outdated = false;
  HAIRMESH_FIELDS(known, params, balanced, coming, slices, outdated)
};

// What a system matrix is made of beside positions and material (implicit_solve.h).
struct MatrixTerms {
  struct Spring {
    int vertex = 0;
    double stiffness = 0;  // N/m
    bool operator==(const Spring&) const = default;
    HAIRMESH_FIELDS(vertex, stiffness)
  };
  double h = 0, damping = 0, drag = 0;  // s, s, 1/s
  std::vector<Spring> pins;
  bool operator==(const MatrixTerms&) const = default;
  HAIRMESH_FIELDS(h, damping, drag, pins)
};

// One part of the preconditioner that serves more than one solve: what it was made for, from which it can be made again
// to the bit, and how it has served (linear/two_level.h).
struct PartMemory {
  struct Input {
    std::vector<Vec3> positions;  // m, relative to the first root; empty: it serves no longer
    MatrixTerms terms;
    std::vector<VertexConstraint> constraints;
    HAIRMESH_FIELDS(positions, terms, constraints)
  };
  Input input;
  int age = 0, fresh = 0;  // solves since it was made; iterations of the first of them
  double lost = 0;         // iterations beyond those of the first, since then
  HAIRMESH_FIELDS(input, age, fresh, lost)
};
struct TwoLevelMemory {
  PartMemory factors, coarse;
  // The matrices to come have little to do with those before.
  void forget() { factors.input.positions.clear(), coarse.input.positions.clear(); }
  HAIRMESH_FIELDS(factors, coarse)
};

// The changes of velocity (m/s) that the last steps made, one per vertex (linear/solution_projection.h).
struct ProjectionMemory {
  std::array<std::vector<Vec3>, 2> changes;
  int newest = 0, recorded = 0;
  HAIRMESH_FIELDS(changes, newest, recorded)
};

struct SolveMemory {
  TwoLevelMemory two_level;
  ProjectionMemory projection;
  bool unfinished = false;  // the last linear solve
  HAIRMESH_FIELDS(two_level, projection, unfinished)
};

struct HairMemory {
  GoodState good;
  RecoveryMemory recovery;
  RestMemory rest;
  SelfContactMemory self_contact;
  MaterialMemory material;
  SolveMemory solve;
  HAIRMESH_FIELDS(good, recovery, rest, self_contact, material, solve)
};

}  // namespace sim
