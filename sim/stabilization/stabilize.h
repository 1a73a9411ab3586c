// The one door to the safety nets: what a step does beyond the published algorithm so that hair stays finite, bounded
// and on its way home. Solver::kPaper uses none of them but the repair of values that are not finite or absurd.
#pragma once

#include <functional>
#include <vector>

#include "sim/contact/position_correction.h"
#include "sim/stabilization/energy_limit.h"
#include "sim/stabilization/inversion_recovery.h"
#include "sim/stabilization/reference_hair.h"
#include "sim/stabilization/safety_nets.h"
#include "sim/stabilization/state_validation.h"
#include "sim/step_input.h"
#include "sim/step_report.h"

namespace sim {

// Scratch of the nets of one hair, sized once. What they remember is in the state (mesh/hair_memory.h).
struct Stabilization {
  SafetyNets nets;    // asked for
  SafetyNets active;  // in this step
  EnergyLimit energy_limit;
  std::vector<char> touched;  // by a body, per vertex
  std::vector<double> reach;  // m, the farthest that a vertex may be from its root
  std::vector<Vec3> limited_velocities;
  std::vector<V3<double>> plain_positions;
  std::vector<Vec3> root_positions;
  std::vector<Ellipsoid> still_bodies;
  std::vector<BodySdf> still_parts;
  std::vector<PinnedVertex> still_pins;

  explicit Stabilization(const HairMesh& mesh);
};

// Before a step: repairs vertices of `state` that something outside of the step has spoilt (report.recoveries), and
// carries the hair along over a teleport, a jump of the roots faster than params.teleport_speed (report.carried).
// Returns the input of the step; after a teleport its bodies, which have come as far, stand still, and `params` let
// position correction bring out at once what lies in them.
StepInput admitState(const HairMesh& mesh, const ForceModel<double>& model, const StepInput& input, double dt,
                     SimParams& params, Stabilization& scratch, HairState& state, StepReport& report);

// After integration: energy limit, stretch limit (no vertex farther from its root than twice the hair between them),
// inversion recovery, repair of what is not finite or absurd. `converged`: the solve did.
void stabilize(const TakenStep& step, const StepInput& input, bool converged, Stabilization& scratch, HairState& state,
               StepReport& report);

// After self-contact and position correction: what they lifted is paid for by the energy that the step began with. Hair
// that they lifted by more goes back, and is corrected once more without taking a velocity.
void limitCorrectionEnergy(const TakenStep& step, const CorrectedStep& corrected, PositionCorrection& correction,
                           Stabilization& scratch, HairState& state, StepReport& report);

// At a step's end: remembers the state as good and compares hair at rest in
// another shape than its own with a reference hair (reference_hair.h), which takes one step by `advance_reference`.
// `energy`: mechanical, of a state (J).
void finishStep(const TakenStep& step, const std::function<void(const SimParams&, HairState&)>& advance_reference,
                const std::function<double(const HairState&)>& energy, Stabilization& scratch, HairState& state);

}  // namespace sim
