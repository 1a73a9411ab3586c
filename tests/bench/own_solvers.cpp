#include "tests/bench/own_solvers.h"

#include <cmath>

#include "sim/linear/modified_pcg.h"
#include "tests/bench/cpu_clock.h"

namespace bench {
namespace {

constexpr double kStagnated = 1e-3;  // below it, four rungs without progress end a run

template <class T>
std::vector<sim::V3<T>> converted(const std::vector<Vector3>& from) {
  std::vector<sim::V3<T>> to;
  for (const Vector3& p : from) to.push_back({static_cast<T>(p.x), static_cast<T>(p.y), static_cast<T>(p.z)});
  return to;
}

template <class T>
struct OwnSolver {
  const RecordedMesh& shared;
  const LinearRecord& record;
  Kind kind;
  sim::ColumnMatrix<T> matrix;
  sim::ColumnProduct<T> product;
  sim::Filter<T> filter;
  sim::SolverScratch<T> scratch;
  std::vector<sim::V3<T>> positions, rhs, guess, x;
  std::vector<T> inverse_mass_dt;

  OwnSolver(const RecordedMesh& s, const LinearRecord& r, Kind chosen)
      : shared(s),
        record(r),
        kind(chosen),
        matrix(s.layout, s.columns),
        product(s.layout),
        positions(converted<T>(r.positions)),
        rhs(converted<T>(r.rhs)),
        guess(converted<T>(r.guess)),
        x(guess) {
    matrix.values.assign(r.column_values.begin(), r.column_values.end());
    for (int i = 0; i < s.mesh.vertexCount(); ++i) {
      inverse_mass_dt.push_back(static_cast<T>(1 / (s.mass[i] * s.h)));
      if (r.keep[i].isIdentity(0)) continue;
      filter.vertices.push_back(i);
      sim::M3<T> keep;
      for (int k = 0; k < 9; ++k) keep.m[k] = static_cast<T>(r.keep[i](k / 3, k % 3));
      filter.keep.push_back(keep);
    }
    scratch.resize(s.mesh.vertexCount());
  }

  void setUp(Preconditioner<T>& p) const { p.update(matrix, positions, record.constraints); }

  void solve(Preconditioner<T>& p, int iterations) {
    sim::StopRule<T> stop;
    stop.relative = 0;
    stop.inverse_mass_dt = inverse_mass_dt;
    stop.max_iterations = iterations;
    const auto a = [&](std::span<const sim::V3<T>> d, std::span<sim::V3<T>> q) {
      sim::multiply<T>(matrix, product, d, q);
    };
    sim::solveModifiedPcg<T>(a, rhs, filter, p, stop, scratch, x);
  }

  std::vector<Vector3> solution() const {
    std::vector<Vector3> out;
    for (const sim::V3<T>& p : x) {
      out.push_back({static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z)});
    }
    return out;
  }
};

template <class T>
SolverRun measured(OwnSolver<T> own) {
  SolverRun run;
  std::optional<Preconditioner<T>> fresh;
  run.first_microseconds = medianMicroseconds(
      kSecondsPerRung, [&] { fresh.emplace(own.shared.mesh, own.shared.pattern, own.kind); },
      [&] { own.setUp(*fresh); });
  Preconditioner<T>& preconditioner = *fresh;
  run.set_up_microseconds = medianMicroseconds(
      kSecondsPerRung, [] {}, [&] { own.setUp(preconditioner); });
  double best = 1;
  int without_progress = 0;
  for (const int iterations : kLadder) {
    SolverRung rung;
    rung.iterations = iterations;
    rung.microseconds = medianMicroseconds(
        kSecondsPerRung, [&] { own.x = own.guess; }, [&] { own.solve(preconditioner, iterations); });
    rung.x = own.solution();
    const double residual = relativeResidual(own.shared, own.record, rung.x);
    run.rungs.push_back(std::move(rung));
    without_progress = residual < 0.9 * best ? 0 : without_progress + 1;
    best = std::min(best, residual);
    if (run.rungs.back().microseconds > kLongestSolve) break;
    if (best < kEnough || (best < kStagnated && without_progress > 3)) break;
  }
  return run;
}

}  // namespace

SolverRun runOwnSolver(const RecordedMesh& shared, const LinearRecord& record, Kind kind, sim::Precision precision) {
  SolverRun run = precision == sim::Precision::kDouble ? measured(OwnSolver<double>(shared, record, kind))
                                                       : measured(OwnSolver<float>(shared, record, kind));
  sim::SimParams names;
  names.precision = precision;
  run.solver = nameOf(kind);
  run.precision = paramText(*sim::findParam("precision"), names);
  return run;
}

double relativeResidual(const RecordedMesh& shared, const LinearRecord& record, const std::vector<Vector3>& x) {
  const auto norm = [&](const std::vector<Vector3>& at) {
    const std::vector<Vector3> r = residualOf(record, at);
    double sum = 0;
    for (std::size_t i = 0; i < r.size(); ++i) sum += dot(r[i], r[i]) / shared.mass[i];
    return std::sqrt(sum);
  };
  return norm(x) / norm(record.guess);
}

double displacementError(const RecordedMesh& shared, const LinearRecord& record, const std::vector<Vector3>& x) {
  double largest = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const Vector3 d = x[i] - record.solution[i];
    largest = std::max(largest, dot(d, d));
  }
  return shared.h * std::sqrt(largest);
}

}  // namespace bench
