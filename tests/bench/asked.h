// What the command line of hairmesh-bench asks for, and whether that can be measured and written.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "tests/bench/collisions.h"
#include "tests/bench/contact_sheet.h"
#include "tests/bench/conversion.h"
#include "tests/bench/frames_budget.h"
#include "tests/bench/gate.h"
#include "tests/bench/pareto.h"
#include "tests/bench/peers.h"
#include "tests/bench/skin.h"
#include "tests/bench/solver_chart.h"
#include "tests/bench/styles_bench.h"
#include "tests/bench/swing.h"

namespace bench {

// Everything that can be asked for on the command line.
struct Asked {
  StylesOptions styles;
  SheetOptions sheet;
  ParetoOptions pareto;
  SolverChartOptions solvers;
  PeersOptions peers;
  CollisionOptions collisions;
  std::vector<std::string> sets;
  GateOptions gate;
  std::string gate_document;
  FramesBudgetOptions frames_budget;
  SkinOptions skin;
  SwingOptions swing;
  ConversionOptions conversion;
  std::string document, accuracy, performance;
  bool all_hold = true;  // the figures of those that have bounds
};

// A measurement: its flag, what it does, and how. In the order in which they run when several are asked for.
struct Task {
  const char *flag, *help;
  std::function<void(Asked&)> run;
  bool asked = false;
};

// Throws app::UsageError where a scene, style, clip or parameter is none that the measurements asked for know, and
// app::InputError where a clip's file is missing.
void checkAsked(const std::vector<Task>& tasks, const Asked& asked);

// Before the first measurement, which may take hours: throws app::OutputError where what is written at the end could
// not be, and app::InputError where a page to write into is missing. Leaves nothing.
void checkOutputs(const std::vector<Task>& tasks, const Asked& asked);

}  // namespace bench
