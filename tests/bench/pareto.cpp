#include "tests/bench/pareto.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/bench/gnuplot.h"
#include "tests/bench/sweep.h"
#include "tests/bench/written_files.h"

namespace bench {
namespace {

using sim::Integrator;
using sim::Solver;

Chart chartOf(const Sweep& sweep) {
  Chart chart{sweep.scene.name, "ms of one thread per simulated second", "RMS position error / hair length", {}};
  std::vector<const Point*> sorted;
  for (const Point& p : sweep.points) sorted.push_back(&p);
  std::ranges::sort(sorted, {}, &Point::fastest);
  const auto add = [&](const char* title, const char* style, auto&& chosen) {
    Series series{title, style, {}};
    for (const Point* p : sorted) {
      if (chosen(*p)) series.points.emplace_back(p->fastest, p->error.rms);
    }
    chart.series.push_back(std::move(series));
  };
  const auto grid = [](Integrator integrator) {
    return [integrator](const Point& p) {
      return p.params.integrator == integrator && p.params.solver == Solver::kDefault && p.params.minimize_deformation;
    };
  };
  add("linearized Euler (the paper''s step)", "points pt 4 ps 0.9", grid(Integrator::kLinearizedEuler));
  add("BDF2", "points pt 8 ps 0.9", grid(Integrator::kBdf2));
  add("the paper''s setting", "points pt 5 ps 1.2", [](const Point& p) { return p.params.solver == Solver::kPaper; });
  add("no minimization", "points pt 1 ps 0.9", [](const Point& p) { return !p.params.minimize_deformation; });
  add("front", "steps lw 2 lc rgb 'black'", [](const Point& p) { return p.on_front && p.ranked; });
  add("default", "points pt 3 ps 2.6 lw 2 lc rgb 'red'", [](const Point& p) { return p.is_default; });
  const double least = sorted.front()->fastest, most = sorted.back()->fastest, own = sweep.own_error;
  chart.series.push_back(
      {"the reference''s own error", "lines dt 2 lw 2 lc rgb 'gray40'", {{least, own}, {most, own}}});
  chart.series.push_back({"ten times it: nothing below is ranked",
                          "lines dt 3 lw 2 lc rgb 'gray70'",
                          {{least, 10 * own}, {most, 10 * own}}});
  return chart;
}

nlohmann::json toJson(const Sweep& sweep, const Point& p) {
  const auto choice = [&](const char* field) { return sim::paramText(*sim::findParam(field), p.params); };
  return {{"scene", sweep.scene.name},
          {"integrator", choice("integrator")},
          {"time_step", p.params.time_step},
          {"solver", choice("solver")},
          {"tolerance", p.params.tolerance},
          {"precision", choice("precision")},
          {"minimization", p.params.minimize_deformation},
          {"ms_per_second_min", p.fastest},
          {"ms_per_second_median", p.median},
          {"error_rms", p.error.rms},
          {"error_max", p.error.most},
          {"iterations", p.result.iterations},
          {"worst_stretch", p.result.worst_stretch},
          {"volume_error", p.result.volume_error},
          {"penetration_m", p.result.worst_penetration},
          {"energy_drift", p.energy_drift ? nlohmann::json(*p.energy_drift) : nlohmann::json()},
          {"recoveries", p.result.recoveries},
          {"default", p.is_default},
          {"front", p.on_front},
          {"ranked", p.ranked},
          {"reference_error_rms", sweep.own_error},
          {"reference_step", sweep.reference_step},
          {"compared_seconds", sweep.compared_seconds},
          {"scene_seconds", sweep.scene.seconds}};
}

void writeCsv(const std::string& file, const nlohmann::json& rows) {
  std::ostringstream csv;
  for (const nlohmann::json& row : rows) {
    if (&row == &rows.front()) {
      for (auto it = row.begin(); it != row.end(); ++it) csv << (it == row.begin() ? "" : ",") << it.key();
      csv << "\n";
    }
    for (auto it = row.begin(); it != row.end(); ++it) {
      if (it != row.begin()) csv << ",";
      if (!it.value().is_null()) csv << it.value();  // what there is not is an empty field
    }
    csv << "\n";
  }
  app::writeFile(file, csv.str());
}

void print(const Sweep& sweep) {
  std::printf("\n%s: reference BDF2 1/%.0f s; compared over %.2f of %.2f s, where its own error is %.1e\n",
              sweep.scene.name, 1 / sweep.reference_step, sweep.compared_seconds, sweep.scene.seconds, sweep.own_error);
  for (const Point& p : sweep.points) {
    if (!p.on_front && !p.is_default && p.params.solver != Solver::kPaper) continue;
    std::printf("%s %-64s %9.2f ms/s  rms %s%.2e max %.2e  %5.1f its\n", p.is_default ? "*" : " ", p.name().c_str(),
                p.fastest, p.ranked ? "" : "~", p.error.rms, p.error.most, p.result.iterations);
  }
  const auto showMessage = [](const char* what, const Lag& lag) {
    std::printf("  the fastest configuration with no more %s than the default is %.2f times faster: %s\n", what,
                lag.ratio, lag.configuration->name().c_str());
  };
  showMessage("of any error", lagOfDefault(sweep));
  showMessage("error of positions", lagByPosition(sweep));
  std::fflush(stdout);
}

}  // namespace

void runPareto(const ParetoOptions& options) {
  makeFolder(options.folder, "choose another with --out");
  nlohmann::json rows = nlohmann::json::array();
  for (const TrajectoryScene& scene : trajectoryScenes()) {
    const bool wanted = options.scenes.empty() || std::count(options.scenes.begin(), options.scenes.end(), scene.name);
    if (!wanted) continue;
    TrajectoryStage stage(scene);
    const Reference reference = referenceOf(stage, kReferenceRate, options.references);
    const bool large = scene.resolution == app::Resolution::kHigh;
    const SweepSize size = options.quick || large ? SweepSize::kQuick : SweepSize::kFull;
    const Sweep sweep = sweepScene(stage, reference, configurationsToRun(size, scene.collide), options.runs);
    for (const Point& p : sweep.points) rows.push_back(toJson(sweep, p));
    print(sweep);
    // After each scene: a sweep cut short leaves what it has measured.
    writeCsv(options.folder + "/pareto.csv", rows);
    app::writeFile(options.folder + "/pareto.json", rows.dump(1) + "\n");
    drawChart(options.folder, std::string("accuracy_") + scene.name, chartOf(sweep));
  }
}

}  // namespace bench
