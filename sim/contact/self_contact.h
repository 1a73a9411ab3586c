// Self-collision of the hair mesh: bundles that fold over or strike each other do not interpenetrate.
//
// An external vertex inside a foreign prism (of another bundle than its own or the next, or of these some layers away)
// is pushed out through the prism's nearest external face, whose corners give way by their mass; approach is lost and
// sliding resisted. Where the hair moves far in a step, its way is played in short pieces and contacts are met on it.
// What overlaps in the rest shape is left alone. Candidates are kept in a list with a margin (Verlet 1967), made anew
// when some vertex has moved by half the margin relative to the scalp: hair that hangs still costs one pass over its
// vertices.
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
  std::vector<unsigned char> own;  // columns x root faces: 1 where the column's bundles are the face's or next to it
  std::array<int, 3> frame_roots;  // vertices that tell the scalp's frame
  double margin;                   // m
  double stride;                   // m, that vertex and prism may near one another between two looks on the way
  // The list and what it was made for.
  struct Pair {
    int vertex, prism;  // prism: of `prisms`
    signed char apart;  // a face of the prism that the vertex lay beyond; negative: none, they overlap at rest
    bool stood;         // it lay inside before the step
  };
  std::vector<Pair> pairs;
  std::vector<Vec3> listed_at;  // m, in the scalp's frame; empty: no list yet
  // What the last step did: positions before it (m) and which vertices it pushed; for those that are to follow.
  std::vector<Vec3> unmoved;
  std::vector<unsigned char> moved;
  // Scratch of a step's motion.
  int looks = 1;                   // ways that it is cut into
  std::vector<Vec3> between, way;  // m, positions within the step, and the way from look to look
  // Scratch of making the list.
  struct Box {
    Vec3 low, high;
    int prism;
  };
  std::vector<Box> boxes;
  int rebuilds = 0;  // how often the list was made, for those who measure

  explicit SelfContact(const HairMesh& mesh);
};

// The step whose contacts are to be resolved.
struct SelfContactStep {
  const HairMesh& mesh;
  const SimParams& params;
  std::span<const Vec3> start;  // m, positions at its start; empty: paths are not looked at
  double dt;                    // s
};

// Resolves the contacts among the hair's own bundles at the end of a step, positions and velocities; overlaps that
// stood before by no more than max_depenetration allows. Returns how many vertices were inside foreign prisms or had
// gone through them. Same states, same answer, whatever the list was made for.
int resolveSelfContacts(const SelfContactStep& step, SelfContact& self, HairState& state);

}  // namespace sim
