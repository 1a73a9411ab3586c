// Self-collision of the hair mesh: bundles that fold over or strike each other do not interpenetrate.
//
// An external vertex inside a foreign prism (one whose bundle is neither its own nor next to it) is pushed out through
// the prism's nearest external face, whose corners give way by their mass; approach is lost and sliding resisted. What
// overlaps in the rest shape is left alone. Candidates are kept in a list with a margin (Verlet 1967), made anew when
// some vertex has moved by half the margin relative to the scalp: hair that hangs still costs one pass over its
// vertices.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "sim/hair_mesh.h"
#include "sim/hair_state.h"
#include "sim/sim_params.h"

namespace sim {

// A prism with at least one face on the outside.
struct BoundaryPrism {
  struct Face {
    int corner_count;
    std::array<int, 4> v;  // wound to face outwards
    bool external;
  };
  int prism;
  int face_count;
  std::array<Face, 6> faces;
};

struct SelfContact {
  std::vector<BoundaryPrism> prisms;
  std::vector<unsigned char> own;  // columns x root faces: 1 where the column's bundles are the face's or next to it
  std::array<int, 3> frame_roots;  // vertices that tell the scalp's frame
  double margin;                   // m
  // The list and what it was made for.
  struct Pair {
    int vertex, prism;  // prism: of `prisms`
  };
  std::vector<Pair> pairs;
  std::vector<Vec3> listed_at;  // m, in the scalp's frame; empty: no list yet
  // Scratch of making it.
  struct Box {
    Vec3 low, high;
    int prism;
  };
  std::vector<Box> boxes;
  int rebuilds = 0;  // how often the list was made, for those who measure

  explicit SelfContact(const HairMesh& mesh);
};

// Resolves the contacts among the hair's own bundles at the end of a step, positions and velocities, by no more than
// max_depenetration allows. Returns how many vertices were inside foreign prisms. Same states, same answer, whatever
// the list was made for.
int resolveSelfContacts(const HairMesh& mesh, const SimParams& params, double dt, SelfContact& self, HairState& state);

}  // namespace sim
