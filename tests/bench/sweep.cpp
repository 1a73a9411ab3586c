#include "tests/bench/sweep.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "tests/bench/cpu_clock.h"

namespace bench {
namespace {

using sim::Integrator;
using sim::Precision;
using sim::SimParams;
using sim::Solver;

constexpr double kSameTime = 1.02;
constexpr double kLongRun = 1;  // s

std::string choiceName(const char* field, const SimParams& params) {
  return sim::paramText(*sim::findParam(field), params);
}

bool same(const SimParams& a, const SimParams& b) {
  return std::ranges::all_of(sim::paramFields(), [&](const auto& field) { return field.get(a) == field.get(b); });
}

// A relative residual as asked for; from 1e-3 on without the stop by acceleration, which would come first, and from
// 1e-5 on in double precision, which alone gets there.
void setTolerance(double tolerance, SimParams& params) {
  params.tolerance = tolerance;
  if (tolerance < 5e-3) params.acceleration_tolerance = 0;
  if (tolerance < 5e-5) params.precision = Precision::kDouble;
}

}  // namespace

std::vector<SimParams> waysToRun(SweepSize size) {
  std::vector<SimParams> ways{SimParams{}};
  const auto add = [&](const SimParams& way) {
    if (std::none_of(ways.begin(), ways.end(), [&](const SimParams& w) { return same(w, way); })) ways.push_back(way);
  };
  const bool full = size == SweepSize::kFull, quick = size == SweepSize::kQuick;
  const std::vector<double> rates = full    ? std::vector<double>{30, 60, 120, 240, 480, 960}
                                    : quick ? std::vector<double>{30, 60, 120, 240}
                                            : std::vector<double>{30, 60};
  const std::vector<double> tolerances = full    ? std::vector<double>{1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8}
                                         : quick ? std::vector<double>{1e-1, 1e-2, 1e-3}
                                                 : std::vector<double>{1e-1, 1e-2, 1e-3};
  for (const Integrator integrator : {Integrator::kLinearizedEuler, Integrator::kImplicitEuler, Integrator::kBdf2}) {
    if (size == SweepSize::kShort && integrator == Integrator::kImplicitEuler) continue;
    for (const double rate : rates) {
      for (const double tolerance : tolerances) {
        SimParams way;
        way.integrator = integrator;
        way.time_step = 1 / rate;
        setTolerance(tolerance, way);
        add(way);
      }
    }
  }
  const std::vector<double> solver_rates = full ? std::vector<double>{30, 60, 240} : std::vector<double>{60};
  const std::vector<double> solver_tolerances =
      full ? std::vector<double>{1e-1, 1e-2, 1e-3, 1e-4} : std::vector<double>{1e-1, 1e-2, 1e-3};
  for (int solver = 0; solver < static_cast<int>(Solver::kCount); ++solver) {
    const auto named = static_cast<Solver>(solver);
    // `paper` is block-jacobi by another name.
    const bool near_default = named == Solver::kBlockJacobi || named == Solver::kIncomplete;
    if (named == Solver::kPaper || (size == SweepSize::kShort && !near_default)) continue;
    for (const double rate : solver_rates) {
      for (const double tolerance : solver_tolerances) {
        SimParams way;
        way.solver = named;
        way.time_step = 1 / rate;
        way.max_iterations = 2000;
        setTolerance(tolerance, way);
        if (named == Solver::kWarped) way.max_iterations = SimParams{}.max_iterations;
        // A direct solve meets every tolerance.
        if (named != Solver::kDirect || tolerance == 1e-2) add(way);
      }
    }
  }
  for (int precision = 0; precision < static_cast<int>(Precision::kCount); ++precision) {
    SimParams way;
    way.precision = static_cast<Precision>(precision);
    add(way);
    if (!full) continue;
    way.acceleration_tolerance = 0;
    for (const double tolerance : {1e-4, 1e-6}) {
      way.tolerance = tolerance;
      add(way);
    }
  }
  for (const double rate : full ? rates : std::vector<double>{60}) {
    SimParams way;
    way.minimize_deformation = false;
    way.time_step = 1 / rate;
    add(way);
  }
  return ways;
}

std::string Point::name() const {
  char text[200];
  std::snprintf(text, sizeof text, "%s 1/%.0f %s tol %.0e %s%s", choiceName("integrator", params).c_str(),
                1 / params.time_step, choiceName("solver", params).c_str(), params.tolerance,
                choiceName("precision", params).c_str(), params.minimize_deformation ? "" : " no minimization");
  return text;
}

Sweep sweepScene(TrajectoryStage& stage, const Reference& reference, const std::vector<SimParams>& ways, int runs) {
  Sweep sweep;
  sweep.scene = stage.scene();
  sweep.reference_step = reference.step;
  const double length = stage.mesh().hair_length;
  const double seconds = sweep.scene.seconds;
  // An untimed run of each gives its error; the default's says over which samples errors mean something.
  int samples = 0;
  std::vector<std::vector<double>> times(ways.size());
  for (const SimParams& way : ways) {
    Point point;
    point.params = way;
    point.result = stage.run(way);
    if (sweep.points.empty()) samples = comparableSamples(reference, point.result.trajectory, length);
    point.error = difference(point.result.trajectory, reference.trajectory, length, samples);
    const auto [least, most] = std::minmax_element(reference.energy.begin(), reference.energy.begin() + samples);
    for (int s = 0; s < samples; ++s) {
      point.energy_drift += (point.result.energy[s] - reference.energy[s]) / (samples * std::max(*most - *least, 1e-9));
    }
    point.result.trajectory.clear(), point.result.energy.clear();
    sweep.points.push_back(std::move(point));
  }
  sweep.points.front().is_default = true;
  sweep.own_error = reference.ownErrorOver(samples);
  sweep.compared_seconds = static_cast<double>(samples) / kSamplesPerSecond;
  for (int round = 0; round < runs; ++round) {
    for (std::size_t k = 0; k < ways.size(); ++k) {
      if (round >= 2 && sweep.points[k].result.seconds > kLongRun) continue;
      times[k].push_back(1e3 * stage.run(ways[k]).seconds / seconds);
    }
  }
  for (std::size_t k = 0; k < ways.size(); ++k) {
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

Lag lagOfDefault(const Sweep& sweep) {
  const Point& standard = sweep.points.front();
  Lag lag{1, &standard};
  for (const Point& q : sweep.points) {
    const double ratio = standard.fastest / q.fastest;
    if (q.error.rms <= standard.error.rms + sweep.own_error && ratio > lag.ratio) lag = {ratio, &q};
  }
  return lag;
}

}  // namespace bench
