// How wrong the last step was, by its own account: an estimate of the integrator's local error from two steps'
// velocities.
#pragma once

#include <vector>

#include "sim/mesh/hair_mesh.h"
#include "sim/mesh/hair_state.h"
#include "sim/sim_params.h"

namespace app {

// Keeps what the estimate for a two-step method needs from one step to the next.
struct StepErrorMeter {
  std::vector<sim::Vec3> change;  // of velocity in the step before, m/s
  double step = 0;                // s, its length; 0: none
  HAIRMESH_FIELDS(change, step)
};

// Root mean square over the vertices of the step's local error over hair length and per second, after a step of the
// state. Implicit Euler's is h^2 / 2 x'', BDF2's 2 h^3 / 9 x''' (Hairer, Norsett and Wanner, Solving Ordinary
// Differential Equations I, III.2), with the derivatives as differences of velocities.
double stepError(const sim::HairMesh& mesh, sim::Integrator integrator, const sim::HairState& state,
                 StepErrorMeter& meter);

// What local errors add up to while the hair remembers them: error over hair length from the mean of stepError.
double accumulatedError(sim::Integrator integrator, double mean_step_error);

}  // namespace app
