// THE STORY of a step: advance. One linearized implicit step of the whole hair mesh with its contacts.
#pragma once

#include <array>
#include <memory>
#include <span>

#include "sim/colliders.h"
#include "sim/hair_mesh.h"
#include "sim/hair_state.h"
#include "sim/left_out.h"
#include "sim/sim_params.h"
#include "sim/watchdog.h"

namespace sim {

// What happens around the hair during a step: poses at the step's end.
struct StepInput {
  std::span<const Vec3> roots;            // m, world, one per column
  std::span<const Ellipsoid> ellipsoids;  // with the velocities that brought them there
  double time = 0;                        // s, of the step's end (gusts are a function of it)
  std::span<const DistancePart> parts{};  // the same body as signed distances, for ColliderKind::kSdf; may be none
};

// Stages of a step, as in the paper's figure 6.
enum Stage { kStageForces, kStageSolve, kStageCollision, kStageMinimization, kStageOther, kStageCount };
const char* stageName(Stage stage);

struct StepReport {
  std::array<double, kStageCount> seconds{};  // filled when a clock is given to the context
  int solver_iterations = 0, newton_iterations = 0;
  double residual = 0;               // relative, at the end of the last linear solve
  double residual_acceleration = 0;  // m/s^2, largest over vertices
  bool converged = true;
  int contacts = 0, corrected = 0;  // constrained vertices; vertices moved by position correction
  int minimization_iterations = 0;  // or, of the exact way, answers computed anew plus one a correction
  double max_penetration = 0;       // m, found before correction
  int standing = 0;                 // vertices, counted a round, that lay inside a body before the step already
  double standing_overlap = 0;      // m, deepest below the offset that is left because it stood before the step
  int self_contacts = 0;            // vertices pushed out of foreign bundles
  int combed = 0;                   // columns that stayed turned over and are led back to rest (comb_out.h)
  int recoveries = 0;               // watchdog restored the last good state
  Trouble trouble;                  // what it found, for the log
  bool carried = false;             // the roots had jumped as no motion could: the hair was carried along with them
  LeftOut refreshes;                // of what follows the parameters (the factor of the rest shape, the balance of
                                    // gravity): 1 of 1 where nothing was made, nor a slice of it
  LeftOut force_kinds;              // kinds of force that have no stiffness, of all
  LeftOut collider_tests;           // of a vertex with a collider, all searches: those that lay out of reach
};

// Scratch memory and everything derived from mesh and parameters (matrix patterns, factors). Keep one per hair; a step
// allocates nothing once it is warm. `clock` returns seconds, for stage times (nullptr: not measured): sim has no
// clock.
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

  // With Solver::kPaper: steps as published, without the energy guard, the limits of corrections, combing out and the
  // check of the rest shape. For comparisons; off at first.
  void leaveAsPublished(bool on);

  struct Parts;
  Parts& parts() { return *parts_; }

 private:
  std::unique_ptr<Parts> parts_;
};

// Advances `state` by dt seconds. Never leaves a value that is not finite in `state`.
StepReport advance(const HairMesh& mesh, const SimParams& params, const StepInput& input, double dt,
                   StepContext& context, HairState& state);

// Kinetic, elastic and gravitational energy of a state (J); gravity's zero is at y = 0. `context` keeps what is derived
// from the parameters.
double mechanicalEnergy(const HairMesh& mesh, const SimParams& params, StepContext& context, const HairState& state);

// The rest shape carried to world by a rigid transform, at rest or moving with `velocity` fields zero.
HairState restState(const HairMesh& mesh, const Eigen::Isometry3d& head_to_world);

// Carries a state along rigidly, keeping shape and velocity relative to the head (teleport of the second kind).
void carryAlong(const Eigen::Isometry3d& from, const Eigen::Isometry3d& to, HairState& state);

// Puts every vertex on its column's root, at rest (figure 8 of the paper).
void collapseOntoRoots(const HairMesh& mesh, HairState& state);

}  // namespace sim
