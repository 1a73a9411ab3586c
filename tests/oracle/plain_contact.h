// The oracle's contacts after the solve: position correction, deformation minimization, velocity update (figures 4 and
// 5 of the paper), in plain Eigen.
#pragma once

#include "sim/step.h"

namespace oracle {

// What sim/step does with the penetrations that a solve has left.
void resolvePenetrations(const sim::HairMesh& mesh, const sim::SimParams& params, const sim::StepInput& input,
                         double dt, const std::vector<sim::Vec3>& start, sim::HairState& state,
                         sim::StepReport& report);

}  // namespace oracle
