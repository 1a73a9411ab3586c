// The nearest to the truth that a scene's trajectory is known.
#pragma once

#include <string>
#include <vector>

#include "tests/bench/trajectory.h"

namespace bench {

// BDF2 in double precision at a small step, linear solves to 1e-11, nothing skipped. How far it may itself be off is
// taken from its difference to the same at twice the step, which for a method of second order overstates its error
// three times, and after contacts have been made at different moments is all that can be said.
struct Reference {
  Trajectory trajectory;
  std::vector<double> energy;     // J, at the samples
  std::vector<double> own_error;  // RMS over vertices and all samples up to this one, over hair length
  double step = 0;                // s

  double ownErrorOver(int samples) const { return own_error[samples - 1]; }
};

// Step of the reference: `steps_a_second` for the low resolution, a quarter of that for the others.
inline constexpr int kReferenceRate = 3840;

// Computes the reference of a scene or reads it from `cache` (a folder; empty: always computes). A cached one is taken
// only when it was made by the same parameters from the same start and its first sample, computed anew, is the same to
// the last bit.
Reference referenceOf(TrajectoryStage& stage, int steps_a_second, const std::string& cache);

// Up to which sample two configurations to run the scene can be told apart: the longest time over which the reference's
// own error is below a tenth of `trajectory`'s. At least one sample.
int comparableSamples(const Reference& reference, const Trajectory& trajectory, double hair_length);

}  // namespace bench
