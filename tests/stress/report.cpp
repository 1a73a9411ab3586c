#include "tests/stress/report.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <map>
#include <sstream>

#include "app/errors.h"
#include "app/motion.h"
#include "sim/field_text.h"
#include "tests/stress/family_text.h"
#include "tests/stress/heat_map.h"

namespace stress {

namespace {

std::string said(const char* format, auto... values) {
  char text[512];
  std::snprintf(text, sizeof text, format, values...);
  return text;
}

constexpr std::size_t kNumbers = 19;
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
          static_cast<double>(o.combed),
          o.iterations,
          o.unsolved};
}

Outcome outcomeOf(const std::array<double, kNumbers>& n) {
  Outcome o;
  o.other_rest = n[1] != 0;
  o.with_body = n[0] != 0, o.back_after = n[2], o.at = n[3], o.distance = n[4], o.deepest = n[5];
  o.inside = static_cast<long>(n[6]), o.unconstrained = static_cast<long>(n[7]), o.energy_rise = n[8];
  o.energy_step = n[9], o.memory_growth = n[10], o.slowdown = n[11], o.recoveries = static_cast<int>(n[12]);
  o.carried = static_cast<int>(n[13]), o.steps = static_cast<int>(n[14]), o.cpu_seconds = n[15];
  o.combed = static_cast<int>(n[16]), o.iterations = n[17], o.unsolved = n[18];
  return o;
}

struct FamilyCount {
  std::vector<const StressCase*> members;  // that were run
  long passed = 0, failed = 0, with_body = 0, inside = 0, unconstrained = 0, carried = 0, combed = 0, recoveries = 0;
  double slowest = 0, deepest = 0, energy_rise = 0, energy_step = 0;
};

std::vector<FamilyCount> countFamilies(const std::vector<Result>& results) {
  std::vector<FamilyCount> families;
  for (const auto& [one, o] : results) {
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
    known->combed += o.combed > 0;
    known->recoveries += o.recoveries;
    known->slowest = std::max(known->slowest, o.back_after);
    known->deepest = std::max(known->deepest, o.deepest);
    known->energy_rise = std::max(known->energy_rise, o.energy_rise);
    known->energy_step = std::max(known->energy_step, o.energy_step);
  }
  return families;
}

std::string familyTable(const std::vector<FamilyCount>& families) {
  std::string text =
      "| family | what varies | hair | cases | passed | failed | back on the body | slowest return, s | deepest, mm | "
      "inside (unconstrained) | energy above what was left | largest step up | carried | combed out | recoveries |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n";
  for (const FamilyCount& f : families) {
    text += "| " + f.members.front()->family() + " | " + familyText(f.members) + " | " + hairText(f.members);
    text += said(" | %zu | %ld | %ld | %ld | %.2f | %.3f | %ld (%ld) | %.1e | %.1e | %ld | %ld | %ld |\n",
                 f.members.size(), f.passed, f.failed, f.with_body, f.slowest, 1e3 * f.deepest, f.inside,
                 f.unconstrained, f.energy_rise, f.energy_step, f.carried, f.combed, f.recoveries);
  }
  return text;
}

std::string verdictText(const Outcome& o) {
  if (o.verdict == Verdict::kSkipped) return "not run";
  if (o.verdict == Verdict::kFailed) return o.fault;
  return said("back after %.2f s", o.back_after);
}

const Result* resultOf(const std::string& name, const std::vector<Result>& results) {
  const auto found = std::find_if(results.begin(), results.end(), [&](const Result& r) { return r.one.name == name; });
  return found == results.end() ? nullptr : &*found;
}

// Where the two differ, counted from the table that follows.
std::string paperSummary(const std::vector<Result>& results) {
  int pairs = 0, both = 0, later = 0;
  std::string broke, ours_broke;
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
    if (!theirs_back) broke += (broke.empty() ? "" : ", ") + claim + " (" + hair + ")";
    if (!ours_back) ours_broke += (ours_broke.empty() ? "" : ", ") + claim + " (" + hair + ")";
  }
  if (pairs == 0) return "";
  return said("Of %d pairs both settings return in %d, the paper's solver later than ours in %d of those. ", pairs,
              both, later) +
         "The paper's solver falls short in: " + (broke.empty() ? "none" : broke) +
         ". Ours fall short in: " + (ours_broke.empty() ? "none" : ours_broke) + ".\n\n";
}

// A row for each claim and style: with our settings, with the paper's solver.
std::string paperTable(const std::vector<Result>& results) {
  std::string text =
      "| claim | hair | ours | iterations a step | the paper's solver | iterations a step | steps not solved |\n"
      "|---|---|---|---|---|---|---|\n";
  for (const auto& [one, o] : results) {
    const std::size_t split = one.name.find("/ours/");
    if (one.family() != "paper" || split == std::string::npos) continue;
    const std::string claim = one.name.substr(6, split - 6), hair = one.name.substr(split + 6);
    const Result* theirs = resultOf("paper/" + claim + "/its-solver/" + hair, results);
    text += "| " + claim + " | " + hair + " | " + verdictText(o) + said(" | %.0f | ", o.iterations);
    if (!theirs) {
      text += "not run | | |\n";
    } else {
      text += verdictText(theirs->outcome) +
              said(" | %.0f | %.0f %% |\n", theirs->outcome.iterations, 100 * theirs->outcome.unsolved);
    }
  }
  return text;
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
  if (failed > kShown) text += said("- and %d more, in stability.csv\n", failed - kShown);
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

constexpr const char *kHandStart = "<!-- by hand -->", *kHandEnd = "<!-- end of by hand -->";

// What people have found out about the cases that fall short, as it stands on the page that is written anew.
std::string byHand(const std::string& old) {
  const auto start = old.find(kHandStart), end = old.find(kHandEnd);
  if (start == std::string::npos || end == std::string::npos || end < start) return "";
  return "\n" + old.substr(start, end - start) + kHandEnd + "\n";
}

// What the soaks measured: "" where none ran.
std::string soakText(const std::vector<Result>& results) {
  double memory = 0, slowdown = 0;
  for (const auto& [one, o] : results) {
    if (one.soak && o.verdict != Verdict::kSkipped)
      memory = std::max(memory, o.memory_growth), slowdown = std::max(slowdown, o.slowdown);
  }
  return slowdown > 0 ? said(" (measured: %.2f MiB, %.2f times)", memory, slowdown) : "";
}

// A page of the short run speaks of the short run alone.
std::string leftOutText(const std::string& how, std::size_t run, std::uint64_t seed) {
  if (how != "--short") return "";
  return said(
      "\nThis page shows %zu of the %zu cases that `--long` runs. What falls short among the others is not on it.\n",
      run, declareCases(seed).size());
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
         "memory_growth_mib,slowdown,recoveries,carried,steps,cpu_s,combed,iterations,unsolved,fault\n";
}

std::string csvRow(const Result& result) {
  std::string row = result.one.name + "," + kVerdicts[static_cast<int>(result.outcome.verdict)];
  for (const double number : numbersOf(result.outcome)) row += said(",%.6g", number);
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

void writeDocument(const std::vector<Result>& results, const std::string& how, std::uint64_t seed,
                   const std::string& folder) {
  std::ofstream csv(folder + "/stability.csv");
  csv << csvHead();
  for (const Result& result : results) csv << csvRow(result);
  csv.close();
  drawHeatMaps(results, folder);
  long passed = 0, by_rounding = 0, failed = 0;
  double cpu = 0;
  for (const auto& [one, o] : results) {
    cpu += o.cpu_seconds;
    if (!counts(one)) continue;
    passed += o.verdict == Verdict::kPassed;
    by_rounding += o.verdict == Verdict::kPassed && !o.fault.empty();
    failed += o.verdict == Verdict::kFailed;
  }
  std::ifstream before(folder + "/stability.md");
  const std::string old((std::istreambuf_iterator<char>(before)), std::istreambuf_iterator<char>());
  before.close();
  std::ofstream document(folder + "/stability.md");
  document
      << R"(# Stability

`hairmesh-stress` runs a declared, seeded matrix of cases over time steps, playback speeds, every parameter, styles,
impossible states, violent motion, bodies in the way and faults, and judges each. `--short` is part of `./test`; this
page was written by

```
)"
      << "build/release/tests/hairmesh-stress " << how << " --seed " << seed << R"( --document docs
```

or, several processes beside one another, in parts: with `--parts 16 --part K --csv partK.csv` in place of `--document docs` for every K from
0 to 15, and then with `--results part*.csv`.

Every case has three parts. In the *motion* the hair is treated as the case says. Then everything stands still with the
body there. Hair that is not back by then (beside the other side of a shoulder it rests as well) is *released*: the
colliders are taken away. A case passes when

- every position and velocity is finite after every step;
- hair and twin, the same hair put to its rest shape when the motion stopped, come within )"
      << 100 * kBack << R"( % of the hair's length of one another, worst
  vertex, also extrapolated by 0.1 s of velocity; or, without the body, both rest, apart from one another but the hair with no more
  energy than the twin (very soft hair sags into more shapes than one): within 1 % of the hair's length of where they were for a second,
  and no faster than would take them out of that in 0.1 s. Within the stated time: 1 s with the body and 5 s without; 10 s without from
  impossible states in steps of 1/10 s; 30 s without where a parameter row is turned to its limit, stiffness or mass changed by powers of ten, and for
  random draws; without the body counted from when the twin itself has come to rest, which limp hair may take three times that for;
- no external vertex (with `collide_inner`: no vertex) is deeper than )"
      << 1e3 * kDeepest
      << R"( mm inside a collider in use, ellipsoid or signed distances, at any frame's end; where a body appears within the hair,
  or the hair within a body, after 0.1 or 0.2 s, and as many times longer as `max_depenetration` is below its default;
- mechanical energy, once everything stands still, never exceeds what the motion left by more than )"
      << 100 * kEnergyTolerance << R"( % and what contacts may lift it by
  within their slack, its weight times 0.4 mm (a steady wind counts as the weight that its push is, and
  gusts end with the motion; not asked where rows of the numerics stand at a limit or are drawn at random: ten iterations a solve keep no such law).
  From one step to the next it may rise below that level: a contact found at a step's end lifts hair that has
  fallen a millimetre too far, and very stiff hair trades energy between steps. The largest such rise is listed;
- (a second twin, put to its rest shape when the body is taken away, is a rest as well: the body may have pushed the first into another. What
  hair is lifted to that lay within a body before the step counts as left by the motion, as does
  what combing lifts it to. Where a body appears within the hair, what that lifts the hair to counts as left by the motion: roots that lie within a body
  keep its contacts working);
- the watchdog never steps in, but for the family that injects faults;
- a body that a case adds (an arm, an ellipsoid switched on) comes upon the hair: else the case has tested nothing;
- over the soak's hour of simulated time, after its first tenth, memory grows by no more than )"
      << kMemoryGrowth << " MiB, and a step of its last tenth takes no more than " << kSlowdown
      << R"( times one of its second)" << soakText(results) << R"(.

)"
      << said(
             "**%ld passed, %ld failed**, seed %llu, %.0f s of CPU time. Contacts and "
             "tangles part ways by the last bit\nof a number: a case that falls short is run twice more with gravity "
             "changed by a millionth up and down, and passes where both do; %ld did (all named below).\n\n",
             passed, failed, static_cast<unsigned long long>(seed), cpu, by_rounding)
      << familyTable(countFamilies(results)) << R"(
"Carried" counts jumps of the head that no motion could make (faster than `teleport_speed`), over which the hair is
carried along. "Combed out" counts cases in which columns that stayed turned over, folded back or, hanging still, squeezed
to less than half for 0.8 s were led back to their rest shape (`sim/comb_out.h`), or hair that came to rest in another
shape and higher than its own was (`sim/rest_check.h`); while that goes on it is a hand from outside, and what energy it lifts the
hair to is what the motion is taken to have left.

![Heat maps](stability_map.svg)

## The paper's claims

Playback at 10 times and more without collisions (figure 7), collapse onto the roots (figure 8), an arm through the hair
with and without deformation minimization (figure 9), large steps and stiff hair; with our default settings and with the
paper's solver (block-diagonal Modified PCG in single precision, one linearized step, as it stands: no energy guard and no
combing out). Its columns are shown, not counted.

)" << paperSummary(results)
      << paperTable(results) << "\n## Cases that fall short\n\n"
      << failureList(results, seed) << byHand(old) << roundingList(results, seed)
      << leftOutText(how, results.size(), seed);
  document.close();
  if (!document)
    throw app::InputError(folder + "/stability.md", "", "cannot be written", "choose a folder that exists");
}

}  // namespace stress
