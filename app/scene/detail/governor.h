// The budget governor: holds the simulation to so many milliseconds a frame by walking a ladder of measured settings.
//
// A rung is an integrator, a time step and a tolerance from the front of run time against error (docs/accuracy.md),
// with what it costs against the default and how far it strays. The governor watches what a simulated second costs on
// this machine with this hair, steps down when that is over the budget and up when the next rung's predicted cost fits
// well below it. What a change of rung really did to the cost is remembered, and a climb that had to be taken back lets
// it wait longer before the next: it never swings between two rungs. Every rung is in the stress run
// (docs/stability.md, family ladder).
#pragma once

#include <array>
#include <span>
#include <string>

#include "sim/mesh/fields.h"
#include "sim/sim_params.h"
#include "sim/step.h"

namespace app {

struct Rung {
  const char* name;
  sim::Integrator integrator;
  double steps_per_second;
  double tolerance;
  int max_iterations;  // of the linear solver
  double cost;         // of a simulated second, relative to the default
  double error;        // RMS position error over hair length: the geometric mean of the measured scenes, of two styles
                       // at about 360 vertices
};

// From coarse to fine; costs rise and errors fall. See governor_ladder.cpp for how it was measured.
std::span<const Rung> ladder();
int defaultRung();
inline constexpr int kMaxRungs = 16;

// What a frame did, as the governor sees it.
struct FrameCost {
  double shown = 0;      // s that the picture advanced
  double simulated = 0;  // s that the hair advanced: steps times their length
  double cost = 0;       // s, of the simulation of all characters
  double error = 0;      // measured: see stepError; mean over steps and characters
};

struct Governor {
  double budget = 0;     // s a frame for all characters together; 0: off, the person's own settings hold
  bool counted = false;  // costs are counted work (countedCost) in place of measured time: runs that must repeat

  // In effect, and what is known of it.
  int rung = 0;
  double predicted_cost = 0, measured_cost = 0;  // s a frame
  double measured_error = 0;                     // over hair length
  bool over_budget = false;                      // the coarsest rung costs more than the budget
  long changes = 0;

  // The window being measured, in sums over its frames.
  struct Window {
    double shown = 0, simulated = 0, cost = 0, error = 0;
    int frames = 0;
    HAIRMESH_FIELDS(shown, simulated, cost, error, frames)
  } window;
  double last_window = 0;                     // cost of a simulated second in the window before; 0: none at this rung
  double settle = 0;                          // simulated s to let pass before measuring
  double since_change = 0, backoff = 0;       // shown s; of waiting before a climb
  bool calibrated = false;                    // a first window has been seen
  int left_rung = 0;                          // where the last change came from
  double left_cost = 0;                       // of a simulated second there; 0: learned from already, or a jump
  std::array<double, kMaxRungs> steepness{};  // learned cost of rung k + 1 over rung k; 0: the ladder's
  HAIRMESH_FIELDS(budget, counted, rung, predicted_cost, measured_cost, measured_error, over_budget, changes, window,
                  last_window, settle, since_change, backoff, calibrated, left_rung, left_cost, steepness)
};

// Starts governing at `seconds` a frame, or ends it with 0. What was learned of the ladder stays.
void setBudget(double seconds, Governor& governor);

// Takes a frame in; changes the rung when it is time to. Returns whether it did.
bool observe(const FrameCost& frame, Governor& governor);

// The person's parameters with the rung's in place; the person's own when the governor is off.
sim::SimParams governed(const sim::SimParams& params, const Governor& governor);

// Expected error of the rung in effect, over hair length: Rung::error, one number whatever the hair. It is the average
// over the styles and motions that the ladder was measured on; short hair that lies on the head strays by far less,
// hair thrown about by more. What this hair does is Governor::measured_error.
double predictedError(const Governor& governor);

// "bdf2 1/240 s, tolerance 1e-2"
std::string rungName(const Governor& governor);

// The cost of a step of the default solver by counted work, in seconds of the machine that the ladder was measured on:
// the same on every run.
double countedCost(int vertices, const sim::StepReport& report);

}  // namespace app
