// Configurations to simulate a scene, each measured: milliseconds and error.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sim/sim_params.h"
#include "tests/bench/reference.h"

namespace bench {

enum class SweepSize { kShort, kQuick, kFull };

// The default first, then the others; none twice. All sizes: every integrator at every step length and tolerance with
// the default solver; then at some steps of the default's integrator every solver at several tolerances; every
// precision; with `contacts` minimization off; but in the short one the paper's setting at 1/60 s. Left out: the other
// solvers under the other integrators and at the other steps, whose solutions are the same to the tolerance, so that
// only their time differs, by about the ratio seen here; precision and minimization away from the default, for the same
// reason. Full: steps 1/30 to 1/960 s, tolerances 1e-1 to 1e-8. Quick: to 1/240 s and 1e-3. Short: what came near the
// default's place on any chart.
std::vector<sim::SimParams> configurationsToRun(SweepSize size, bool contacts);

// By how much a configuration is off, of everything that a chart reports: where hair is thrown about so that every
// configuration's positions are off alike, lengths and volumes still tell one from another.
struct Errors {
  double rms = 0, most = 0;  // of positions, over hair length
  double stretch = 0;        // worst, of lengths along the hair
  double volume = 0;         // mean
  double penetration = 0;    // m, deepest

  // Not further off in the mean position than by what the reference itself may be.
  bool noWorseInPosition(const Errors& than, double own_error) const { return rms <= than.rms + own_error; }
  // Nor in anything else by what would show: a tenth, a hundredth of lengths and volumes, a tenth of a millimetre
  // inside.
  bool noWorseInAny(const Errors& than, double own_error) const;
};

struct Point {
  sim::SimParams params;
  RunResult result;  // of the last run; trajectory and energies are dropped
  TrajectoryError error;
  std::optional<double> energy_drift;  // mean of E - E of the reference over the range of the latter, where it has one
  double fastest = 0, median = 0;      // ms of CPU time a simulated second, over the timed runs
  bool is_default = false, on_front = false;
  bool ranked = true;  // the reference's own error is below a tenth of this one's
  std::string name() const;
  Errors errors() const;
};

// A scene's points over the samples that can be compared; the default first.
struct Sweep {
  TrajectoryScene scene;
  double reference_step = 0;    // s
  double own_error = 0;         // of the reference, over those samples
  double compared_seconds = 0;  // of the scene
  std::vector<Point> points;
};

// Runs every configuration `runs` + 1 times, the first not timed, round after round, so that a disturbance of the
// machine does not fall on one configuration alone. Configurations that take over a second are timed twice only.
Sweep sweepScene(TrajectoryStage& stage, const Reference& reference, const std::vector<sim::SimParams>& configurations,
                 int runs);

// Errors that differ by less than the reference's own are equal. A point is on the front when no other has an equal or
// smaller error in less time. Times within 2 % are equal too: repeated runs differ by as much.
void markFront(Sweep& sweep);

// How many times the fastest configuration that is no worse in any error is faster than the default; that
// configuration. And the same by the mean error of positions alone.
struct Lag {
  double ratio = 1;
  const Point* configuration = nullptr;
};
Lag lagOfDefault(const Sweep& sweep);
Lag lagByPosition(const Sweep& sweep);

// Time of `slow` over that of `fast`, run in turns; the median of so many rounds.
double confirmedRatio(TrajectoryStage& stage, const sim::SimParams& slow, const sim::SimParams& fast, int rounds);

}  // namespace bench
