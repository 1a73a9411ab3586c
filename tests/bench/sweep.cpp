#include "tests/bench/sweep.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>

#include "tests/bench/cpu_clock.h"

namespace bench {
namespace {

using sim::Integrator;
using sim::Precision;
using sim::SimParams;
using sim::Solver;

constexpr double kSameTime = 1.02;
constexpr double kLongRun = 1;           // s
constexpr double kMinRange = 1e-6;       // J, of the reference's energy: below it there is nothing to drift over
constexpr double kReferenceShare = 0.1;  // of an error that is ranked, at most the reference's own
constexpr double kAlike = 1.1;           // largest errors so near to one another are the same
constexpr double kUnseen = 0.01;         // of lengths and volumes, which does not show
constexpr double kUnseenDepth = 1e-4;    // m

std::string choiceName(const char* field, const SimParams& params) {
  return sim::paramText(*sim::findParam(field), params);
}

bool same(const SimParams& a, const SimParams& b) {
  return std::ranges::all_of(sim::paramFields(), [&](const auto& field) { return field.get(a) == field.get(b); });
}

// A relative residual as asked for; from 1e-3 on without the stops by acceleration and displacement, which would
// come first, and from 1e-5 on in double precision, which alone gets there.
void setTolerance(double tolerance, SimParams& params) {
  params.tolerance = tolerance;
  if (tolerance < 5e-3) params.acceleration_tolerance = params.displacement_tolerance = 0;
  if (tolerance < 5e-5) params.precision = Precision::kDouble;
}

// The ways so far, none twice.
struct ConfigurationList {
  std::vector<SimParams> configurations;
  void add(const SimParams& configuration) {
    if (std::none_of(configurations.begin(), configurations.end(),
                     [&](const SimParams& w) { return same(w, configuration); }))
      configurations.push_back(configuration);
  }
};

void addIntegrators(SweepSize size, ConfigurationList& list) {
  const std::vector<double> rates = size == SweepSize::kFull    ? std::vector<double>{30, 60, 120, 240, 480, 960}
                                    : size == SweepSize::kQuick ? std::vector<double>{30, 60, 120, 240}
                                                                : std::vector<double>{30, 60, 120};
  std::vector<double> tolerances{1e-1, 1e-2, 1e-3};
  if (size == SweepSize::kFull) tolerances.insert(tolerances.end(), {1e-4, 1e-5, 1e-6, 1e-7, 1e-8});
  for (int integrator = 0; integrator < static_cast<int>(Integrator::kCount); ++integrator) {
    for (const double rate : rates) {
      for (const double tolerance : tolerances) {
        SimParams configuration;
        configuration.integrator = static_cast<Integrator>(integrator);
        configuration.time_step = 1 / rate;
        setTolerance(tolerance, configuration);
        list.add(configuration);
      }
    }
  }
}

// The paper's setting (assets/presets/paper.json) in its time's precision: 3x3 blocks, and none of what the other
// solvers have around them: a guess from earlier steps, the bound on a step's energy, the limits of corrections.
void addPaper(SweepSize size, ConfigurationList& list) {
  if (size == SweepSize::kShort) return;
  for (const double tolerance : {1e-2, 1e-3}) {
    SimParams configuration;
    configuration.solver = Solver::kPaper;
    configuration.precision = Precision::kFloat;
    configuration.max_iterations = 2000;
    setTolerance(tolerance, configuration);
    list.add(configuration);
  }
}

void addPrecisions(SweepSize size, ConfigurationList& list) {
  for (int precision = 0; precision < static_cast<int>(Precision::kCount); ++precision) {
    SimParams configuration;
    configuration.precision = static_cast<Precision>(precision);
    list.add(configuration);
    if (size != SweepSize::kFull) continue;
    configuration.acceleration_tolerance = configuration.displacement_tolerance = 0;
    for (const double tolerance : {1e-4, 1e-6}) {
      configuration.tolerance = tolerance;
      list.add(configuration);
    }
  }
}

// Mean of the energy less the reference's over the range of the latter; none where that does not vary, as in one
// sample.
std::optional<double> energyDrift(const RunResult& run, const Reference& reference, int samples) {
  const auto [least, most] = std::minmax_element(reference.energy.begin(), reference.energy.begin() + samples);
  if (*most - *least < kMinRange) return {};
  double sum = 0;
  for (int s = 0; s < samples; ++s) sum += run.energy[s] - reference.energy[s];
  return sum / samples / (*most - *least);
}

Lag fastestOf(const Sweep& sweep, const auto& allowed) {
  const Point& standard = sweep.points.front();
  Lag lag{1, &standard};
  for (const Point& q : sweep.points) {
    const double ratio = standard.fastest / q.fastest;
    if (ratio > lag.ratio && allowed(q)) lag = {ratio, &q};
  }
  return lag;
}

}  // namespace

std::vector<SimParams> configurationsToRun(SweepSize size, bool contacts) {
  ConfigurationList list{{SimParams{}}};
  addIntegrators(size, list);
  addPaper(size, list);
  addPrecisions(size, list);
  const std::vector<double> rates =
      size == SweepSize::kFull ? std::vector<double>{30, 60, 240} : std::vector<double>{60};
  for (const double rate : contacts ? rates : std::vector<double>{}) {
    SimParams configuration;
    configuration.minimize_deformation = false;
    configuration.time_step = 1 / rate;
    list.add(configuration);
  }
  return std::move(list.configurations);
}

std::string Point::name() const {
  char text[200];
  std::snprintf(text, sizeof text, "%s 1/%.0f %s tol %.0e %s%s", choiceName("integrator", params).c_str(),
                1 / params.time_step, choiceName("solver", params).c_str(), params.tolerance,
                choiceName("precision", params).c_str(), params.minimize_deformation ? "" : " no minimization");
  return text;
}

Sweep sweepScene(TrajectoryStage& stage, const Reference& reference, const std::vector<SimParams>& configurations,
                 int runs) {
  Sweep sweep;
  sweep.scene = stage.scene();
  sweep.reference_step = reference.step;
  const double length = stage.mesh().hair_length;
  const double seconds = sweep.scene.seconds;
  // An untimed run of each gives its error; the default's says over which samples errors mean something.
  int samples = 0;
  std::vector<std::vector<double>> times(configurations.size());
  for (const SimParams& configuration : configurations) {
    Point point;
    point.params = configuration;
    point.result = stage.run(configuration);
    if (sweep.points.empty()) samples = comparableSamples(reference, point.result.trajectory, length);
    point.error = difference(point.result.trajectory, reference.trajectory, length, samples);
    point.energy_drift = energyDrift(point.result, reference, samples);
    point.ranked = reference.ownErrorOver(samples) <= kReferenceShare * point.error.rms;
    point.result.trajectory.clear(), point.result.energy.clear();
    sweep.points.push_back(std::move(point));
  }
  sweep.points.front().is_default = true;
  sweep.own_error = reference.ownErrorOver(samples);
  sweep.compared_seconds = static_cast<double>(samples) / kSamplesPerSecond;
  for (int round = 0; round < runs; ++round) {
    for (std::size_t k = 0; k < configurations.size(); ++k) {
      if (round >= 2 && sweep.points[k].result.seconds > kLongRun) continue;
      times[k].push_back(1e3 * stage.run(configurations[k]).seconds / seconds);
    }
  }
  for (std::size_t k = 0; k < configurations.size(); ++k) {
    sweep.points[k].fastest = *std::min_element(times[k].begin(), times[k].end());
    sweep.points[k].median = medianOf(times[k]);
  }
  markFront(sweep);
  return sweep;
}

void markFront(Sweep& sweep) {
  for (Point& p : sweep.points) {
    p.on_front = std::none_of(sweep.points.begin(), sweep.points.end(), [&](const Point& q) {
      return q.fastest * kSameTime < p.fastest && q.error.rms <= p.error.rms + sweep.own_error;
    });
  }
}

double confirmedRatio(TrajectoryStage& stage, const SimParams& slow, const SimParams& fast, int rounds) {
  std::vector<double> ratios;
  for (int round = 0; round < rounds; ++round) {
    const double before = stage.run(slow).seconds, other = stage.run(fast).seconds, after = stage.run(slow).seconds;
    ratios.push_back(0.5 * (before + after) / other);
  }
  return medianOf(ratios);
}

bool Errors::noWorseInAny(const Errors& than, double own_error) const {
  return noWorseInPosition(than, own_error) && most <= kAlike * than.most + own_error &&
         stretch <= std::max(kUnseen, kAlike * than.stretch) && volume <= std::max(kUnseen, kAlike * than.volume) &&
         penetration <= than.penetration + kUnseenDepth;
}

Errors Point::errors() const {
  return {error.rms, error.most, result.worst_stretch, result.volume_error, result.worst_penetration};
}

Lag lagOfDefault(const Sweep& sweep) {
  return fastestOf(
      sweep, [&](const Point& q) { return q.errors().noWorseInAny(sweep.points.front().errors(), sweep.own_error); });
}

Lag lagByPosition(const Sweep& sweep) {
  return fastestOf(sweep, [&](const Point& q) {
    return q.errors().noWorseInPosition(sweep.points.front().errors(), sweep.own_error);
  });
}

}  // namespace bench
