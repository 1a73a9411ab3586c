#include "tests/stress/resume.h"

#include <algorithm>
#include <filesystem>
#include <functional>

#include "app/files/errors.h"
#include "app/files/output_file.h"
#include "app/files/text_file.h"
#include "sim/mesh/state_bytes.h"
#include "tests/sim_probes.h"
#include "tests/stress/case_run.h"

namespace stress {
namespace {

constexpr double kLongestMotion = 10, kRest = 3;  // s
constexpr double kEarliest = 0.1, kLatest = 0.9;  // of the whole time: when the state is saved

std::string fileOf(const std::string& folder, const StressCase& one, const char* which) {
  std::string name = one.name + which;
  std::replace(name.begin(), name.end(), '/', '_');
  return (std::filesystem::path(folder) / name).string();
}

void save(const std::string& file, const Hair& hair) {
  const std::vector<std::byte> bytes = sim::saveState(hair.mesh, hair.state);
  app::writeFile(file, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

std::string load(const std::string& file, const sim::HairMesh& mesh, sim::HairState& state) {
  const std::string text = app::readText(file);
  return sim::loadState(mesh, std::as_bytes(std::span(text)), state);
}

// All of the case, `midway` called once at its moment.
void play(std::uint64_t seed, Run& run, const std::function<void()>& midway) {
  const double motion = std::min(run.one.seconds, kLongestMotion), end = motion + kRest;
  Random random(seed, run.one.name);
  const double moment = random(kEarliest, kLatest) * end;
  bool done = false;
  const auto look = [&] {
    if (done || run.around.time() < moment) return;
    done = true;
    midway();
  };
  while (run.around.time() < motion) {
    look();
    frame(run);
  }
  run.around.stop();
  const double dt = run.one.pace == Pace::kFixed ? run.one.step : sim::SimParams{}.time_step;
  while (run.around.time() < end) {
    look();
    run.around.pass(dt);
    if (!run.waits) stepHair(run.params, run, dt, run.hair);
  }
}

std::string seedFile(const std::string& folder) {
  return (std::filesystem::path(folder) / "seed").string();
}

}  // namespace

void saveSeed(std::uint64_t seed, const std::string& folder) {
  app::writeFile(seedFile(folder), std::to_string(seed) + "\n");
}

void checkSeed(std::uint64_t seed, const std::string& folder) {
  std::string saved = app::readText(seedFile(folder));
  saved.resize(std::min(saved.find('\n'), saved.size()));
  if (saved != std::to_string(seed))
    throw app::InputError(folder, "", "was saved with --seed " + saved + ", not " + std::to_string(seed),
                          "give --seed " + saved);
}

void saveMidway(const StressCase& one, std::uint64_t seed, StageStore& stages, const std::string& folder) {
  Run run(one, seed, stages.stage(one));
  play(seed, run, [&] { save(fileOf(folder, one, ".midway"), run.hair); });
  save(fileOf(folder, one, ".end"), run.hair);
}

std::string resumeFrom(const std::string& folder, const StressCase& one, std::uint64_t seed, StageStore& stages) {
  Run run(one, seed, stages.stage(one));
  run.waits = true;
  std::string fault;
  play(seed, run, [&] {
    fault = load(fileOf(folder, one, ".midway"), run.hair.mesh, run.hair.state);
    run.waits = false;
  });
  sim::HairState end;
  if (fault.empty()) fault = load(fileOf(folder, one, ".end"), run.hair.mesh, end);
  if (!fault.empty()) return fault;
  return test::sameBits(end, run.hair.state) ? "" : "ends in other bits";
}

}  // namespace stress
