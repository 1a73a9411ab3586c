// What a frame cost and did, for the timings panel and the report.
#pragma once

#include <array>
#include <chrono>
#include <string>
#include <string_view>
#include <vector>

#include "app/scene/detail/skips.h"
#include "render/renderer.h"
#include "sim/step.h"

namespace app {

// Stages of a frame in the order of the paper's figure 6, then what the figure leaves out.
enum FrameStage {
  kTimeForces,
  kTimeSolve,
  kTimeCollision,
  kTimeMinimization,
  kTimeStepOther,
  kTimeCharacter,
  kTimeHandOver,
  kTimeDraw,
  kTimePanels,
  kFrameStageCount
};
inline constexpr std::array<std::string_view, kFrameStageCount> kFrameStageNames{
    "forces", "solve", "collision", "minimization", "step, other", "character", "hand over", "draw", "panels"};

// Sums over all characters and steps of one frame.
struct FrameStats {
  std::array<double, kFrameStageCount> seconds{};
  double whole = 0;       // s, the whole of advanceFrame
  double shown_time = 0;  // s simulated since the start
  int steps = 0;
  double lost = 0;  // s of time given up so far
  int solver_iterations = 0, solves = 0, minimization_iterations = 0;
  double residual = 0, residual_acceleration = 0;  // largest
  bool converged = true;
  double work_units = 0;                    // counted work, see sim/step_work.h
  int solves_cut = 0, corrections_cut = 0;  // steps whose solve or corrections ended early, see deadline.h
  int contacts = 0, corrected = 0, recoveries = 0;
  double max_penetration = 0;     // m
  int rung = -1;                  // of the budget governor; -1: it is off
  int draw_rung = -1;             // of the drawing governor; -1: it is off
  double counted_cost = 0;        // s; this and the next only where it is on
  double step_error = 0;          // sum over steps and characters, see step_error.h
  int guided = 0;                 // columns that stayed turned over and are being led back to rest
  int pins_out_of_reach = 0;      // of one character in a step, the most: they have let go
  int carried = 0;                // times that roots jumped and the hair was carried along
  sim::FaultReport fault_report;  // of the last recovery
  render::FrameReport draw;
  SkipCounts skipped{};
  BuiltInCounts always{};  // left out without a switch

  double simulation() const {
    return seconds[kTimeForces] + seconds[kTimeSolve] + seconds[kTimeCollision] + seconds[kTimeMinimization] +
           seconds[kTimeStepOther];
  }
  // s of the passes, by the driver's timer; 0 where they were not measured.
  double drawing() const {
    double milliseconds = 0;
    for (const render::StageTime& stage : draw.stages) milliseconds += stage.milliseconds;
    return 1e-3 * milliseconds;
  }
};

inline void count(bool left_out, SkipCount& skip_count) {
  skip_count.skipped += left_out;
  ++skip_count.of;
}

// Adds what a step did.
void addStep(const sim::StepReport& report, double step_seconds, FrameStats& stats);

// Adds what was done besides: times and counts are summed, and the worst values kept. What a frame ends with stays: its
// time, rungs and drawing.
void addWork(const FrameStats& more, FrameStats& stats);

// What the log and the window say about recoveries and teleports of a frame; empty when there were none.
std::string numericalNote(const FrameStats& stats);

// Seconds of a steady clock.
inline double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

// Runs `work` and adds its time to a stage.
template <class Work>
void timed(double& seconds, Work&& work) {
  const double start = now();
  work();
  seconds += now() - start;
}

}  // namespace app
