#include "tests/bench/accuracy_document.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <vector>

#include "app/errors.h"
#include "tests/bench/measured_part.h"
#include "tests/bench/sweep.h"

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
  const std::string solver = word(row, "solver");
  return word(row, "integrator") + (solver == "warped" ? "" : ", " + (isPapers(row) ? "as in the paper" : solver)) +
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

// The fastest of the allowed ways of a scene, and how many times faster it is than the default.
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
      "of any error | times faster | by positions alone | times faster |\n|---|---|---|---|---|---|---|---|---|---|\n";
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

// The front of a scene, its default and the paper's setting.
std::string frontTable(const std::string& scene, const std::vector<Json>& rows) {
  std::vector<Json> shown;
  std::copy_if(rows.begin(), rows.end(), std::back_inserter(shown),
               [](const Json& row) { return row["front"].get<bool>() || row["default"].get<bool>() || isPapers(row); });
  std::sort(shown.begin(), shown.end(), [](const Json& a, const Json& b) {
    return number(a, "ms_per_second_min") < number(b, "ms_per_second_min");
  });
  std::string table = "### " + scene + "\n\n![" + scene + "](accuracy_" + scene + ".svg)\n\n";
  table +=
      "| | way | step | tolerance | precision | ms/s, least | median | RMS error | largest | iterations | stretch | "
      "volume "
      "| penetration, mm | energy drift |\n|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n";
  for (const Json& row : shown) {
    table += formatted("| %s | %s | 1/%.0f | %.0e | %s | %.1f | %.1f | %s | %.1e | %.1f | %.3f | %.3f | %.2f | %s |\n",
                       row["default"] ? "**default**" : (isPapers(row) ? "the paper's" : ""), wayOf(row).c_str(),
                       1 / number(row, "time_step"), number(row, "tolerance"), word(row, "precision").c_str(),
                       number(row, "ms_per_second_min"), number(row, "ms_per_second_median"), errorOf(row).c_str(),
                       number(row, "error_max"), number(row, "iterations"), number(row, "worst_stretch"),
                       number(row, "volume_error"), 1e3 * number(row, "penetration_m"), driftOf(row).c_str());
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

std::string sweepPart(const Json& rows) {
  std::string part = summaryTable(rows);
  for (const std::string& scene : namesIn(rows, "scene")) part += frontTable(scene, rowsOf(rows, scene));
  return part + "### The default's step in every solver's hands\n\n" + solversOfSweep(rows);
}

// Recorded systems: microseconds to a residual.
std::string solversPart(const Json& rows) {
  std::string part;
  for (const std::string& scene : namesIn(rows, "scene")) {
    const std::vector<Json> some = rowsOf(rows, scene);
    part += formatted("### %s: %.0f vertices, up to %.0f contacts\n\n![%s](solvers_%s.svg)\n\n", scene.c_str(),
                      number(some.front(), "vertices"), number(some.front(), "contacts"), scene.c_str(), scene.c_str());
    part += "| solver | precision | from nothing | set-up |";
    std::string rule = "|---|---|---|---|";
    for (const char* key : {"to_residual", "to_displacement_error"}) {
      for (const Json& time : some.front()[key]) {
        part += formatted(key == std::string("to_residual") ? " residual %.0e |" : " %.0e m |", number(time, "level"));
        rule += "---|";
      }
    }
    part += "\n" + rule + "\n";
    for (const Json& row : some) {
      part += formatted("| %s | %s | %.0f | %.1f |", word(row, "solver").c_str(), word(row, "precision").c_str(),
                        number(row, "first_microseconds"), number(row, "set_up_microseconds"));
      for (const char* key : {"to_residual", "to_displacement_error"}) {
        for (const Json& time : row[key]) {
          part += time["microseconds"].is_null() ? " - |" : formatted(" %.0f |", number(time, "microseconds"));
        }
      }
      part += "\n";
    }
    part += "\n";
  }
  return part;
}

// Outside peers beside the default.
std::string peersPart(const Json& rows) {
  std::string part;
  for (const std::string& scene : namesIn(rows, "scene")) {
    const std::vector<Json> some = rowsOf(rows, scene);
    part += formatted("### %s: %.0f vertices\n\n", scene.c_str(), number(some.front(), "vertices"));
    part +=
        "| who | ms a frame | stretch along, mean | worst | across, mean | worst | volume error, mean | worst | "
        "inverted | after a collapse | after the motion |\n|---|---|---|---|---|---|---|---|---|---|---|\n";
    for (const Json& row : some) {
      part += formatted("| %s | %.3f | %.4f | %.3f | %.4f | %.3f | %.4f | %.2f | %.0f | %.2e | %.2e |\n",
                        word(row, "who").c_str(), number(row, "ms_a_frame"), number(row, "along_mean"),
                        number(row, "along_max"), number(row, "across_mean"), number(row, "across_max"),
                        number(row, "volume_error_mean"), number(row, "volume_error_max"), number(row, "inverted"),
                        number(row, "after_collapse"), number(row, "after_motion"));
    }
    part += "\n";
  }
  return part;
}

// A part is written anew where its measurement is at hand, and else stays as it is.
bool writePart(const std::string& folder, const char* name, const char* measurement,
               std::string (*tables)(const Json& rows)) {
  std::ifstream stream(folder + "/" + measurement);
  const Json rows = Json::parse(stream, nullptr, false);
  if (!rows.is_array() || rows.empty()) return false;
  writeMeasuredPart(folder + "/accuracy.md", name, tables(rows));
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
