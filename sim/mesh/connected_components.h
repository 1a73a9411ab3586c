// Connected components of a hair mesh. Bundles that share no column, as in two plaits, interact through contacts alone,
// so components are stepped one by one.
#pragma once

#include <vector>

#include "sim/mesh/hair_mesh.h"
#include "sim/mesh/hair_state.h"
#include "sim/step.h"

namespace sim {

struct HairPart {
  HairMesh mesh;
  std::vector<int> vertices, columns;  // numbers in the whole mesh, ascending
  std::vector<int> place;              // per vertex of the whole: number in the part, or -1
};

// Empty when all of the mesh is connected.
std::vector<HairPart> connectedParts(const HairMesh& mesh);

// The part's share of the whole state, contacts included, and back again. Allocate only until they are warm.
void gatherPart(const HairPart& part, const HairState& whole, HairState& state);
void scatterPart(const HairPart& part, const HairState& state, HairState& whole);

// A whole's report from those of its parts: times and counts add up, errors are the worst.
void addPart(const StepReport& part, StepReport& whole);

}  // namespace sim
