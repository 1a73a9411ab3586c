// What a step did and what its stages took. sim has no clock of its own: the caller gives one, or none.
#pragma once

#include <array>

#include "sim/skip_count.h"
#include "sim/stabilization/state_validation.h"
#include "sim/step_work.h"

namespace sim {

// Stages of a step, as in the paper's figure 6.
enum Stage { kStageForces, kStageSolve, kStageCollision, kStageMinimization, kStageOther, kStageCount };

struct StepReport {
  std::array<double, kStageCount> seconds{};  // filled when a clock is given to the context
  int solver_iterations = 0, solves = 0;
  double residual = 0;               // relative, at the end of the last linear solve
  double residual_acceleration = 0;  // m/s^2, largest over vertices
  bool converged = true;
  int contacts = 0, corrected = 0;   // constrained vertices; vertices moved by position correction
  int minimization_iterations = 0;   // or, of the exact way, answers computed anew plus one a correction
  double max_penetration = 0;        // m, found before correction
  int initial_overlap = 0;           // vertices, counted a round, that lay inside a body before the step already
  double initial_overlap_depth = 0;  // m, deepest below the offset that is left because it stood before the step
  int self_contacts = 0;             // vertices pushed out of foreign bundles
  int guided = 0;                    // columns guided to rest (inversion_recovery.h)
  int recoveries = 0;                // vertices or states repaired (state_validation.h)
  FaultReport fault_report;          // what it found, for the log
  bool carried = false;              // the roots had jumped as no motion could: the hair was carried along with them
  SkipCount refreshes;               // of what follows the parameters (the factor of the rest shape, the balance of
                                     // gravity): 1 of 1 where nothing was made, nor a slice of it
  int pins = 0;                      // that hold
  int pins_out_of_reach = 0;         // that have let go, see kPinReach
  double pin_force = 0;              // N, largest
  SkipCount force_kinds;             // kinds of force that have no stiffness, of all
  SkipCount collider_tests;          // of a vertex with a collider, all searches: those that lay out of reach
  StepWork work;                     // all that was counted
  double work_units = 0;             // workUnits of it
  bool solve_cut = false;            // iterations ended at StepInput::max_work, not at the tolerance
  bool corrections_cut = false;      // corrections ended early: nothing is inside a body, nothing else followed
};

struct StageClock {
  double (*clock)() = nullptr;
  double started = 0;

  void start() { started = clock ? clock() : 0; }
  // Books the time since the last start or spent on `stage`.
  void spent(Stage stage, StepReport& report) {
    if (!clock) return;
    const double now = clock();
    report.seconds[stage] += now - started;
    started = now;
  }
};

}  // namespace sim
