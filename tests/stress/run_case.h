// Runs one case and judges it.
#pragma once

#include <cstdint>
#include <string>

#include "tests/stress/stage.h"
#include "tests/stress/stress_case.h"

namespace stress {

inline constexpr double kBack = 0.01;             // of the hair's length: near enough to rest
inline constexpr double kDeepest = 1e-4;          // m inside a collider that is still outside
inline constexpr double kEnergyTolerance = 0.01;  // of the energy that the motion left
inline constexpr double kMemoryGrowth = 1;        // MiB, of an endurance run
inline constexpr double kSlowdown = 1.5;          // of an endurance run's steps
inline constexpr double kSkinShare = 1e-3;        // of strands' points that may lie 1 mm under the drawn skin
inline constexpr double kSkinDeepest = 4e-3;      // m that the deepest may lie under it

enum class Verdict { kPassed, kFailed, kSkipped };

struct Outcome {
  Verdict verdict = Verdict::kPassed;
  std::string fault;         // the first criterion that was not met, with its numbers; empty when all were. Of a case
                             // that passed: what it fell short of by one rounding of three (runCaseByMajority)
  double at = 0;             // s into the case
  bool with_body = false;    // back with the colliders there
  double back_after = -1;    // s after the motion stopped; negative: not back
  bool other_rest = false;   // at rest elsewhere than the reference hair, no higher in energy
  int worst_vertex = 0;      // the one farthest from the reference hair
  double distance = 0;       // from the reference hair at the end, worst vertex, over the hair length
  double deepest = 0;        // m inside a collider at a frame's end, outside of grace
  long inside = 0;           // vertices deeper than kDeepest, summed over frames, outside of grace
  long unconstrained = 0;    // of those, without a contact
  double energy_rise = 0;    // most above what the motion left, after it stopped, of the energy that it left
  double energy_step = 0;    // largest rise from step to step, of the same; not judged
  double memory_growth = 0;  // MiB, of an endurance run after its first tenth
  double slowdown = 1;       // of an endurance run: CPU time a step in its last tenth over that in its second
  int recoveries = 0, carried = 0, steps = 0;
  int guided = 0;         // most columns guided to rest at once
  double iterations = 0;  // of the linear solver a step, mean
  double dearest = 0;     // units a vertex, of the motion's dearest step
  double unsolved = 0;    // share of the steps whose solve ended at its most iterations
  double cpu_seconds = 0;
  double skin_share = 0, skin_deepest = 0;  // of drawn strands' points more than 1 mm under the drawn skin; m
};

// A clip that is not there makes a skipped case. `seed` is the run's; `trace` prints a line a step.
Outcome runCase(const StressCase& one, std::uint64_t seed, bool trace, StageStore& stages);

// Contacts and tangles part ways by the last bit of a number, which is not the same on every processor: a case that
// falls short is run twice more with gravity changed by a millionth up and down, and passes where both pass. The fault
// is kept.
Outcome runCaseByMajority(const StressCase& one, std::uint64_t seed, bool trace, StageStore& stages);

}  // namespace stress
