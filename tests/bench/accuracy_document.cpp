#include "tests/bench/accuracy_document.h"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <vector>

#include "app/files/errors.h"
#include "tests/bench/measured_part.h"
#include "tests/bench/sweep.h"
#include "tests/bench/table.h"

namespace bench {
namespace {

using Json = nlohmann::json;

std::string word(const Json& row, const char* key) {
  return row[key].get<std::string>();
}
double number(const Json& row, const char* key) {
  return row[key].get<double>();
}

// The values of `key`, each once, in the order in which they appear.
std::vector<std::string> namesIn(const Json& rows, const char* key) {
  std::vector<std::string> names;
  for (const Json& row : rows) {
    if (!std::count(names.begin(), names.end(), word(row, key))) names.push_back(word(row, key));
  }
  return names;
}

std::vector<Json> rowsOf(const Json& rows, const std::string& scene) {
  std::vector<Json> some;
  for (const Json& row : rows) {
    if (row["scene"] == scene) some.push_back(row);
  }
  return some;
}

const Json& defaultOf(const std::vector<Json>& rows) {
  return *std::find_if(rows.begin(), rows.end(), [](const Json& row) { return row["default"].get<bool>(); });
}

bool isPapers(const Json& row) {
  return row["solver"] == "paper";
}

std::string wayOf(const Json& row) {
  return word(row, "integrator") + (isPapers(row) ? ", as in the paper" : "") +
         (row["minimization"] ? "" : ", no minimization");
}

// An error that the reference is not good enough to rank is marked.
std::string errorOf(const Json& row) {
  return formatted("%s%.1e", row.value("ranked", true) ? "" : "~", number(row, "error_rms"));
}

std::string driftOf(const Json& row) {
  return row["energy_drift"].is_null() ? "-" : formatted("%+.3f", number(row, "energy_drift"));
}

Errors errorsOf(const Json& row) {
  return {number(row, "error_rms"), number(row, "error_max"), number(row, "worst_stretch"), number(row, "volume_error"),
          number(row, "penetration_m")};
}

// The fastest of the allowed configurations of a scene, and how many times faster it is than the default.
std::string fastestCells(const std::vector<Json>& rows, const auto& allowed) {
  const Json& standard = defaultOf(rows);
  const Json* fastest = &standard;
  for (const Json& row : rows) {
    if (allowed(row) && number(row, "ms_per_second_min") < number(*fastest, "ms_per_second_min")) fastest = &row;
  }
  const std::string name =
      fastest == &standard
          ? "the default"
          : formatted("%s 1/%.0f, %.0e, %s", wayOf(*fastest).c_str(), 1 / number(*fastest, "time_step"),
                      number(*fastest, "tolerance"), word(*fastest, "precision").c_str());
  return formatted(" %s | %.2f |", name.c_str(),
                   number(standard, "ms_per_second_min") / number(*fastest, "ms_per_second_min"));
}

// One line a scene: what is compared, how well the reference is known, where the default stands.
std::string summaryTable(const Json& rows) {
  std::string table =
      "| scene | compared | reference's own error | default: ms/s | RMS error | energy drift | fastest with no more "
      "of any error | times faster | by positions alone | times faster by positions "
      "|\n|---|---|---|---|---|---|---|---|---|---|\n";
  for (const std::string& scene : namesIn(rows, "scene")) {
    const std::vector<Json> some = rowsOf(rows, scene);
    const Json& standard = defaultOf(some);
    const double own = number(standard, "reference_error_rms");
    const Errors known = errorsOf(standard);
    table += formatted("| %s | %.2f of %.2f s | %.1e | %.1f | %s | %s |", scene.c_str(),
                       number(standard, "compared_seconds"), number(standard, "scene_seconds"), own,
                       number(standard, "ms_per_second_min"), errorOf(standard).c_str(), driftOf(standard).c_str());
    table += fastestCells(some, [&](const Json& row) { return errorsOf(row).noWorseInAny(known, own); });
    table += fastestCells(some, [&](const Json& row) { return errorsOf(row).noWorseInPosition(known, own); }) + "\n";
  }
  return table + "\n";
}

// The default's step in every solver's hands.
std::string solversOfSweep(const Json& rows) {
  const std::vector<std::string> scenes = namesIn(rows, "scene");
  std::string table = "| solver: ms/s (iterations; RMS error) |", rule = "|---|";
  for (const std::string& scene : scenes) table += " " + scene + " |", rule += "---|";
  table += "\n" + rule + "\n";
  for (const std::string& solver : namesIn(rows, "solver")) {
    table += "| " + (solver == "paper" ? "as in the paper, float" : solver) + " |";
    for (const std::string& scene : scenes) {
      const std::vector<Json> some = rowsOf(rows, scene);
      const Json& standard = defaultOf(some);
      const auto same = [&](const Json& row) {
        return row["solver"] == solver &&
               std::ranges::all_of(std::vector{"integrator", "precision", "tolerance", "time_step", "minimization"},
                                   [&](const auto* key) {
                                     return row[key] == standard[key] ||
                                            (isPapers(row) && key == std::string("precision"));
                                   });
      };
      const auto found = std::find_if(some.begin(), some.end(), same);
      table += found == some.end() ? " |"
                                   : formatted(" %.1f (%.1f; %s) |", number(*found, "ms_per_second_min"),
                                               number(*found, "iterations"), errorOf(*found).c_str());
    }
    table += "\n";
  }
  return table + "\n";
}

// The page shows where the default stands; all points are in pareto.csv, which the sweep itself writes.
std::string sweepPart(const std::string& folder, const Json& rows) {
  const Table summary = tableOf(summaryTable(rows));
  writeTable(folder, "accuracy_scenes", summary);
  writeTable(folder, "accuracy_solvers", tableOf(solversOfSweep(rows)));
  return columns(summary, {"scene", "compared", "reference's own error", "default: ms/s", "RMS error",
                           "fastest with no more of any error", "times faster"})
      .markdown();
}

std::string levelText(const Json& time, bool residual) {
  return formatted(residual ? "residual %.0e" : "%.0e m", number(time, "level"));
}

// Recorded systems: microseconds to a residual and to an error of position, all precisions.
Table solverTimes(const Json& rows) {
  Table table{{"scene", "vertices", "contacts", "solver", "precision", "from nothing", "set-up"}, {}};
  for (const bool residual : {true, false}) {
    for (const Json& time : rows.front()[residual ? "to_residual" : "to_displacement_error"])
      table.head.push_back(levelText(time, residual));
  }
  for (const Json& row : rows) {
    table.rows.push_back({word(row, "scene"), formatted("%.0f", number(row, "vertices")),
                          formatted("%.0f", number(row, "contacts")), word(row, "solver"), word(row, "precision"),
                          formatted("%.0f", number(row, "first_microseconds")),
                          formatted("%.1f", number(row, "set_up_microseconds"))});
    for (const char* key : {"to_residual", "to_displacement_error"}) {
      for (const Json& time : row[key]) {
        const bool reached = !time["microseconds"].is_null();
        table.rows.back().push_back(reached ? formatted("%.0f", number(time, "microseconds")) : "-");
      }
    }
  }
  return table;
}

// Each solver's least microseconds, over its precisions, to a residual of 1e-2; a column for each scene.
std::string solversPart(const std::string& folder, const Json& rows) {
  const Table times = solverTimes(rows);
  writeTable(folder, "solver_times", times);
  Table shown{{"solver"}, {}};
  for (const std::string& name : namesIn(rows, "solver")) shown.rows.push_back({name});
  for (const std::string& scene : namesIn(rows, "scene")) {
    const Table some = rowsWith(times, "scene", scene);
    shown.head.push_back(scene + ", " + some.rows.front()[1] + " vertices");
    for (auto& row : shown.rows) {
      std::string least = "-";
      const Table reached = columns(rowsWith(some, "solver", row.front()), {"residual 1e-02"});
      for (const auto& cell : reached.rows) {
        const double time = std::atof(cell.front().c_str());
        if (cell.front() != "-" && (least == "-" || time < std::atof(least.c_str()))) least = cell.front();
      }
      row.push_back(least);
    }
  }
  return shown.markdown();
}

// Outside peers beside the default.
std::string peersPart(const std::string& folder, const Json& rows) {
  std::string text =
      "| vertices | who | ms a frame | stretch along, mean | stretch along, worst | across, mean | across, worst | "
      "volume error, mean | volume error, worst | inverted | after a collapse | after the motion "
      "|\n|---|---|---|---|---|---|---|---|---|---|---|---|\n";
  for (const Json& row : rows) {
    text += formatted("| %.0f | %s | %.3f | %.4f | %.3f | %.4f | %.3f | %.4f | %.2f | %.0f | %.2e | %.2e |\n",
                      number(row, "vertices"), word(row, "who").c_str(), number(row, "ms_a_frame"),
                      number(row, "along_mean"), number(row, "along_max"), number(row, "across_mean"),
                      number(row, "across_max"), number(row, "volume_error_mean"), number(row, "volume_error_max"),
                      number(row, "inverted"), number(row, "after_collapse"), number(row, "after_motion"));
  }
  const Table table = tableOf(text);
  writeTable(folder, "peers", table);
  return columns(table, {"vertices", "who", "ms a frame", "stretch along, mean", "stretch along, worst",
                         "volume error, mean", "inverted", "after a collapse"})
      .markdown();
}

// A part is written anew where its measurement is at hand, and else stays as it is.
bool writePart(const std::string& folder, const char* name, const char* measurement,
               std::string (*tables)(const std::string& folder, const Json& rows)) {
  std::ifstream stream(dataFolder(folder) + "/" + measurement);
  const Json rows = Json::parse(stream, nullptr, false);
  if (!rows.is_array() || rows.empty()) return false;
  writeMeasuredPart(folder + "/accuracy.md", name, tables(folder, rows));
  return true;
}

}  // namespace

void writeAccuracyDocument(const std::string& folder) {
  const bool sweep = writePart(folder, "sweep", "pareto.json", sweepPart);
  const bool solvers = writePart(folder, "solvers", "solvers.json", solversPart);
  const bool peers = writePart(folder, "peers", "peers.json", peersPart);
  if (!sweep && !solvers && !peers) {
    throw app::InputError(folder, "", "holds no measurement",
                          "run hairmesh-bench --pareto, --solvers or --peers first");
  }
}

}  // namespace bench
