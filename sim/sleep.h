// Sleep: hair at rest over a head at rest is not stepped.
//
// Hair is at rest if in two windows of kQuietWindow in a row no vertex leaves the place where the window began by more
// than kQuietPath. Speed would not do: a pendulum is slow at its turning point.
#pragma once

#include <vector>

#include "sim/mesh/hair_state.h"
#include "sim/sim_params.h"
#include "sim/step.h"

namespace sim {

inline constexpr double kQuietPath = 5e-5;     // m, within a window
inline constexpr double kQuietWindow = 0.5;    // s
inline constexpr double kStillInput = 2e-5;    // m, roots and colliders that move less do not wake the hair
inline constexpr double kSleepError = 1.2e-4;  // m, bound of the error by sleeping

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
  HAIRMESH_FIELDS(asleep, quiet_windows, window_time, path, params, begin, roots, ellipsoids, pins)
};

// Whether the coming step may be left out. Call before every step with its input. Wakes when roots, colliders or pins
// move, a parameter or a position changes, the balance of gravity is being solved for, or gusts are on. Allocates only
// when the number of vertices, roots or ellipsoids changes.
bool maySleep(const SimParams& params, const StepInput& input, double dt, const HairState& state, SleepState& sleep);

}  // namespace sim
