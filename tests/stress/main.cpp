// hairmesh-stress: the stability gauntlet.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <iostream>
#include <map>

#include "app/errors.h"
#include "app/frame_stats.h"
#include "tests/stress/report.h"
#include "tests/stress/run_case.h"

namespace {

using stress::Outcome;
using stress::Result;
using stress::StressCase;
using stress::Verdict;

struct Options {
  bool short_run = false, long_run = false, list = false, verbose = false;
  std::string pattern, document, csv;
  std::uint64_t seed = 1;
  int part = 0, parts = 1;
};

bool chosen(const StressCase& one, std::size_t index, const Options& options) {
  if (!options.pattern.empty()) {
    const bool all_that_begin = options.pattern.back() == '*';
    const std::string begin = options.pattern.substr(0, options.pattern.size() - all_that_begin);
    return all_that_begin ? one.name.starts_with(begin) : one.name == options.pattern;
  }
  if (static_cast<int>(index % static_cast<std::size_t>(options.parts)) != options.part) return false;
  return options.long_run || one.in_short;
}

void tellFailure(const Result& result, std::uint64_t seed) {
  const stress::WindowCommand window = stress::windowCommand(result.one);
  std::cout << (result.one.compared ? "compared " : "FAILED   ") << result.one.name << "\n  at " << result.outcome.at
            << " s: " << result.outcome.fault << "\n  hairmesh-stress --case '" << result.one.name << "' --seed "
            << seed << "\n  " << window.command << "\n";
  if (!window.note.empty()) std::cout << "  (" << window.note << ")\n";
}

void tellOutcome(const Result& result) {
  const Outcome& o = result.outcome;
  std::printf(
      "%-60s %s  back after %.2f s%s, distance %.4f, deepest %.3f mm, energy rise %.2e, recoveries %d, %d steps, "
      "%.0f ms\n",
      result.one.name.c_str(), o.verdict == Verdict::kPassed ? "ok" : "--", o.back_after, o.with_body ? " (body)" : "",
      o.distance, 1e3 * o.deepest, o.energy_rise, o.recoveries, o.steps, 1e3 * o.cpu_seconds);
}

int runCases(const Options& options) {
  const std::vector<StressCase> cases = stress::declareCases(options.seed);
  stress::StageStore stages;
  std::vector<Result> results;
  long passed = 0, failed = 0, skipped = 0;
  const double started = app::now();
  double told = started;
  for (std::size_t k = 0; k < cases.size(); ++k) {
    if (!chosen(cases[k], k, options)) continue;
    if (options.list) {
      std::cout << cases[k].name << "\n";
      continue;
    }
    Result result{cases[k], stress::runCase(cases[k], options.seed, stages)};
    const Verdict verdict = result.outcome.verdict;
    if (options.verbose || !options.pattern.empty()) tellOutcome(result);
    if (verdict == Verdict::kFailed) tellFailure(result, options.seed);
    if (!result.one.compared) {
      passed += verdict == Verdict::kPassed;
      failed += verdict == Verdict::kFailed;
      skipped += verdict == Verdict::kSkipped;
    }
    results.push_back(std::move(result));
    if (app::now() - told > 30) {
      told = app::now();
      std::cout << results.size() << " cases in " << static_cast<int>(told - started) << " s, " << failed << " failed"
                << std::endl;
    }
  }
  if (options.list) return app::kExitFine;
  if (passed + failed + skipped == 0 && results.empty())
    throw app::InputError("", "case '" + options.pattern + "'", "is not declared", "see hairmesh-stress --list");
  if (!options.csv.empty()) stress::writeCsv(results, options.csv);
  if (!options.document.empty()) stress::writeDocument(results, options.seed, options.document);
  if (skipped > 0) std::cout << skipped << " skipped: their clips are not here\n";
  std::cout << passed << " passed, " << failed << " failed" << std::endl;
  return failed > 0 ? app::kExitFault : app::kExitFine;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App program("Stability gauntlet: runs a seeded matrix of cases and judges each. Exit code 1 on a failure.");
  Options options;
  program.add_flag("--short", options.short_run, "the cases of the test suite, about two minutes");
  program.add_flag("--long", options.long_run, "all cases");
  program.add_flag("--list", options.list, "print the names of the cases chosen and end");
  program.add_option("--case", options.pattern, "run one case by name, or all whose names begin as this before a '*'");
  program.add_option("--seed", options.seed, "of all random draws")->capture_default_str();
  program.add_flag("--verbose", options.verbose, "a line for every case");
  program.add_option("--part", options.part, "run one of --parts shares of the cases, from 0")
      ->check(CLI::Range(0, 999));
  program.add_option("--parts", options.parts, "shares that the cases are dealt into")->check(CLI::Range(1, 1000));
  program.add_option("--csv", options.csv, "also write a row a case to this file");
  program.add_option("--document", options.document, "write stability.md and its pictures into this folder");
  CLI11_PARSE(program, argc, argv);
  if (options.list && !options.short_run && options.pattern.empty()) options.long_run = true;
  if (!options.short_run && !options.long_run && options.pattern.empty()) {
    std::cout << program.help();
    return app::kExitUsage;
  }
  try {
    return runCases(options);
  } catch (const app::InputError& error) {
    std::cerr << "hairmesh-stress: " << error.what() << "\n";
    return app::kExitBadInput;
  }
}
