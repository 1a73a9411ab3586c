// THE STORY of a step: advance. One linearized implicit step of the whole hair mesh with its contacts.
#pragma once

#include <memory>
#include <span>

#include "sim/mesh/hair_mesh.h"
#include "sim/mesh/hair_state.h"
#include "sim/sim_params.h"
#include "sim/stabilization/safety_nets.h"
#include "sim/step_input.h"
#include "sim/step_report.h"

namespace sim {

struct Material;

// Scratch memory and everything derived from mesh and parameters (matrix patterns, factors). Keep one per hair; a step
// allocates nothing once it is warm. `clock` returns seconds, for stage times (nullptr: not measured).
class StepContext {
 public:
  explicit StepContext(const HairMesh& mesh, double (*clock)() = nullptr);
  ~StepContext();
  StepContext(StepContext&&) noexcept;
  StepContext& operator=(StepContext&&) noexcept;

  // When parameters change, what is derived from them at a cost (the factor of the rest shape, the balance of gravity)
  // follows in slices over the next steps instead of at once: no step takes much longer than any other, and which step
  // takes the new values over depends on counted work alone. Off at first.
  void refreshGradually(bool on);

  // The mesh has taken another rest shape (mesh/rest_shape.h): elements and masses follow at once, for little; the
  // balance of gravity in slices over the next steps, until which the old one's serves. `state`: the hair that this
  // context steps. A state saved within those steps goes on with the new balance at once.
  void reshape(HairState& state);

  // The force model, and gravity's balance, which that of other hair may start from.
  Material& material();

  // The safety nets in use (all at first), to measure what each saves. Solver::kPaper uses kAsPublished.
  SafetyNets& safetyNets();

  struct Parts;
  Parts& parts() { return *parts_; }

 private:
  std::unique_ptr<Parts> parts_;
};

// Advances `state` by dt seconds. Never leaves a value that is not finite in `state`.
StepReport advance(const HairMesh& mesh, const SimParams& params, const StepInput& input, double dt,
                   StepContext& context, HairState& state);

// The rest shape carried to world by a rigid transform, at rest or moving with `velocity` fields zero.
HairState restState(const HairMesh& mesh, const Eigen::Isometry3d& head_to_world);

// Carries a state along rigidly, keeping shape and velocity relative to the head (teleport of the second kind).
void carryAlong(const Eigen::Isometry3d& from, const Eigen::Isometry3d& to, HairState& state);

// Puts every vertex on its column's root, at rest (figure 8 of the paper).
void collapseOntoRoots(const HairMesh& mesh, HairState& state);

}  // namespace sim
