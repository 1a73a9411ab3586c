// Oscillation damping: under-relaxes vertices that turn back with every step.
//
// Where forces are far from linear over a step (sharply folded hinges of limp hair, hair that wind presses into
// itself), the map from one step to the next may have an eigenvalue below -1 although the energy does not grow. The
// vertex then goes to and fro by a fraction of a millimetre for ever. No motion that the step resolves turns back with
// every step, so such a vertex goes half of its way: an eigenvalue of -1 becomes 0, one of -3 becomes -1.
#pragma once

#include <span>

#include "sim/mesh/hair_mesh.h"
#include "sim/mesh/hair_state.h"

namespace sim {

inline constexpr int kMinTurns = 6;        // steps in a row, from which on a vertex is damped
inline constexpr double kMinSpeed = 1e-3;  // m/s against its root; slower to and fro is not seen

// After a step from `start` (m). Roots stay. Returns how many vertices were held back. The memory has its size.
int dampOscillation(const HairMesh& mesh, std::span<const Vec3> start, HairState& state);

}  // namespace sim
