#include "tests/bench/solver_chart.h"

#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <span>
#include <sstream>

#include "tests/bench/gnuplot.h"
#include "tests/bench/own_solvers.h"
#include "tests/bench/written_files.h"

namespace bench {
namespace {

struct RecordedScene {
  const char* scene;
  std::vector<int> steps;
};

// Steps of 1/60 s in the middle of the motion.
const std::vector<RecordedScene> kScenes{
    {"head_shake", {15, 30, 45}}, {"walk_high", {5, 10, 15}}, {"jump_10x", {4, 9, 14}}};

// One solver's residual and cost after so many iterations: geometric means over a scene's systems.
struct MeanRung {
  int iterations = 0;
  double microseconds = 0, residual = 0, displacement = 0;
};
struct MeanRun {
  std::string solver, precision;
  double first = 0, set_up = 0;  // microseconds
  std::vector<MeanRung> rungs;
  std::string title() const { return solver + ", " + precision; }
};

MeanRun meanOf(const RecordedMesh& shared, const std::vector<LinearRecord>& records,
               const std::vector<SolverRun>& runs) {
  MeanRun mean{runs.front().solver, runs.front().precision, 0, 0, {}};
  std::size_t rungs = runs.front().rungs.size();
  for (const SolverRun& run : runs) {
    mean.first += run.first_microseconds / static_cast<double>(runs.size());
    mean.set_up += run.set_up_microseconds / static_cast<double>(runs.size());
    rungs = std::min(rungs, run.rungs.size());
  }
  for (std::size_t k = 0; k < rungs; ++k) {
    double time = 0, residual = 0, displacement = 0;
    for (std::size_t s = 0; s < runs.size(); ++s) {
      const SolverRung& rung = runs[s].rungs[k];
      time += std::log(std::max(rung.microseconds, 0.01));
      residual += std::log(std::max(relativeResidual(shared, records[s], rung.x), 1e-16));
      displacement += std::log(std::max(displacementError(shared, records[s], rung.x), 1e-16));
    }
    const double count = static_cast<double>(runs.size());
    mean.rungs.push_back({runs.front().rungs[k].iterations, std::exp(time / count), std::exp(residual / count),
                          std::exp(displacement / count)});
  }
  return mean;
}

// Microseconds, set-up included, until the measure has fallen to `level` for good, between rungs as a straight line in
// its logarithm; NaN where it does not get there.
double timeTo(const MeanRun& run, double MeanRung::*measure, double level) {
  std::size_t after = 0;  // the rung from which it stays below
  for (std::size_t k = 0; k < run.rungs.size(); ++k) {
    if (run.rungs[k].*measure > level) after = k + 1;
  }
  if (after == run.rungs.size()) return std::nan("");
  const MeanRung& b = run.rungs[after];
  if (after == 0) return run.set_up + b.microseconds;
  const MeanRung& a = run.rungs[after - 1];
  const double share = std::log(a.*measure / level) / std::log(a.*measure / (b.*measure));
  return run.set_up + a.microseconds + share * (b.microseconds - a.microseconds);
}

constexpr double kResiduals[] = {1e-1, 1e-2, 1e-4, 1e-8};
constexpr double kDisplacements[] = {1e-4, 1e-5, 1e-6};  // m

nlohmann::json timesTo(const MeanRun& run, double MeanRung::*measure, std::span<const double> levels) {
  nlohmann::json times = nlohmann::json::array();
  for (const double level : levels) {
    const double time = timeTo(run, measure, level);
    times.push_back(
        {{"level", level}, {"microseconds", std::isfinite(time) ? nlohmann::json(time) : nlohmann::json()}});
  }
  return times;
}

nlohmann::json toJson(const std::string& scene, const RecordedSystems& systems, const MeanRun& run) {
  nlohmann::json rungs = nlohmann::json::array();
  for (const MeanRung& rung : run.rungs) {
    rungs.push_back({{"iterations", rung.iterations},
                     {"microseconds", rung.microseconds},
                     {"residual", rung.residual},
                     {"displacement_error_m", rung.displacement}});
  }
  std::size_t contacts = 0;
  for (const LinearRecord& record : systems.records) contacts = std::max(contacts, record.constraints.size());
  return {{"scene", scene},
          {"vertices", systems.shared->mesh.vertexCount()},
          {"contacts", contacts},
          {"solver", run.solver},
          {"precision", run.precision},
          {"first_microseconds", run.first},
          {"set_up_microseconds", run.set_up},
          {"to_residual", timesTo(run, &MeanRung::residual, kResiduals)},
          {"to_displacement_error", timesTo(run, &MeanRung::displacement, kDisplacements)},
          {"rungs", rungs}};
}

// The curves of a chart: every preconditioner in single precision, the direct factor in double as well, and the
// libraries'.
bool isDrawn(const MeanRun& run) {
  const bool of_library = run.solver.find(' ') != std::string::npos;
  return of_library || run.precision == "float" || run.solver == "direct";
}

// The default is drawn bold.
Chart chartOf(const std::string& scene, const std::vector<MeanRun>& runs) {
  Chart chart{scene + ": one linear system, set-up included",
              "microseconds of one thread",
              "residual / warm start''s residual",
              {}};
  for (const MeanRun& run : runs) {
    if (!isDrawn(run)) continue;
    const bool default_solver = run.solver == nameOf(Kind::kTwoLevel) && run.precision == "float";
    const bool direct = run.rungs.size() < 3;
    Series series{run.title(), default_solver ? "linespoints lw 3 lc rgb 'black'" : "linespoints", {}};
    if (direct) series.style = "points pt 3 ps 1.6 lw 2";
    for (const MeanRung& rung : run.rungs) {
      if (direct && rung.iterations == 0) continue;
      series.points.emplace_back(run.set_up + rung.microseconds, rung.residual);
    }
    chart.series.push_back(std::move(series));
  }
  return chart;
}

void writeRungs(const std::string& file, const nlohmann::json& rows) {
  std::ostringstream csv;
  csv << "scene,vertices,contacts,solver,precision,first_us,set_up_us,iterations,solve_us,residual,displacement_m\n";
  for (const nlohmann::json& row : rows) {
    for (const nlohmann::json& rung : row["rungs"]) {
      csv << row["scene"] << "," << row["vertices"] << "," << row["contacts"] << "," << row["solver"] << ","
          << row["precision"] << "," << row["first_microseconds"] << "," << row["set_up_microseconds"] << ","
          << rung["iterations"] << "," << rung["microseconds"] << "," << rung["residual"] << ","
          << rung["displacement_error_m"] << "\n";
    }
  }
  app::writeFile(file, csv.str());
}

void printRun(const MeanRun& run) {
  std::printf("  %-32s first %7.0f  set-up %7.1f us;", run.title().c_str(), run.first, run.set_up);
  for (const double level : kResiduals) std::printf(" %.0e: %6.0f", level, timeTo(run, &MeanRung::residual, level));
  for (const double level : kDisplacements) {
    std::printf(" %.0e m: %6.0f", level, timeTo(run, &MeanRung::displacement, level));
  }
  std::printf("\n");
  std::fflush(stdout);
}

std::vector<MeanRun> runAll(const RecordedSystems& systems) {
  const RecordedMesh& shared = *systems.shared;
  std::vector<MeanRun> means;
  const auto keep = [&](const std::vector<SolverRun>& runs) {
    means.push_back(meanOf(shared, systems.records, runs));
    printRun(means.back());
  };
  for (int kind = 0; kind < static_cast<int>(Kind::kCount); ++kind) {
    for (const sim::Precision precision : {sim::Precision::kFloat, sim::Precision::kDouble}) {
      std::vector<SolverRun> runs;
      for (const LinearRecord& record : systems.records)
        runs.push_back(runOwnSolver(shared, record, static_cast<Kind>(kind), precision));
      keep(runs);
    }
  }
  std::vector<std::vector<SolverRun>> by_record;
  for (const LinearRecord& record : systems.records) by_record.push_back(runLibrarySolvers(shared, record));
  for (std::size_t k = 0; k < by_record.front().size(); ++k) {
    std::vector<SolverRun> runs;
    for (auto& of_record : by_record) runs.push_back(std::move(of_record[k]));
    keep(runs);
  }
  return means;
}

}  // namespace

void runSolverChart(const SolverChartOptions& options) {
  makeFolder(options.folder, "choose another with --out");
  nlohmann::json rows = nlohmann::json::array();
  for (const RecordedScene& scene : kScenes) {
    const RecordedSystems systems = recordSystems(scene.scene, scene.steps);
    std::printf("\n%s: %zu systems of %d vertices\n", scene.scene, systems.records.size(),
                systems.shared->mesh.vertexCount());
    const std::vector<MeanRun> runs = runAll(systems);
    for (const MeanRun& run : runs) rows.push_back(toJson(scene.scene, systems, run));
    drawChart(options.folder, std::string("solvers_") + scene.scene, chartOf(scene.scene, runs));
  }
  writeRungs(options.folder + "/solvers.csv", rows);
  app::writeFile(options.folder + "/solvers.json", rows.dump(1) + "\n");
}

}  // namespace bench
