// Sleep: hair that hangs still over a head that stands still is not stepped.
//
// Quiet is judged by path, not by speed: a pendulum at its turning point is slow too. Over two windows of half a second
// no vertex may leave the place where the window began by more than kQuietPath, and what it moved in the second window
// must be no more than in the first, so that the rest of the way, were it a decaying creep, is short as well.
#pragma once

#include <vector>

#include "sim/mesh/hair_state.h"
#include "sim/sim_params.h"
#include "sim/step.h"

namespace sim {

inline constexpr double kQuietPath = 5e-5;     // m, within a window
inline constexpr double kQuietWindow = 0.5;    // s
inline constexpr double kStillInput = 2e-5;    // m, roots and colliders may creep so far before the hair wakes
inline constexpr double kSleepError = 1.2e-4;  // m: the rest of the way, and the inputs' creep

struct SleepState {
  bool asleep = false;
  int quiet_windows = 0;
  double window_time = 0;   // s since the window began
  double path = 0;          // m, farthest that a vertex has been from where the window began
  SimParams params;         // of the last step
  std::vector<Vec3> begin;  // m, positions where the window began; asleep: those it fell asleep with
  std::vector<Vec3> roots;  // m, when the window began or the hair fell asleep
  std::vector<Ellipsoid> ellipsoids;
  std::vector<PinnedVertex> pins;
};

// Whether the coming step may be left out. Called before every step with what the step would get; keeps its own
// account in `sleep`. Wakes when roots, colliders or pins leave their place, a parameter or a position changes, or wind
// that comes and goes is on. Allocates only when the number of vertices, roots or ellipsoids changes.
bool maySleep(const SimParams& params, const StepInput& input, double dt, const HairState& state, SleepState& sleep);

}  // namespace sim
