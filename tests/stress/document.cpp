#include "tests/stress/document.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>

#include "app/files/output_file.h"
#include "tests/bench/measured_part.h"
#include "tests/bench/table.h"
#include "tests/bench/written_files.h"
#include "tests/stress/family_text.h"
#include "tests/stress/heat_map.h"
#include "tests/stress/matrix.h"

namespace stress {
namespace {

using bench::Table;

struct FamilyCount {
  std::vector<const StressCase*> members;  // that were run
  long passed = 0, failed = 0, with_body = 0, inside = 0, unconstrained = 0, carried = 0, guided = 0, recoveries = 0;
  double slowest = 0, deepest = 0, energy_rise = 0, energy_step = 0;
};

std::vector<FamilyCount> countFamilies(const std::vector<Result>& results) {
  std::vector<FamilyCount> families;
  for (const Result& result : results) {
    const StressCase& one = result.one;
    const Outcome& o = result.outcome;
    if (!counts(one) || o.verdict == Verdict::kSkipped) continue;
    auto known = std::find_if(families.begin(), families.end(), [&](const FamilyCount& family) {
      return family.members.front()->family() == one.family();
    });
    if (known == families.end()) {
      families.emplace_back();
      known = families.end() - 1;
    }
    known->members.push_back(&one);
    ++(o.verdict == Verdict::kPassed ? known->passed : known->failed);
    known->with_body += o.with_body;
    known->inside += o.inside;
    known->unconstrained += o.unconstrained;
    known->carried += o.carried;
    known->guided += o.guided > 0;
    known->recoveries += o.recoveries;
    known->slowest = std::max(known->slowest, o.back_after);
    known->deepest = std::max(known->deepest, o.deepest);
    known->energy_rise = std::max(known->energy_rise, o.energy_rise);
    known->energy_step = std::max(known->energy_step, o.energy_step);
  }
  return families;
}

Table familyTable(const std::vector<FamilyCount>& families) {
  Table table{{"family", "what varies", "hair", "cases", "passed", "failed", "back on the body", "slowest return, s",
               "deepest, mm", "inside", "unconstrained", "energy above what was left", "largest step up", "teleported",
               "guided", "recoveries"},
              {}};
  for (const FamilyCount& f : families) {
    table.rows.push_back({f.members.front()->family(), familyText(f.members), hairText(f.members),
                          bench::formatted("%zu", f.members.size()), bench::formatted("%ld", f.passed),
                          bench::formatted("%ld", f.failed), bench::formatted("%ld", f.with_body),
                          bench::formatted("%.2f", f.slowest), bench::formatted("%.3f", 1e3 * f.deepest),
                          bench::formatted("%ld", f.inside), bench::formatted("%ld", f.unconstrained),
                          bench::formatted("%.1e", f.energy_rise), bench::formatted("%.1e", f.energy_step),
                          bench::formatted("%ld", f.carried), bench::formatted("%ld", f.guided),
                          bench::formatted("%ld", f.recoveries)});
  }
  return table;
}

std::string verdictText(const Outcome& o) {
  if (o.verdict == Verdict::kSkipped) return "not run";
  if (o.verdict == Verdict::kFailed) return o.fault;
  return bench::formatted("back after %.2f s", o.back_after);
}

const Result* resultOf(const std::string& name, const std::vector<Result>& results) {
  const auto found = std::find_if(results.begin(), results.end(), [&](const Result& r) { return r.one.name == name; });
  return found == results.end() ? nullptr : &*found;
}

// How many pairs of each claim did not return.
using Shortfalls = std::map<std::string, int>;

// "5: collapse 2, shuffled 3".
std::string shortText(const Shortfalls& claims) {
  std::string text;
  int count = 0;
  for (const auto& [claim, pairs] : claims) {
    text += bench::formatted("%s%s %d", text.empty() ? "" : ", ", claim.c_str(), pairs);
    count += pairs;
  }
  return claims.empty() ? "none" : bench::formatted("%d: ", count) + text;
}

// Where the two differ, counted from the table that follows.
std::string paperSummary(const std::vector<Result>& results) {
  int pairs = 0, both = 0, later = 0;
  Shortfalls theirs_short, ours_short;
  for (const auto& [one, o] : results) {
    const std::size_t split = one.name.find("/ours/");
    if (one.family() != "paper" || split == std::string::npos) continue;
    const std::string claim = one.name.substr(6, split - 6), hair = one.name.substr(split + 6);
    const Result* theirs = resultOf("paper/" + claim + "/its-solver/" + hair, results);
    if (!theirs || o.verdict == Verdict::kSkipped) continue;
    ++pairs;
    const bool ours_back = o.verdict == Verdict::kPassed, theirs_back = theirs->outcome.verdict == Verdict::kPassed;
    both += ours_back && theirs_back;
    later += ours_back && theirs_back && theirs->outcome.back_after > o.back_after + 1e-9;
    if (!theirs_back) ++theirs_short[claim];
    if (!ours_back) ++ours_short[claim];
  }
  if (pairs == 0) return "";
  return bench::formatted(
             "Of %d pairs both settings return in %d, the paper's solver later than ours in %d of those.\n", pairs,
             both, later) +
         "The paper's solver falls short in " + shortText(theirs_short) + ".\nOurs falls short in " +
         shortText(ours_short) + ".\n\n";
}

// A row for each claim and style: with our settings, with the paper's solver.
Table paperTable(const std::vector<Result>& results) {
  Table table{{"claim", "hair", "ours", "ours: iterations a step", "the paper's solver",
               "the paper's: iterations a step", "the paper's: steps not solved"},
              {}};
  for (const auto& [one, o] : results) {
    const std::size_t split = one.name.find("/ours/");
    if (one.family() != "paper" || split == std::string::npos) continue;
    const std::string claim = one.name.substr(6, split - 6), hair = one.name.substr(split + 6);
    const Result* theirs = resultOf("paper/" + claim + "/its-solver/" + hair, results);
    table.rows.push_back({claim, hair, verdictText(o), bench::formatted("%.0f", o.iterations), "not run", "", ""});
    if (!theirs) continue;
    std::vector<std::string>& row = table.rows.back();
    row[4] = verdictText(theirs->outcome);
    row[5] = bench::formatted("%.0f", theirs->outcome.iterations);
    row[6] = bench::formatted("%.0f %%", 100 * theirs->outcome.unsolved);
  }
  return table;
}

std::string failureList(const std::vector<Result>& results, std::uint64_t seed) {
  constexpr int kShown = 200;
  std::string text;
  int failed = 0;
  for (const auto& [one, o] : results) {
    if (!counts(one) || o.verdict != Verdict::kFailed || ++failed > kShown) continue;
    text += "- `" + replayCommand(one.name, seed, {}) + "`: " + o.fault + "\n";
  }
  if (failed == 0) return "Of the cases that count: none.\n";
  if (failed > kShown) text += bench::formatted("- and %d more, in stability.csv\n", failed - kShown);
  return text;
}

// Those that passed by two roundings of three, with what they fell short of by the other.
std::string roundingList(const std::vector<Result>& results, std::uint64_t seed) {
  std::string text;
  for (const auto& [one, o] : results) {
    if (!counts(one) || o.verdict != Verdict::kPassed || o.fault.empty()) continue;
    text += "- `" + replayCommand(one.name, seed, {}) + "`: " + o.fault + "\n";
  }
  if (text.empty()) return "";
  return "\nPassed by two roundings of three, and fell short by the other:\n\n" + text;
}

// The limits that a case is judged by.
std::string limitTable(const std::vector<Result>& results) {
  double memory = 0, slowdown = 0;
  for (const auto& [one, o] : results) {
    if (one.endurance && o.verdict != Verdict::kSkipped)
      memory = std::max(memory, o.memory_growth), slowdown = std::max(slowdown, o.slowdown);
  }
  const std::string measured =
      slowdown > 0 ? bench::formatted(" (measured: %.2f MiB, %.2f times)", memory, slowdown) : std::string();
  Table table{{"quantity", "limit"}, {}};
  table.rows = {
      {"distance from the reference hair, worst vertex, also 0.1 s of velocity ahead",
       bench::formatted("%g %% of the hair length", 100 * kBack)},
      {"depth of an external vertex in a collider at a frame's end", bench::formatted("%g mm", 1e3 * kDeepest)},
      {"mechanical energy after the motion, above what the motion left",
       bench::formatted("%g %% and the weight times 0.4 mm", 100 * kEnergyTolerance)},
      {"recoveries, but in the family `fault`", "0"},
      {"endurance run, after its first tenth: memory, time of a step",
       bench::formatted("%g MiB, %g times", kMemoryGrowth, kSlowdown) + measured},
  };
  return table.markdown();
}

// A page of the short run speaks of the short run alone.
std::string leftOutText(const std::string& how, std::size_t run, std::uint64_t seed) {
  if (how != "--short") return "";
  return bench::formatted(
      "\nThis page shows %zu of the %zu cases that `--long` runs. What falls short among the others is not on it.\n",
      run, declareCases(seed).size());
}

// The parts' marks alone, for a folder that has no page yet.
constexpr const char* kParts[] = {"result", "limits", "failures", "paper"};

void startPage(const std::string& page) {
  if (std::filesystem::exists(page)) return;
  std::string text = "# Stability\n\n";
  for (const std::string part : kParts) text += "<!-- measured: " + part + " -->\n<!-- end of " + part + " -->\n\n";
  app::writeFile(page, text);
}

// Passed and failed, and a line a family.
std::string resultPart(const std::vector<Result>& results, const Table& families, const std::string& how,
                       std::uint64_t seed) {
  long passed = 0, by_rounding = 0, failed = 0;
  double cpu = 0;
  for (const auto& [one, o] : results) {
    cpu += o.cpu_seconds;
    if (!counts(one)) continue;
    passed += o.verdict == Verdict::kPassed;
    by_rounding += o.verdict == Verdict::kPassed && !o.fault.empty();
    failed += o.verdict == Verdict::kFailed;
  }
  return bench::formatted(
             "**%ld passed, %ld failed** (`%s`, seed %llu, %.0f s of CPU time). Passed by two roundings of three: "
             "%ld.\n\n",
             passed, failed, how.c_str(), static_cast<unsigned long long>(seed), cpu, by_rounding) +
         columns(families, {"family", "what varies", "cases", "failed", "slowest return, s", "guided", "recoveries"})
             .markdown() +
         leftOutText(how, results.size(), seed);
}

// The table that hairmesh-stress --ablate all --csv left in the folder's data, where it did.
std::string ablationPart(const std::string& folder) {
  std::ifstream stream(folder + "/data/ablation.csv");
  if (!stream) return "";
  return bench::tableOfCsv({std::istreambuf_iterator<char>(stream), {}}).markdown();
}

}  // namespace

void checkDocument(const std::string& folder) {
  const std::string page = folder + "/stability.md";
  if (std::filesystem::exists(page)) bench::checkMeasuredParts(page, {std::begin(kParts), std::end(kParts)});
  if (!ablationPart(folder).empty()) bench::checkMeasuredParts(folder + "/safety_nets.md", {"ablation"});
  bench::checkNewFile(folder + "/data/stability.csv", "choose another with --document");
}

void writeDocument(const std::vector<Result>& results, const std::string& how, std::uint64_t seed,
                   const std::string& folder) {
  const std::string page = folder + "/stability.md", data = bench::dataFolder(folder);
  std::string csv = csvHead();
  for (const Result& result : results) csv += csvRow(result);
  app::writeFile(data + "/stability.csv", csv);
  drawHeatMaps(results, data);
  const Table families = familyTable(countFamilies(results)), paper = paperTable(results);
  bench::writeTable(folder, "stability_families", families);
  bench::writeTable(folder, "stability_paper", paper);
  startPage(page);
  bench::writeMeasuredPart(page, "result", resultPart(results, families, how, seed));
  bench::writeMeasuredPart(page, "limits", limitTable(results));
  bench::writeMeasuredPart(page, "failures", failureList(results, seed) + roundingList(results, seed) + "\n");
  bench::writeMeasuredPart(page, "paper", paperSummary(results));
  if (const std::string ablation = ablationPart(folder); !ablation.empty())
    bench::writeMeasuredPart(folder + "/safety_nets.md", "ablation", ablation);
}

}  // namespace stress
