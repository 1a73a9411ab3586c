// Self-collision of the hair mesh: bundles that fold over or strike each other do not interpenetrate.
//
// An external vertex inside a foreign prism (not of its own or a neighbouring bundle, or of these some layers away) is
// pushed out through the prism's nearest external face, whose corners move by their mass. Approach is removed, sliding
// resisted. Long paths are cut into pieces and contacts found on each. Pairs that overlap in the rest shape are left
// out. Candidates are kept in a list with a margin (Verlet 1967), made anew when a vertex has moved by half the margin
// relative to the scalp.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "sim/mesh/hair_mesh.h"
#include "sim/mesh/hair_state.h"
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
  std::vector<unsigned char> own;  // columns x root faces: 1 where a bundle of the column is the face's or next to it
  std::array<int, 3> frame_roots;  // vertices that define the scalp's frame
  double margin;                   // m, of the list
  double stride;                   // m, longest piece of a vertex's path relative to a prism
  // The list, derived from the positions that it was made for.
  struct Pair {
    int vertex, prism;  // prism: of `prisms`
    signed char apart;  // a face of the prism that the vertex last lay beyond; negative: they overlap at rest
    bool stood;         // initial overlap: the vertex lay inside before the step
  };
  std::vector<Pair> pairs;
  SelfContactMemory made_for;
  std::vector<Vec3> listed_at;  // m, in the scalp's frame; empty: no list yet
  // Of the last step: positions before it (m), and which vertices it pushed.
  std::vector<Vec3> unmoved;
  std::vector<unsigned char> moved;
  // Scratch.
  int pieces = 1;                  // that the step's motion is cut into
  std::vector<Vec3> between, way;  // m, positions within the step, displacements of one piece
  struct Box {
    Vec3 low, high;
    int prism;
  };
  std::vector<Box> boxes;
  int rebuilds = 0;  // how often the list was made

  explicit SelfContact(const HairMesh& mesh);
};

// The step whose contacts are to be resolved.
struct SelfContactStep {
  const HairMesh& mesh;
  const SimParams& params;
  std::span<const Vec3> start;  // m, positions at its start; empty: no paths
  double dt;                    // s
};

// Resolves the contacts among the hair's own bundles at the end of a step, positions and velocities; initial overlaps
// by no more than max_depenetration. Returns the number of vertices inside foreign prisms or gone through them. The
// result depends on the state alone, memory included.
int resolveSelfContacts(const SelfContactStep& step, SelfContact& self, HairState& state);

}  // namespace sim
