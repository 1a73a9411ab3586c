#include "tests/stress/run_case.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <span>

#include "sim/contact/contact.h"
#include "tests/bench/cpu_clock.h"
#include "tests/bench/measured_part.h"
#include "tests/stress/case_run.h"

namespace stress {
namespace {

constexpr double kAtRest = 5e-3;                // m/s, of a reference hair that has settled
constexpr double kRested = 1;                   // s at rest elsewhere, before that counts
constexpr double kSoon = 0.1;                   // s, over which velocities are extrapolated
constexpr double kUnrest = 3;                   // times the stated time: bound of the reference hair's settling
constexpr double kWindow = 2, kHurry = 5;       // s, and times its pace: see Pace of return
constexpr int kIdleWindows = 5;                 // in a row, of hair that is not coming
constexpr double kShortest = 4, kLongest = 60;  // s, of a case's rounds
constexpr double kSmallestEnergy = 0.05;        // of the hair's weight times its length
constexpr int kSolved = 300;                    // iterations, with which the solves of most draws end

// MiB of the process that are in memory.
double residentMemory() {
  std::ifstream statm("/proc/self/statm");
  double all = 0, resident = 0;
  statm >> all >> resident;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE)) / (1 << 20);
}

// Memory and time a step, tenth by tenth.
void endurance(Run& run) {
  double memory = 0, early = 0, late = 0;
  for (int tenth = 1; tenth <= 10; ++tenth) {
    const double started = bench::cpuSeconds();
    const int before = run.outcome.steps;
    while (run.around.time() < run.one.seconds * tenth / 10 && !run.failed()) frame(run);
    const double each = (bench::cpuSeconds() - started) / std::max(1, run.outcome.steps - before);
    if (tenth == 1) memory = residentMemory();
    if (tenth == 2) early = each;
    late = each;
  }
  run.outcome.memory_growth = residentMemory() - memory;
  run.outcome.slowdown = late / early;
  if (run.outcome.memory_growth > kMemoryGrowth)
    run.fail(bench::formatted("memory grew by %.1f MiB", run.outcome.memory_growth));
  if (run.outcome.slowdown > kSlowdown)
    run.fail(bench::formatted("steps became %.2f times as slow", run.outcome.slowdown));
}

void playMotion(Run& run) {
  run.last_intrusion = 0;
  if (run.one.endurance) return endurance(run);
  while (run.around.time() < run.one.seconds && !run.failed()) frame(run);
}

// Distance of hair and reference hair over the hair length: the worst vertex, where it is and where it would be 0.1 s
// on.
struct Apart {
  double distance = 0;
  int vertex = 0;
};
Apart apart(const Hair& a, const Hair& b) {
  Apart worst;
  for (int i = 0; i < a.mesh.vertexCount(); ++i) {
    const double place = (a.state.positions[i] - b.state.positions[i]).norm();
    const double soon = kSoon * (a.state.velocities[i] - b.state.velocities[i]).norm();
    const double distance = std::max(place, soon) / a.mesh.hair_length;
    if (distance > worst.distance) worst = {distance, i};
  }
  return worst;
}

double fastest(const Hair& hair) {
  double most = 0;
  for (const sim::Vec3& v : hair.state.velocities) most = std::max(most, v.norm());
  return most;
}

// Weight times length (J), or what gravity and wind together pull where that is more: the scale of the energies that
// hair of this kind has at all.
double weightOf(const Run& run) {
  double volume = 0;
  for (const double share : run.hair.mesh.vertex_volume) volume += share;
  const sim::Vec3 pull = run.params.air_drag * windOf(run) - sim::Vec3(0, run.params.gravity, 0);
  return std::max(9.81, pull.norm()) * run.params.density * volume * run.hair.mesh.hair_length;
}

// What the motion left (J), in all and above the rest shape's, and the energy of the last step.
struct EnergyWatch {
  double rest = 0;
  bool begun = false;
  double left = 0, scale = 0, last = 0;
};

// What contacts may lift the hair by: by what it has fallen within their slack, at most.
double liftOf(const Run& run, double dt) {
  if (!run.one.collide) return 0;
  return weightOf(run) / run.hair.mesh.hair_length * sim::contactMargins(run.params, dt).slack;
}

// `lifted`: combed, which is done by a hand from outside, or out of a body that it lay within before the step (a jump
// in time had put it there), which is the body's work.
void checkEnergy(bool lifted, double dt, EnergyWatch& watch, Run& run) {
  const double energy = energyOf(run, run.hair);
  if (!watch.begun || (lifted && energy > watch.left)) {
    watch.begun = true;
    watch.left = std::max(energy, run.raised);
    watch.scale = std::max(watch.left - watch.rest, kSmallestEnergy * weightOf(run));
    watch.last = energy;
  }
  run.outcome.energy_step = std::max(run.outcome.energy_step, (energy - watch.last) / watch.scale);
  run.outcome.energy_rise = std::max(run.outcome.energy_rise, (energy - watch.left) / watch.scale);
  watch.last = energy;
  const double allowed = kEnergyTolerance + liftOf(run, dt) / watch.scale;
  if (run.outcome.energy_rise <= allowed || !run.one.keeps_energy) return;
  run.fail(bench::formatted("energy rose to %.1f %% of %.2e J above what the motion left, with nothing moving",
                            100 * run.outcome.energy_rise, watch.scale));
}

// Pace of return: what has moved so little within kWindow that it would not arrive in time at kHurry times that pace is
// not coming, unless it is only waiting for the simulator to find out that it rests elsewhere
// (sim/stabilization/reference_hair.h).
struct Pacer {
  std::vector<std::vector<sim::Vec3>> was;  // the hair's, then its references'
  double since = 0;
  int idle = 0;  // windows

  bool hopeless(const Run& run, std::span<const Hair> references, double dt, double seconds_left) {
    since += dt;
    if (since < kWindow && !was.empty()) return false;
    std::vector<std::vector<sim::Vec3>> now{run.hair.state.positions};
    for (const Hair& reference : references) now.push_back(reference.state.positions);
    double way = 0;
    if (!was.empty()) {
      for (std::size_t i = 0; i < now[0].size(); ++i) {
        double moved = 0;
        for (std::size_t k = 0; k < now.size(); ++k) moved += (now[k][i] - was[k][i]).norm();
        way = std::max(way, moved);
      }
    }
    const bool known = !was.empty();
    was = std::move(now);
    since = 0;
    const double missing = (run.outcome.distance - kBack) * run.hair.mesh.hair_length;
    idle = known && kHurry * way * seconds_left / kWindow < missing ? idle + 1 : 0;
    return idle >= kIdleWindows;
  }
};

// Seconds that a hair has been at rest: within kBack of one place, and too slow to leave it within kSoon.
struct Rest {
  std::vector<sim::Vec3> at;
  double seconds = 0;

  void update(const Hair& hair, double dt) {
    const double near = kBack * hair.mesh.hair_length;
    bool there = !at.empty() && fastest(hair) < near / kSoon;
    for (std::size_t i = 0; there && i < at.size(); ++i) there = (hair.state.positions[i] - at[i]).norm() < near;
    seconds = there ? seconds + dt : 0;
    if (!there) at = hair.state.positions;
  }
};

// Very soft hair has more rest shapes than one: another counts as a rest if its energy is no higher than the
// reference hair's.
bool restsNoHigher(Hair& reference, double energy, const Run& run) {
  return energy - energyOf(run, reference) <= kEnergyTolerance * kSmallestEnergy * weightOf(run);
}

// Head and body stand still. Steps hair and reference hairs until it meets one of them, for `seconds`; with `may_take`,
// counted from when the references rest, for limp hair swings for a minute from its rest shape too. Returns whether
// they meet.
bool waitUntilBack(double seconds, bool may_take, std::span<Hair> references, EnergyWatch& energy, Run& run) {
  const double dt = run.one.pace == Pace::kFixed ? run.one.step : sim::SimParams{}.time_step;
  const double started = run.around.time();
  double until = started + seconds;
  Pacer pacer;
  std::vector<Rest> rests(1 + references.size());  // the hair's, then its references'
  while (run.around.time() < until && !run.failed()) {
    run.around.pass(dt);
    const sim::StepReport report = stepHair(run.params, run, dt, run.hair);
    run.outcome.recoveries += report.recoveries;
    if (report.recoveries > 0) run.fail("state fault: " + sim::faultText(report.fault_report));
    countWork(report, run);
    if (run.trace) traceStep(run, dt, report, run.hair);
    for (Hair& reference : references) {
      stepHair(run.params, run, dt, reference);
      if (may_take && fastest(reference) > kAtRest)
        until = std::min(run.around.time(), started + kUnrest * seconds) + seconds;
    }
    checkFinite(run);
    checkOutside(run);
    if (!run.failed()) checkEnergy(report.guided > 0 || report.initial_overlap > 0, dt, energy, run);
    run.outcome.distance = INFINITY;
    for (const Hair& reference : references) {
      const Apart worst = apart(run.hair, reference);
      if (worst.distance >= run.outcome.distance) continue;
      run.outcome.distance = worst.distance;
      run.outcome.worst_vertex = worst.vertex;
    }
    if (run.outcome.distance < kBack) return true;
    rests[0].update(run.hair, dt);
    for (std::size_t k = 0; k < references.size(); ++k) {
      rests[k + 1].update(references[k], dt);
      // Not with the body there: that holds hair up as well.
      if (run.params.collide || run.failed() || std::min(rests[0].seconds, rests[k + 1].seconds) < kRested) continue;
      if (restsNoHigher(references[k], energy.last, run)) return run.outcome.other_rest = true;
    }
    if (pacer.hopeless(run, references, dt, until - run.around.time())) return false;
  }
  return false;
}

void addReference(const Run& run, std::vector<Hair>& references) {
  Hair& reference = references.emplace_back(run.hair.mesh);
  reference.context.safetyNets() = run.one.nets;
  reference.state = sim::restState(run.hair.mesh, run.around.head());
}

// Which of its rests soft hair comes to from the rest shape depends on what its solves leave undone, the rests do not:
// forces balance there. So hair that rests elsewhere than a reference of unfinished solves is held against one whose
// solves are finished. It must rest no higher, and truly: pushed at the speed below which hair counts as at rest, and
// with finished solves, it comes back to its place.
bool restsAsSolved(Run& run) {
  sim::SimParams params = run.params;
  params.max_iterations = std::max(params.max_iterations, kSolved);
  const double dt = run.one.pace == Pace::kFixed ? run.one.step : sim::SimParams{}.time_step;
  std::vector<Hair> hairs;
  addReference(run, hairs);
  Hair& pushed = hairs.emplace_back(run.hair.mesh);
  pushed.context.safetyNets() = run.one.nets;
  pushed.state = run.hair.state;
  for (int i = 0; i < run.hair.mesh.vertexCount(); ++i) {
    if (!run.hair.mesh.isRoot(i))
      pushed.state.velocities[i] += kBack * run.hair.mesh.hair_length / kSoon * run.random.direction();
  }
  Rest rests[2];
  for (double t = 0; t < run.one.release && std::min(rests[0].seconds, rests[1].seconds) < kRested; t += dt) {
    for (int k = 0; k < 2; ++k) {
      stepHair(params, run, dt, hairs[k]);
      rests[k].update(hairs[k], dt);
    }
  }
  const bool rest = std::min(rests[0].seconds, rests[1].seconds) >= kRested;
  return rest && apart(pushed, run.hair).distance < kBack && restsNoHigher(hairs[0], energyOf(run, pushed), run);
}

void waitForRest(Run& run) {
  run.around.stop();
  run.last_intrusion = run.around.intrudes() || run.one.switches ? run.around.time() : run.last_intrusion;
  if (run.one.redraws_parameters) {
    run.params = {};
    run.params.collide = run.one.collide;
  }
  run.params.gust = 0;  // it is an input: as everything else, the wind becomes steady
  std::vector<Hair> references;
  addReference(run, references);
  const double stopped = run.around.time();
  EnergyWatch energy;
  energy.rest = energyOf(run, references[0]);
  bool back = waitUntilBack(run.one.rest, false, references, energy, run);
  run.outcome.with_body = back;
  if (!back && !run.failed()) {
    // The body may have pushed the reference into another rest than the one from the rest shape: either counts.
    if (run.params.collide) addReference(run, references);
    run.params.collide = false;
    back = waitUntilBack(run.one.release, true, references, energy, run);
    if (!back && !run.failed() && run.one.returns) back = run.outcome.other_rest = restsAsSolved(run);
  }
  if (back) run.outcome.back_after = run.around.time() - stopped;
  if (!back && !run.failed() && run.one.returns) {
    run.fail(
        bench::formatted("still %.1f %% of the hair's length from rest %.1f s after the motion stopped",
                         100 * run.outcome.distance, run.around.time() - stopped) +
        ", vertex " + std::to_string(run.outcome.worst_vertex) +
        bench::formatted(", fastest %.1e m/s (%.1e the reference)", fastest(run.hair), fastest(references.back())) +
        bench::formatted(", energy above the reference's: %.1e of its weight times length",
                         (energy.last - energyOf(run, references.back())) / weightOf(run)));
  }
}

}  // namespace

namespace {

// The case with its loop chosen and its rounds in seconds.
StressCase withRounds(StressCase one, Stage& stage) {
  if (!one.loop.empty()) {
    app::chooseLoop(*app::parseLoop(one.loop), stage.actor);
    stage.settled = stage.actor.hair;
  }
  if (one.rounds > 0)
    one.seconds = std::clamp(one.rounds * stage.actor.playedClip().duration() / one.speed, kShortest, kLongest);
  return one;
}

void judgeMotion(Run& run) {
  if (run.one.max_work > 0 && run.outcome.dearest > run.one.max_work)
    run.fail(
        bench::formatted("a step took %.0f units a vertex, more than %.0f", run.outcome.dearest, run.one.max_work));
  if (run.one.by_forces && run.outcome.skin_share > kSkinShare)
    run.fail(bench::formatted("%.2f %% of the strands' points lie %.0f mm under the drawn skin",
                              100 * run.outcome.skin_share, 1e3 * kUnder));
  if (run.one.by_forces && run.outcome.skin_deepest > kSkinDeepest)
    run.fail(bench::formatted("a strand lies %.1f mm under the drawn skin", 1e3 * run.outcome.skin_deepest));
  if (run.one.by_forces && run.outcome.guided > 0)
    run.fail(bench::formatted("%d columns were guided home", run.outcome.guided));
}

}  // namespace

Outcome runCase(const StressCase& one, std::uint64_t seed, bool trace, StageStore& stages) {
  if (findClip(one.clip).empty()) {
    Outcome skipped;
    skipped.verdict = Verdict::kSkipped;
    skipped.fault = one.clip + " is not here";
    return skipped;
  }
  Stage& stage = stages.stage(one);
  const double started = bench::cpuSeconds();
  const StressCase timed = withRounds(one, stage);
  Run run(timed, seed, stage);
  run.trace = trace;
  playMotion(run);
  judgeMotion(run);
  if (one.meets && run.met == 0) run.fail("the body that was added never met the hair");
  if (!run.failed()) waitForRest(run);
  run.outcome.iterations = static_cast<double>(run.iterations) / std::max(1, run.outcome.steps);
  run.outcome.unsolved = static_cast<double>(run.unsolved) / std::max(1, run.outcome.steps);
  run.outcome.verdict = run.failed() ? Verdict::kFailed : Verdict::kPassed;
  run.outcome.cpu_seconds = bench::cpuSeconds() - started;
  return run.outcome;
}

Outcome runCaseByMajority(const StressCase& one, std::uint64_t seed, bool trace, StageStore& stages) {
  constexpr double kOtherRounding = 1e-6;
  const Outcome first = runCase(one, seed, trace, stages);
  if (first.verdict != Verdict::kFailed || !counts(one)) return first;
  Outcome last;
  for (const double change : {kOtherRounding, -kOtherRounding}) {
    sim::SimParams params;
    for (const auto& [name, value] : one.params) sim::findParam(name)->set(params, value);
    StressCase other = one;
    other.params.emplace_back("gravity", (1 + change) * params.gravity);
    last = runCase(other, seed, trace, stages);
    if (last.verdict != Verdict::kPassed) return first;
  }
  last.fault = first.fault, last.at = first.at;
  return last;
}

}  // namespace stress
