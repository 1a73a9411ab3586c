// One case under way: its hair, what happens around it, and its steps.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "app/motion/fixed_clock.h"
#include "sim/step.h"
#include "tests/stress/run_case.h"
#include "tests/stress/skin_look.h"
#include "tests/stress/surroundings.h"

namespace stress {

// One hair and what simulates it. Every case has its own, so that a case replays the same alone as among others.
struct Hair {
  const sim::HairMesh& mesh;
  sim::StepContext context;
  sim::HairState state;
  explicit Hair(const sim::HairMesh& m) : mesh(m), context(m) {}
};

struct Run {
  const StressCase& one;
  Stage& stage;
  Random random;
  Surroundings around;
  Hair hair;
  sim::SimParams params;
  app::FixedClock clock;
  Outcome outcome;
  std::optional<SkinLook> skin;  // of a case that looks at it
  SkinSeen skin_seen;
  int frames = 0;
  double last_intrusion = 0;  // s
  double next_fault = 0;      // s
  double raised = 0;          // J, most energy since a body appeared within the hair
  long iterations = 0, unsolved = 0, met = 0;
  bool trace = false;
  bool waits = false;  // the hair is not stepped: its state is yet to come (resume.h)

  Run(const StressCase& c, std::uint64_t seed, Stage& s);

  bool failed() const { return !outcome.fault.empty(); }
  // Whether a body stands within the hair from some time on: it lifts the hair, and goes on working where roots lie
  // within it.
  bool bodyWithin() const { return one.upset == Upset::kSwitchOn || one.upset == Upset::kBury; }
  void fail(std::string fault) {
    if (failed()) return;
    outcome.fault = std::move(fault);
    outcome.at = around.time();
  }
};

// Mechanical energy (J) with that of a steady wind, whose push on hair that does not move is a weight of its own
// direction.
double energyOf(const Run& run, Hair& hair);
sim::Vec3 windOf(const Run& run);  // m/s, limited

// A step of one hair among what is around; of the case's own, with what happens to it and what it is judged by; and a
// frame of such steps at the case's pace.
sim::StepReport stepHair(const sim::SimParams& params, const Run& run, double dt, Hair& hair);
void step(double dt, Run& run);
void frame(Run& run);

// What every step is judged and counted by.
void checkFinite(Run& run);
void checkOutside(Run& run);
void countWork(const sim::StepReport& report, Run& run);
void traceStep(const Run& run, double dt, const sim::StepReport& report, Hair& hair);

}  // namespace stress
