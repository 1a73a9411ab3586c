#include "tests/stress/report.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <fstream>
#include <map>
#include <sstream>

#include "app/files/errors.h"
#include "app/files/text_file.h"
#include "sim/field_text.h"
#include "tests/bench/measured_part.h"

namespace stress {

namespace {

constexpr std::size_t kNumbers = 22;
constexpr const char* kVerdicts[] = {"passed", "failed", "skipped"};

// The numbers of an outcome in the table's order, after the case's name and its verdict.
std::array<double, kNumbers> numbersOf(const Outcome& o) {
  return {static_cast<double>(o.with_body),
          static_cast<double>(o.other_rest),
          o.back_after,
          o.at,
          o.distance,
          o.deepest,
          static_cast<double>(o.inside),
          static_cast<double>(o.unconstrained),
          o.energy_rise,
          o.energy_step,
          o.memory_growth,
          o.slowdown,
          static_cast<double>(o.recoveries),
          static_cast<double>(o.carried),
          static_cast<double>(o.steps),
          o.cpu_seconds,
          static_cast<double>(o.guided),
          o.iterations,
          o.unsolved,
          o.dearest,
          o.skin_share,
          o.skin_deepest};
}

Outcome outcomeOf(const std::array<double, kNumbers>& n) {
  Outcome o;
  o.other_rest = n[1] != 0;
  o.with_body = n[0] != 0, o.back_after = n[2], o.at = n[3], o.distance = n[4], o.deepest = n[5];
  o.inside = static_cast<long>(n[6]), o.unconstrained = static_cast<long>(n[7]), o.energy_rise = n[8];
  o.energy_step = n[9], o.memory_growth = n[10], o.slowdown = n[11], o.recoveries = static_cast<int>(n[12]);
  o.carried = static_cast<int>(n[13]), o.steps = static_cast<int>(n[14]), o.cpu_seconds = n[15];
  o.guided = static_cast<int>(n[16]), o.iterations = n[17], o.unsolved = n[18], o.dearest = n[19];
  o.skin_share = n[20], o.skin_deepest = n[21];
  return o;
}

}  // namespace

std::string replayCommand(const std::string& name, std::uint64_t seed, const std::vector<std::string>& sets) {
  std::string command = "hairmesh-stress --case '" + name + "' --seed " + std::to_string(seed);
  for (const std::string& set : sets) command += " --set " + set;
  return command;
}

std::string csvHead() {
  return "case,verdict,with_body,other_rest,back_after_s,failed_at_s,distance,deepest_m,inside,unconstrained,energy_"
         "rise,energy_"
         "step,"
         "memory_growth_mib,slowdown,recoveries,carried,steps,cpu_s,combed,iterations,unsolved,dearest,"
         "skin_share,skin_deepest_m,fault\n";
}

std::string csvRow(const Result& result) {
  std::string row = result.one.name + "," + kVerdicts[static_cast<int>(result.outcome.verdict)];
  for (const double number : numbersOf(result.outcome)) row += bench::formatted(",%.6g", number);
  return row + "," + result.outcome.fault + "\n";
}

std::vector<Result> readCsv(const std::string& file, const std::vector<StressCase>& declared) {
  std::map<std::string, const StressCase*> cases;
  for (const StressCase& one : declared) cases[one.name] = &one;
  std::vector<Result> results;
  std::stringstream text(app::readText(file));
  std::string line;
  std::getline(text, line);
  for (int number = 2; std::getline(text, line); ++number) {
    std::stringstream fields(line);
    std::string name, verdict, field, fault;
    std::array<double, kNumbers> numbers{};
    std::getline(fields, name, ',');
    std::getline(fields, verdict, ',');
    bool fine = cases.contains(name);
    for (double& value : numbers) {
      std::getline(fields, field, ',');
      fine = sim::parseNumber(field, value) && fine;
    }
    std::getline(fields, fault);
    const auto known = std::find(std::begin(kVerdicts), std::end(kVerdicts), verdict);
    if (!fine || known == std::end(kVerdicts))
      throw app::InputError(file, "line " + std::to_string(number), "is no result of a declared case", "run anew");
    results.push_back({*cases[name], outcomeOf(numbers)});
    results.back().outcome.verdict = static_cast<Verdict>(known - std::begin(kVerdicts));
    results.back().outcome.fault = fault;
  }
  return results;
}

}  // namespace stress
