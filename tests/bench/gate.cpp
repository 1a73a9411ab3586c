#include "tests/bench/gate.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "app/files/errors.h"
#include "app/files/text_file.h"
#include "tests/bench/cpu_clock.h"
#include "tests/bench/gate_drawing.h"
#include "tests/bench/gate_motion.h"
#include "tests/bench/gate_sweep.h"
#include "tests/bench/measured_part.h"
#include "tests/bench/reference.h"
#include "tests/bench/scene_times.h"
#include "tests/bench/table.h"
#include "tests/bench/timed_scene.h"
#include "tests/bench/waits.h"

namespace bench {
namespace {

using app::Resolution;
using app::Style;
using sim::SimParams;

constexpr double kWalk = 1.0;       // s of the walk that ratios and errors are taken from
constexpr double kTightest = 2e-6;  // relative tolerance of the plain implementation that is tried
constexpr double kDragBound = 3;    // the worst frame of a drag over the median one of an undisturbed walk

struct Report {
  std::vector<Figure> figures;
  void add(const Figure& figure) {
    std::printf("%-5s %-58s %10.4g %s %.4g %s%s%s\n", figure.holds() ? "ok" : "short", figure.name.c_str(),
                figure.value, figure.at_least ? ">=" : "<=", figure.bound, figure.unit.c_str(),
                figure.note.empty() ? "" : "  # ", figure.note.c_str());
    std::fflush(stdout);
    figures.push_back(figure);
  }
};

struct Bounds {
  double ratio, milliseconds;
};

// The simulator and the plain implementation take turns on the walk.
void compareWithPlain(Style style, Resolution resolution, const Bounds& bounds, const GateOptions& options,
                      Report& report) {
  const int rounds = options.rounds;
  std::string name = formatted("gate_%s_%s", std::string(app::styleName(style)).c_str(),
                               std::string(app::resolutionName(resolution)).c_str());
  TimedScene scene("walk.bvh", style, resolution, true);
  SimParams params;
  params.time_step = kFrame;
  std::vector<double> ours, plain, frame;
  TimedRun our_run, plain_run;
  const int plain_rounds = std::max(2, rounds / 2);
  for (int round = 0; round <= rounds; ++round) {
    our_run = scene.run(params, kWalk);
    if (round <= plain_rounds) plain_run = scene.run(params, kWalk, Method::kPlain);
    if (round == 0) continue;
    ours.push_back(our_run.total());
    frame.push_back(our_run.median());
    if (round <= plain_rounds) plain.push_back(plain_run.total());
  }
  const std::string who = formatted("%s, %d vertices", scene.name().c_str(), scene.mesh().vertexCount());
  const double frames = kWalk / kFrame;
  report.add(
      {"times faster than the plain implementation: " + who, medianOf(plain) / medianOf(ours), bounds.ratio, true, "",
       formatted("%.1f ms against %.3f ms a frame", 1e3 * medianOf(plain) / frames, 1e3 * medianOf(ours) / frames)});
  TrajectoryStage stage({name.c_str(), "walk.bvh", style, resolution, 1, true, false, kWalk});
  const Reference reference = referenceOf(stage, kReferenceRate, options.references);
  const double length = scene.mesh().hair_length;
  const int samples = comparableSamples(reference, our_run.trajectory, length);
  const double own = reference.ownErrorOver(samples);
  const double our_error = difference(our_run.trajectory, reference.trajectory, length, samples).rms;
  const double plain_error = difference(plain_run.trajectory, reference.trajectory, length, samples).rms;
  report.add({"error over the plain implementation's: " + who, our_error / plain_error, 1 + own / plain_error, false,
              "",
              formatted("%.2e and %.2e of the hair length over %.2f s; the reference's own %.1e", our_error,
                        plain_error, static_cast<double>(samples) / kSamplesPerSecond, own)});
  // How tight the plain implementation's tolerance must be for the simulator's error.
  SimParams tight = params;
  double tight_error = plain_error, tight_time = medianOf(plain);
  while (tight_error > our_error + own && tight.tolerance > kTightest) {
    tight.tolerance /= 10;
    plain_run = scene.run(tight, kWalk, Method::kPlain);
    tight_time = plain_run.total();
    tight_error = difference(plain_run.trajectory, reference.trajectory, length, samples).rms;
  }
  report.add(
      {"times faster than it at no larger error: " + who, tight_time / medianOf(ours), bounds.ratio, true, "",
       formatted("%.1f ms at tolerance %.0e, error %.2e", 1e3 * tight_time / frames, tight.tolerance, tight_error)});
  report.add({"milliseconds a frame: " + who, 1e3 * *std::min_element(frame.begin(), frame.end()), bounds.milliseconds,
              false, "ms", formatted("median of a walk's frames, least of %d walks", rounds)});
}

// Slope of log time over log vertices between the coarsest mesh of a style and the finest.
void growth(Style style, int rounds, Report& report) {
  std::vector<std::unique_ptr<TimedScene>> scenes;
  for (const Resolution resolution : {Resolution::kLow, Resolution::kUltra}) {
    scenes.push_back(std::make_unique<TimedScene>("walk.bvh", style, resolution, true));
  }
  SimParams params;
  params.time_step = kFrame;
  std::vector<double> slopes, fine, coarse;
  const double low = scenes[0]->mesh().vertexCount(), ultra = scenes[1]->mesh().vertexCount();
  for (int round = 0; round <= std::max(2, rounds / 2); ++round) {
    const double a = scenes[0]->run(params, kWalk).total(), b = scenes[1]->run(params, kWalk / 2).total() * 2;
    if (round == 0) continue;
    slopes.push_back(std::log(b / a) / std::log(ultra / low));
    coarse.push_back(a * kFrame / kWalk), fine.push_back(b * kFrame / kWalk);
  }
  report.add({formatted("exponent of growth from %.0f to %.0f vertices: %s", low, ultra,
                        std::string(app::styleName(style)).c_str()),
              medianOf(slopes), 1.15, false, "",
              formatted("%.2f to %.2f ms a frame", 1e3 * medianOf(coarse), 1e3 * medianOf(fine))});
}

void startUp(Style style, Report& report) {
  const StartUp fresh = measureStartUp(style, Resolution::kHigh);
  report.add(
      {formatted("start-up, parse, build, factor: %s high from file", std::string(app::styleName(style)).c_str()),
       fresh.parse + fresh.build + fresh.factor, 0.5, false, "s",
       formatted("%.3f + %.3f + %.3f s; a character and a style that are grown take %.3f s before", fresh.parse,
                 fresh.build, fresh.factor, fresh.character)});
}

// Frames while a slider moves a little every frame, against frames while none does.
void sliderDrag(Report& report) {
  TimedScene scene("walk.bvh", Style::kLong, Resolution::kHigh, true);
  for (const char* name : {"stretch_along", "bend", "volume", "density", "damping"}) {
    const DragTimes drag = measureDrag(scene, name);
    report.add({formatted("worst over median frame, dragging %s: %s", name, scene.name().c_str()),
                drag.worst / drag.still_median, kDragBound, false, "",
                formatted("worst %.1f ms, median %.1f ms; still: worst %.1f, median %.1f", 1e3 * drag.worst,
                          1e3 * drag.median, 1e3 * drag.still_worst, 1e3 * drag.still_median)});
  }
}

// The figures of speed alone.
void addSpeedFigures(const GateOptions& options, Report& report) {
  for (const Style style : {Style::kLong, Style::kShoulder}) {
    compareWithPlain(style, Resolution::kLow, {20, 0.3}, options, report);
    compareWithPlain(style, Resolution::kHigh, {10, 2.5}, options, report);
    growth(style, options.rounds, report);
    startUp(style, report);
  }
  sliderDrag(report);
  addBudgetFigures([&](const Figure& figure) { report.add(figure); });
}

}  // namespace

std::vector<Figure> measureFigures(const GateOptions& options) {
  Report report;
  const auto add = [&](const Figure& figure) { report.add(figure); };
  const auto asked = [&](const char* part) { return options.part.empty() || options.part == part; };
  if (asked("speed")) addSpeedFigures(options, report);
  if (asked("consistency")) addConsistencyFigures(add);
  if (asked("sweep")) addSweepFigures(options, add);
  if (asked("drawing")) addDrawingFigures(options, add);
  return std::move(report.figures);
}

void writeGateDocument(const std::vector<Figure>& figures, bool in_part, const std::string& folder) {
  Table table{{"figure", "value", "bound", "holds", "note"}, {}};
  const std::string kept = folder + "/data/gate.csv";
  if (in_part && std::filesystem::exists(kept)) table = tableOfCsv(app::readText(kept));
  for (const Figure& figure : figures) {
    std::vector<std::string> row{
        figure.name, formatted("%.3g%s%s", figure.value, figure.unit.empty() ? "" : " ", figure.unit.c_str()),
        formatted("%s %.3g", figure.at_least ? "at least" : "at most", figure.bound), figure.holds() ? "yes" : "**no**",
        figure.note};
    const auto same = std::ranges::find_if(table.rows, [&](const auto& old) { return old.front() == figure.name; });
    if (same == table.rows.end()) {
      table.rows.push_back(std::move(row));
    } else {
      *same = std::move(row);
    }
  }
  writeTable(folder, "gate", table);
  writeMeasuredPart(folder + "/gate.md", "figures", columns(table, {"figure", "value", "bound", "holds"}).markdown());
}

bool allHold(const std::vector<Figure>& figures) {
  const auto held = std::count_if(figures.begin(), figures.end(), [](const Figure& f) { return f.holds(); });
  std::printf("%d of %d figures hold\n", static_cast<int>(held), static_cast<int>(figures.size()));
  return held == static_cast<long>(figures.size());
}

int exitCodeOf(bool all_hold) {
  return all_hold ? app::kExitFine : app::kExitFault;
}

}  // namespace bench
