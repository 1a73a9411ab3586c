// Oscillation damping of vertices that a linearized step throws past their balance, and the next one back, for ever.
//
// Where forces are far from linear over a step (sharply folded hinges of limp hair, hair that wind presses into
// itself), the map from one step to the next may have an eigenvalue below -1 although no energy is to be had: the
// vertex goes to and fro with every step, by a fraction of a millimetre, and the hair never rests. No motion that such
// a step resolves turns back with every step. A vertex that has done so for some steps goes half of its way: an
// eigenvalue of -1 becomes 0, one of -3 becomes -1 (under-relaxation).
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
