// hairmesh-stress: the stability stress test.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <iostream>
#include <map>

#include "app/files/errors.h"
#include "app/files/output_file.h"
#include "app/options.h"
#include "app/run_main.h"
#include "app/scene/frame_stats.h"
#include "tests/bench/written_files.h"
#include "tests/stress/ablation.h"
#include "tests/stress/document.h"
#include "tests/stress/resume.h"
#include "tests/stress/run_case.h"

namespace {

using stress::Outcome;
using stress::Result;
using stress::StressCase;
using stress::Verdict;

constexpr double kTellEvery = 30;  // s

struct Options {
  bool short_run = false, long_run = false, list = false, verbose = false, trace = false;
  std::string pattern, document, csv, ablate, save, resume;
  std::vector<std::string> sets, results;
  std::uint64_t seed = 1;
  int part = 0, parts = 1;
};

bool chosen(const StressCase& one, std::size_t index, const Options& options) {
  if (static_cast<int>(index % static_cast<std::size_t>(options.parts)) != options.part) return false;
  if (!options.pattern.empty()) {
    const bool all_that_begin = options.pattern.back() == '*';
    const std::string begin = options.pattern.substr(0, options.pattern.size() - all_that_begin);
    return all_that_begin ? one.name.starts_with(begin) : one.name == options.pattern;
  }
  return options.long_run || one.in_short;
}

void printFault(const Result& result, const Options& options) {
  const stress::WindowCommand window = stress::windowCommand(result.one);
  const char* kind = result.one.compared                          ? "compared "
                     : result.outcome.verdict == Verdict::kFailed ? "FAILED   "
                                                                  : "rounding ";
  std::cout << kind << result.one.name << "\n  at " << result.outcome.at << " s: " << result.outcome.fault << "\n  "
            << stress::replayCommand(result.one.name, options.seed, options.sets) << "\n  " << window.command << "\n";
  if (!window.note.empty()) std::cout << "  (" << window.note << ")\n";
}

void printOutcome(const Result& result) {
  const Outcome& o = result.outcome;
  std::printf(
      "%-60s %s  back after %.2f s%s, distance %.4f, deepest %.3f mm, energy rise %.2e, recoveries %d, %d steps, "
      "%.0f ms\n",
      result.one.name.c_str(), o.verdict == Verdict::kPassed ? "ok" : "--", o.back_after, o.with_body ? " (body)" : "",
      o.distance, 1e3 * o.deepest, o.energy_rise, o.recoveries, o.steps, 1e3 * o.cpu_seconds);
}

// Parameters given by hand come after, and so over, a case's own.
void applySets(const std::vector<std::string>& sets, std::vector<StressCase>& cases) {
  for (const std::string& text : sets) {
    const std::size_t equals = std::min(text.find('='), text.size());
    const std::string name = text.substr(0, equals);
    sim::SimParams params;
    const sim::ParamText answer = sim::setParam(params, name, text.substr(std::min(equals + 1, text.size())));
    if (!answer.ok) throw app::UsageError("--set: " + answer.fault);
    for (StressCase& one : cases) one.params.emplace_back(name, sim::findParam(name)->get(params));
  }
}

struct Count {
  long passed = 0, failed = 0, skipped = 0;
  long by_rounding = 0;  // of those passed: by two roundings of three
  void add(const Result& result) {
    if (result.one.compared) return;
    passed += result.outcome.verdict == Verdict::kPassed;
    by_rounding += result.outcome.verdict == Verdict::kPassed && !result.outcome.fault.empty();
    failed += result.outcome.verdict == Verdict::kFailed;
    skipped += result.outcome.verdict == Verdict::kSkipped;
  }
};

std::vector<Result> runCases(const Options& options, const std::vector<StressCase>& cases) {
  stress::StageStore stages;
  std::vector<Result> results;
  Count count;
  bench::RowFile csv(options.csv, stress::csvHead());
  const double started = app::now();
  double told = started;
  for (std::size_t k = 0; k < cases.size(); ++k) {
    if (!chosen(cases[k], k, options)) continue;
    Result result{cases[k], stress::runCaseByMajority(cases[k], options.seed, options.trace, stages)};
    if (options.verbose || !options.pattern.empty()) printOutcome(result);
    if (!result.outcome.fault.empty()) printFault(result, options);
    count.add(result);
    csv.add(stress::csvRow(result));
    results.push_back(std::move(result));
    if (app::now() - told > kTellEvery) {
      told = app::now();
      std::cout << results.size() << " cases in " << static_cast<int>(told - started) << " s, " << count.failed
                << " failed" << std::endl;
    }
  }
  return results;
}

// Every chosen case without each net in turn.
int ablate(const Options& options, const std::vector<StressCase>& cases) {
  if (!options.csv.empty()) app::checkWritable(options.csv);
  std::vector<stress::Ablation> rows;
  std::vector<Verdict> with_all;
  for (const std::string& net : stress::ablationsOf(options.ablate)) {
    stress::StageStore stages;
    stress::Ablation row{net};
    const std::vector<StressCase> all = stress::without(net, cases);
    for (std::size_t k = 0, n = 0; k < all.size(); ++k) {
      if (!chosen(all[k], k, options) || all[k].compared || all[k].endurance) continue;
      const Outcome outcome = stress::runCaseByMajority(all[k], options.seed, false, stages);
      if (rows.empty()) with_all.push_back(outcome.verdict);
      const bool failed = outcome.verdict == Verdict::kFailed, failed_before = with_all[n++] == Verdict::kFailed;
      ++row.cases;
      row.failed += failed;
      row.lost += failed && !failed_before;
      row.gained += !failed && failed_before;
      row.guided += outcome.guided > 0;
      row.seconds += outcome.cpu_seconds;
      if (failed && !failed_before) std::cout << net << " lost " << all[k].name << ": " << outcome.fault << std::endl;
    }
    rows.push_back(row);
    std::cout << stress::ablationTable({&row, 1}) << std::flush;
  }
  const std::string table = stress::ablationTable(rows);
  std::cout << table;
  if (!options.csv.empty()) app::writeFile(options.csv, table);
  return app::kExitFine;
}

// Saves every chosen case midway, or goes on with those that were saved.
int saveOrResume(const Options& options, const std::vector<StressCase>& cases) {
  if (options.resume.empty()) {
    stress::saveSeed(options.seed, options.save);
  } else {
    stress::checkSeed(options.seed, options.resume);
  }
  stress::StageStore stages;
  long done = 0, failed = 0;
  for (std::size_t k = 0; k < cases.size(); ++k) {
    if (!chosen(cases[k], k, options) || stress::findClip(cases[k].clip).empty()) continue;
    ++done;
    if (options.resume.empty()) {
      stress::saveMidway(cases[k], options.seed, stages, options.save);
      continue;
    }
    const std::string fault = stress::resumeFrom(options.resume, cases[k], options.seed, stages);
    failed += !fault.empty();
    if (!fault.empty()) std::cout << "FAILED   " << cases[k].name << " " << fault << std::endl;
  }
  if (options.resume.empty()) {
    std::cout << done << " saved midway" << std::endl;
  } else {
    std::cout << done - failed << " resumed to the same bits, " << failed << " failed" << std::endl;
  }
  return failed > 0 ? app::kExitFault : app::kExitFine;
}

// Throws where nothing would be run: a misspelt case, a share that is empty.
void checkAnyChosen(const Options& options, const std::vector<StressCase>& cases) {
  for (std::size_t k = 0; k < cases.size(); ++k) {
    if (chosen(cases[k], k, options)) return;
  }
  Options whole = options;
  whole.part = 0, whole.parts = 1;
  if (options.parts > 1) {
    checkAnyChosen(whole, cases);
    throw app::UsageError("--part " + std::to_string(options.part) + ": has no case in " +
                          std::to_string(options.parts) + " parts; give fewer --parts");
  }
  throw app::UsageError("case '" + options.pattern + "': is not declared; see hairmesh-stress --list");
}

// In the matrix's order, however its parts were dealt.
std::vector<Result> resultsOf(const std::vector<std::string>& files, const std::vector<StressCase>& cases) {
  std::map<std::string, std::size_t> place;
  for (std::size_t k = 0; k < cases.size(); ++k) place[cases[k].name] = k;
  std::vector<Result> results;
  for (const std::string& file : files) {
    const std::vector<Result> some = stress::readCsv(file, cases);
    results.insert(results.end(), some.begin(), some.end());
  }
  std::ranges::stable_sort(results, {}, [&](const Result& result) { return place[result.one.name]; });
  return results;
}

int run(const Options& options) {
  std::vector<StressCase> cases = stress::declareCases(options.seed);
  if (options.results.empty()) checkAnyChosen(options, cases);
  applySets(options.sets, cases);
  if (options.list) {
    for (std::size_t k = 0; k < cases.size(); ++k) {
      if (chosen(cases[k], k, options)) std::cout << cases[k].name << "\n";
    }
    return app::kExitFine;
  }
  if (!options.save.empty() || !options.resume.empty()) return saveOrResume(options, cases);
  if (!options.ablate.empty()) return ablate(options, cases);
  if (!options.document.empty()) stress::checkDocument(options.document);
  std::vector<Result> results;
  if (options.results.empty()) {
    results = runCases(options, cases);
  } else {
    results = resultsOf(options.results, cases);
  }
  if (!options.document.empty())
    stress::writeDocument(results, options.short_run ? "--short" : "--long", options.seed, options.document);
  Count count;
  for (const Result& result : results) count.add(result);
  if (count.skipped > 0) std::cout << count.skipped << " skipped: their clips are not here\n";
  if (count.by_rounding > 0) std::cout << count.by_rounding << " of those passed fell short by one rounding of three\n";
  std::cout << count.passed << " passed, " << count.failed << " failed" << std::endl;
  return count.failed > 0 ? app::kExitFault : app::kExitFine;
}

// CLI11 itself reads a negative number as a huge one.
std::string seedFault(const std::string& text) {
  const bool digits = !text.empty() && text.find_first_not_of("0123456789") == std::string::npos;
  return digits ? "" : "write a whole number from 0 on, not '" + text + "'";
}

void addOptions(CLI::App& program, Options& options) {
  program.add_flag("--short", options.short_run, "the cases of the test suite, about two minutes");
  program.add_flag("--long", options.long_run, "all cases");
  program.add_flag("--list", options.list, "print the names of the cases chosen and end");
  program.add_option("--case", options.pattern, "run one case by name, or all whose names begin as this before a '*'");
  program.add_option("--seed", options.seed, "of all random draws, a whole number from 0 on")
      ->capture_default_str()
      ->check(CLI::Validator(seedFault, ""));
  program.add_option("--set", options.sets,
                     "NAME=VALUE: a parameter in every case, over what the case has; may be repeated");
  program.add_option(
      "--ablate", options.ablate,
      "run the cases with all safety nets and without this one (or all, one after the other); --csv takes "
      "the table");
  program.add_option("--save", options.save,
                     "save every case midway and at its end in this folder, without judging it");
  program.add_option("--resume", options.resume, "go on with what --save has saved, and compare the ends bit by bit")
      ->excludes("--save");
  program.add_flag("--trace", options.trace, "a line for every step");
  program.add_flag("--verbose", options.verbose, "a line for every case");
  program.add_option("--part", options.part, "run one of --parts shares of the cases, from 0")
      ->check(CLI::Range(0, 999));
  program.add_option("--parts", options.parts, "shares that the cases are dealt into")->check(CLI::Range(1, 1000));
  program.add_option("--csv", options.csv,
                     "also write a row a case to this file; docs/data/columns.md explains its columns");
  program.add_option("--results", options.results, "judge what these files of --csv hold instead of running cases");
  program.add_option("--document", options.document,
                     "write the tables of stability.md, and its data, into this folder");
}

}  // namespace

int main(int argc, char** argv) {
  std::setvbuf(stdout, nullptr, _IOLBF, 0);  // a run that is cut short leaves what it has said
  app::failAtFileLimit();
  CLI::App program("Stability stress test: runs a seeded matrix of cases and judges each. Exit code 1 on a failure.");
  Options options;
  addOptions(program, options);
  return app::runMain("hairmesh-stress", [&]() -> int {
    try {
      program.parse(argc, argv);
    } catch (const CLI::ParseError& fault) {
      return program.exit(fault) == 0 ? app::kExitFine : app::kExitUsage;
    }
    if (options.part >= options.parts)
      throw app::UsageError("--part cannot be " + std::to_string(options.part) + " of " +
                            std::to_string(options.parts) + " --parts; they are numbered from 0 to " +
                            std::to_string(options.parts - 1));
    if (options.list && !options.short_run && options.pattern.empty()) options.long_run = true;
    if (!options.short_run && !options.long_run && options.pattern.empty() && options.results.empty()) {
      std::cout << program.help();
      return app::kExitUsage;
    }
    return run(options);
  });
}
