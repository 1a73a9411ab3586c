#include "tests/bench/pareto.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "app/errors.h"
#include "tests/bench/trajectory.h"

namespace bench {
namespace {

using sim::Integrator;
using sim::Precision;
using sim::SimParams;
using sim::Solver;

constexpr double kReferenceStep = 1.0 / 3840;

std::string choiceName(const char* field, const SimParams& params) {
  return sim::paramText(*sim::findParam(field), params);
}

struct Point {
  SimParams params;
  RunResult result;  // of the last run; the trajectory is dropped
  TrajectoryError error;
  double fastest = 0, median = 0;  // ms of CPU time a simulated second
  bool is_default = false, on_front = false;

  std::string name() const {
    char text[160];
    std::snprintf(text, sizeof text, "%s 1/%.0f %s tol %.0e %s%s", choiceName("integrator", params).c_str(),
                  1 / params.time_step, choiceName("solver", params).c_str(), params.tolerance,
                  choiceName("precision", params).c_str(), params.minimize_deformation ? "" : " no minimization");
    return text;
  }
};

// The full grid of integrator, step and tolerance with the default solver; then, at the default step, every solver,
// every precision and minimization off, each alone. What is left out: solvers at other steps and integrators, whose
// solutions are the same to the tolerance, so that only their time differs, by about the ratio seen here.
std::vector<SimParams> waysToRun(bool quick) {
  std::vector<SimParams> ways{SimParams{}};
  const auto steps = quick ? std::vector<double>{30, 60, 120, 240} : std::vector<double>{30, 60, 120, 240, 480, 960};
  const auto tolerances =
      quick ? std::vector<double>{1e-1, 1e-2, 1e-3} : std::vector<double>{1e-1, 3e-2, 1e-2, 1e-3, 1e-4, 1e-6};
  for (const Integrator integrator : {Integrator::kLinearizedEuler, Integrator::kImplicitEuler, Integrator::kBdf2}) {
    for (const double rate : steps) {
      for (const double tolerance : tolerances) {
        SimParams params;
        params.integrator = integrator;
        params.time_step = 1 / rate;
        params.tolerance = tolerance;
        if (tolerance < 1e-5) params.precision = Precision::kDouble;
        ways.push_back(params);
      }
    }
  }
  for (int solver = 0; solver < static_cast<int>(Solver::kCount); ++solver) {
    SimParams params;
    params.solver = static_cast<Solver>(solver);
    params.max_iterations = 2000;
    ways.push_back(params);
  }
  for (int precision = 0; precision < static_cast<int>(Precision::kCount); ++precision) {
    SimParams params;
    params.precision = static_cast<Precision>(precision);
    ways.push_back(params);
  }
  SimParams plain;
  plain.minimize_deformation = false;
  ways.push_back(plain);
  return ways;
}

Trajectory referenceAt(TrajectoryStage& stage, double step) {
  SimParams params;
  params.integrator = Integrator::kBdf2;
  params.time_step = step;
  params.precision = Precision::kDouble;
  params.tolerance = 1e-11;
  params.acceleration_tolerance = 0;
  params.newton_iterations = 8;
  params.newton_tolerance = 1e-9;
  return stage.run(params).trajectory;
}

Point measurePoint(TrajectoryStage& stage, const SimParams& params, const Trajectory& reference, double seconds,
                   int runs) {
  Point point;
  point.params = params;
  std::vector<double> times;
  for (int k = 0; k <= runs; ++k) {
    point.result = stage.run(params);
    if (k > 0) times.push_back(1e3 * point.result.seconds / seconds);
  }
  std::sort(times.begin(), times.end());
  point.fastest = times.front();
  point.median = times[times.size() / 2];
  point.error = difference(point.result.trajectory, reference, stage.mesh().hair_length);
  point.result.trajectory.clear();
  return point;
}

// A point is on the front when none is both faster and nearer the truth.
void markFront(std::vector<Point>& points) {
  for (Point& p : points) {
    p.on_front = std::none_of(points.begin(), points.end(),
                              [&](const Point& q) { return q.fastest < p.fastest && q.error.rms <= p.error.rms; });
  }
}

// How many times the fastest way with no more error is faster than the default.
double lagOfDefault(const std::vector<Point>& points) {
  double lag = 1;
  for (const Point& q : points) {
    if (q.error.rms <= points.front().error.rms) lag = std::max(lag, points.front().fastest / q.fastest);
  }
  return lag;
}

void writePlot(const std::string& folder, const std::string& scene, const std::vector<Point>& points) {
  const std::string data = folder + "/accuracy_" + scene + ".dat";
  std::ofstream file(data);
  const auto block = [&](const char* title, auto&& chosen) {
    file << "\n\n\"" << title << "\"\n";
    std::vector<const Point*> some;
    for (const Point& p : points) {
      if (chosen(p)) some.push_back(&p);
    }
    std::sort(some.begin(), some.end(), [](auto* a, auto* b) { return a->fastest < b->fastest; });
    for (const Point* p : some) file << p->fastest << " " << p->error.rms << "\n";
    if (some.empty()) file << "1 NaN\n";
  };
  const auto grid = [](Integrator integrator) {
    return [integrator](const Point& p) {
      return p.params.integrator == integrator && p.params.solver == Solver::kWarped && p.params.minimize_deformation;
    };
  };
  block("linearized Euler (the paper's step)", grid(Integrator::kLinearizedEuler));
  block("implicit Euler", grid(Integrator::kImplicitEuler));
  block("BDF2", grid(Integrator::kBdf2));
  block("other solvers", [](const Point& p) { return p.params.solver != Solver::kWarped; });
  block("front", [](const Point& p) { return p.on_front; });
  block("default", [](const Point& p) { return p.is_default; });
  file.close();
  for (const char* kind : {"svg", "png"}) {
    const std::string script = folder + "/accuracy_" + scene + ".gp";
    std::ofstream gp(script);
    gp << "set terminal "
       << (std::string(kind) == "svg" ? "svg size 860,560 background rgb 'white'" : "pngcairo size 860,560")
       << " font 'Sans,11'\nset output '" << folder << "/accuracy_" << scene << "." << kind << "'\n"
       << "set logscale xy\nset format y '10^{%L}'\nset grid\nset key outside right\n"
       << "set title '" << scene << "' noenhanced\n"
       << "set xlabel 'ms of one thread per simulated second'\nset ylabel 'RMS position error / hair length'\n"
       << "plot for [i=0:3] '" << data << "' index i using 1:2 with points pt i+4 ps 0.9 title columnheader(1), \\\n"
       << "  '" << data << "' index 4 using 1:2 with steps lw 2 lc rgb 'black' title 'front', \\\n"
       << "  '" << data << "' index 5 using 1:2 with points pt 3 ps 2.6 lw 2 lc rgb 'red' title 'default'\n";
    gp.close();
    if (std::system(("gnuplot '" + script + "'").c_str()) != 0) {
      std::printf("no %s of %s: gnuplot is not installed or failed\n", kind, scene.c_str());
    }
    std::filesystem::remove(script);
  }
  std::filesystem::remove(data);
}

nlohmann::json toJson(const std::string& scene, const Point& p) {
  return {{"scene", scene},
          {"integrator", choiceName("integrator", p.params)},
          {"time_step", p.params.time_step},
          {"solver", choiceName("solver", p.params)},
          {"tolerance", p.params.tolerance},
          {"precision", choiceName("precision", p.params)},
          {"minimization", p.params.minimize_deformation},
          {"ms_per_second_min", p.fastest},
          {"ms_per_second_median", p.median},
          {"error_rms", p.error.rms},
          {"error_max", p.error.most},
          {"iterations", p.result.iterations},
          {"worst_stretch", p.result.worst_stretch},
          {"volume_error", p.result.volume_error},
          {"penetration_m", p.result.worst_penetration},
          {"recoveries", p.result.recoveries},
          {"default", p.is_default},
          {"front", p.on_front}};
}

constexpr const char* kRegionStart = "<!-- measured by hairmesh-bench -->";
constexpr const char* kRegionEnd = "<!-- end of the measured part -->";

// The front of a scene and its default as a Markdown table.
std::string tableOf(const nlohmann::json& rows, const std::string& scene) {
  std::vector<nlohmann::json> shown;
  double reference = 0;
  for (const nlohmann::json& row : rows) {
    if (row["scene"] != scene) continue;
    reference = row["reference_error_rms"];
    if (row["front"] || row["default"]) shown.push_back(row);
  }
  std::sort(shown.begin(), shown.end(),
            [](const auto& a, const auto& b) { return a["ms_per_second_min"] < b["ms_per_second_min"]; });
  char text[320];
  std::snprintf(text, sizeof text, "### %s\n\nThe reference's own error: %.1e.\n\n", scene.c_str(), reference);
  std::string table = text;
  table += "![" + scene + "](accuracy_" + scene + ".svg)\n\n";
  table +=
      "| | integrator | step | tolerance | precision | ms/s | RMS error | largest | iterations | stretch | volume |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|\n";
  const auto word = [](const nlohmann::json& row, const char* key) { return row[key].get<std::string>(); };
  const auto number = [](const nlohmann::json& row, const char* key) { return row[key].get<double>(); };
  for (const nlohmann::json& row : shown) {
    std::snprintf(text, sizeof text, "| %s | %s%s%s | 1/%.0f | %.0e | %s | %.1f | %.1e | %.1e | %.1f | %.3f | %.3f |\n",
                  row["default"] ? "**default**" : "", word(row, "integrator").c_str(),
                  word(row, "solver") == "warped" ? "" : (", " + word(row, "solver")).c_str(),
                  row["minimization"] ? "" : ", no minimization", 1 / number(row, "time_step"),
                  number(row, "tolerance"), word(row, "precision").c_str(), number(row, "ms_per_second_min"),
                  number(row, "error_rms"), number(row, "error_max"), number(row, "iterations"),
                  number(row, "worst_stretch"), number(row, "volume_error"));
    table += text;
  }
  return table + "\n";
}

// The default's step in every solver's hands.
std::string solverTable(const nlohmann::json& rows) {
  const SimParams standard;
  std::vector<std::string> scenes, solvers;
  std::string table = "| solver: ms/s (iterations; RMS error) |";
  const auto remember = [](std::vector<std::string>& list, const std::string& name) {
    if (!std::count(list.begin(), list.end(), name)) list.push_back(name);
  };
  for (const nlohmann::json& row : rows) {
    remember(scenes, row["scene"]);
    remember(solvers, row["solver"]);
  }
  for (const std::string& scene : scenes) table += " " + scene + " |";
  table += "\n|---|";
  for (std::size_t k = 0; k < scenes.size(); ++k) table += "---|";
  table += "\n";
  for (const std::string& solver : solvers) {
    table += "| " + solver + " |";
    for (const std::string& scene : scenes) {
      char text[64] = " |";
      for (const nlohmann::json& row : rows) {
        const bool same = row["scene"] == scene && row["solver"] == solver && row["minimization"] &&
                          row["integrator"] == choiceName("integrator", standard) &&
                          row["precision"] == choiceName("precision", standard) &&
                          row["tolerance"] == standard.tolerance && row["time_step"] == standard.time_step;
        if (!same) continue;
        std::snprintf(text, sizeof text, " %.1f (%.1f; %.1e) |", row["ms_per_second_min"].get<double>(),
                      row["iterations"].get<double>(), row["error_rms"].get<double>());
        break;
      }
      table += text;
    }
    table += "\n";
  }
  return table;
}

}  // namespace

void writeAccuracyDocument(const std::string& folder) {
  const std::string file = folder + "/accuracy.md", data = folder + "/pareto.json";
  std::ifstream json_stream(data), stream(file);
  const nlohmann::json rows = nlohmann::json::parse(json_stream, nullptr, false);
  if (!rows.is_array()) throw app::InputError(data, "", "holds no sweep", "run hairmesh-bench --pareto first");
  const std::string text((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
  const auto start = text.find(kRegionStart), end = text.find(kRegionEnd);
  if (start == std::string::npos || end == std::string::npos || end < start) {
    throw app::InputError(file, "", "lacks the marks of the measured part", "restore it from the repository");
  }
  std::string measured = std::string(kRegionStart) + "\n\n";
  std::vector<std::string> scenes;
  for (const nlohmann::json& row : rows) {
    const std::string scene = row["scene"];
    if (std::count(scenes.begin(), scenes.end(), scene)) continue;
    scenes.push_back(scene);
    measured += tableOf(rows, scene);
  }
  measured += "### Solvers\n\n" + solverTable(rows) + "\n";
  std::ofstream(file) << text.substr(0, start) + measured + text.substr(end);
}

void runPareto(const ParetoOptions& options) {
  std::error_code fault;
  std::filesystem::create_directories(options.folder, fault);
  std::ofstream csv(options.folder + "/pareto.csv");
  if (!csv) throw app::InputError(options.folder, "", "cannot be written", "choose another folder with --out");
  nlohmann::json all = nlohmann::json::array();
  bool headed = false;
  for (const TrajectoryScene& scene : trajectoryScenes()) {
    const bool wanted = options.scenes.empty() || std::count(options.scenes.begin(), options.scenes.end(), scene.name);
    if (!wanted) continue;
    TrajectoryStage stage(scene);
    // The reference of the large mesh is coarser: its steps cost ten times as much.
    const double step = scene.resolution == sim::Resolution::kLow ? kReferenceStep : 4 * kReferenceStep;
    const Trajectory reference = referenceAt(stage, step);
    const TrajectoryError own = difference(referenceAt(stage, 2 * step), reference, stage.mesh().hair_length);
    std::printf("\n%s: reference BDF2 1/%.0f s, against the same at twice the step: rms %.1e, most %.1e\n", scene.name,
                1 / step, own.rms, own.most);
    std::vector<Point> points;
    for (const SimParams& way : waysToRun(options.quick || scene.resolution == sim::Resolution::kHigh)) {
      points.push_back(measurePoint(stage, way, reference, scene.seconds, options.runs));
    }
    points.front().is_default = true;
    markFront(points);
    for (const Point& p : points) {
      nlohmann::json row = toJson(scene.name, p);
      row["reference_error_rms"] = own.rms;
      if (!headed) {
        for (auto it = row.begin(); it != row.end(); ++it) csv << (it == row.begin() ? "" : ",") << it.key();
        csv << "\n";
        headed = true;
      }
      for (auto it = row.begin(); it != row.end(); ++it) csv << (it == row.begin() ? "" : ",") << it.value();
      csv << "\n";
      if (p.on_front || p.is_default) {
        std::printf("%s %-64s %9.2f ms/s  rms %.2e max %.2e  %5.1f its\n", p.is_default ? "*" : " ", p.name().c_str(),
                    p.fastest, p.error.rms, p.error.most, p.result.iterations);
      }
      all.push_back(std::move(row));
    }
    std::printf("  the fastest way with no more error than the default is %.2f times faster\n", lagOfDefault(points));
    std::fflush(stdout);
    writePlot(options.folder, scene.name, points);
  }
  std::ofstream(options.folder + "/pareto.json") << all.dump(1) << "\n";
}

}  // namespace bench
