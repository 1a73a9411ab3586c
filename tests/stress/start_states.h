// States that no motion leads to.
#pragma once

#include "sim/mesh/hair_state.h"
#include "tests/stress/random.h"
#include "tests/stress/stress_case.h"

namespace stress {

// Brings a settled state (m, world) into the case's start. Roots stay where they are.
void applyStart(const StressCase& one, const sim::HairMesh& mesh, Random& random, sim::HairState& state);

// Writes a value that is not finite, or absurd, into one random vertex. Returns the vertex.
int injectFault(const sim::HairMesh& mesh, Random& random, sim::HairState& state);

}  // namespace stress
