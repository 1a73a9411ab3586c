#include "tests/bench/library_solvers.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Sparse>

#include "tests/bench/cpu_clock.h"
#ifdef HAIRMESH_CHOLMOD
#include <Eigen/CholmodSupport>
#endif

namespace bench {
namespace {

using Sparse = Eigen::SparseMatrix<double>;
using Vector = Eigen::VectorXd;


// Unit vectors of the free directions of every vertex; together the columns of Q, x = Q y + what is prescribed.
struct FreeBasis {
  std::vector<int> first{0};                // per vertex: its first unknown
  std::vector<Eigen::Matrix3d> directions;  // as many columns as unknowns
};

FreeBasis freeBasis(const LinearRecord& record) {
  FreeBasis basis;
  for (const Eigen::Matrix3d& keep : record.keep) {
    const int count = static_cast<int>(std::lround(keep.trace()));
    Eigen::Matrix3d directions = Eigen::Matrix3d::Identity();
    if (count == 1 || count == 2) {
      const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> split(keep);  // eigenvalues ascend: the kept ones come last
      directions = split.eigenvectors().rowwise().reverse();
    }
    basis.directions.push_back(directions);
    basis.first.push_back(basis.first.back() + count);
  }
  return basis;
}

Eigen::Matrix3d dense(const sim::M3<double>& m) {
  return Eigen::Map<const Eigen::Matrix3d>(m.m).transpose();
}

// Q^T A Q, Q^T (b - A guess) and the way back.
struct ReducedSystem {
  FreeBasis basis;
  Sparse matrix;
  Vector rhs;
  const LinearRecord& record;

  ReducedSystem(const RecordedMesh& shared, const LinearRecord& r) : basis(freeBasis(r)), record(r) {
    const int unknowns = basis.first.back();
    std::vector<Eigen::Triplet<double>> entries;
    const auto add = [&](int i, int j, const Eigen::Matrix3d& block) {
      const Eigen::Matrix3d turned = basis.directions[i].transpose() * block * basis.directions[j];
      for (int a = 0; a < basis.first[i + 1] - basis.first[i]; ++a) {
        for (int b = 0; b < basis.first[j + 1] - basis.first[j]; ++b) {
          entries.emplace_back(basis.first[i] + a, basis.first[j] + b, turned(a, b));
        }
      }
    };
    for (int i = 0; i < shared.pattern.size; ++i) {
      add(i, i, dense(r.matrix.diagonal[i]));
      for (int k = shared.pattern.row_first[i]; k < shared.pattern.row_first[i + 1]; ++k) {
        add(i, shared.pattern.columns[k], dense(r.matrix.lower[k]));
        add(shared.pattern.columns[k], i, dense(r.matrix.lower[k]).transpose());
      }
    }
    matrix.resize(unknowns, unknowns);
    matrix.setFromTriplets(entries.begin(), entries.end());
    rhs = Vector::Zero(unknowns);
    const std::vector<Vector3> residual = residualOf(r, r.guess);
    for (std::size_t i = 0; i < residual.size(); ++i) {
      const sim::Vec3 turned = basis.directions[i].transpose() * sim::Vec3(residual[i].x, residual[i].y, residual[i].z);
      for (int a = 0; a < basis.first[i + 1] - basis.first[i]; ++a) rhs[basis.first[i] + a] = turned[a];
    }
  }

  std::vector<Vector3> solutionOf(const Vector& y) const {
    std::vector<Vector3> x = record.guess;
    for (std::size_t i = 0; i < x.size(); ++i) {
      sim::Vec3 d = sim::Vec3::Zero();
      for (int a = 0; a < basis.first[i + 1] - basis.first[i]; ++a) {
        d += basis.directions[i].col(a) * y[basis.first[i] + a];
      }
      x[i] += Vector3{d.x(), d.y(), d.z()};
    }
    return x;
  }
};

// Set-up times, and the solve after `iterations` as `solve(solver, iterations)` does it.
template <class Solver, class Solve>
SolverRun measured(const char* name, const ReducedSystem& system, std::span<const int> ladder, const Solve& solve) {
  SolverRun run;
  run.solver = name;
  run.precision = "double";
  Solver solver;
  run.first_microseconds = medianMicroseconds(
      kSecondsPerRung, [] {},
      [&] {
        Solver fresh;
        fresh.analyzePattern(system.matrix);
        fresh.factorize(system.matrix);
      });
  solver.analyzePattern(system.matrix);
  run.set_up_microseconds = medianMicroseconds(
      kSecondsPerRung, [] {}, [&] { solver.factorize(system.matrix); });
  for (const int iterations : ladder) {
    Vector y;
    SolverRung rung;
    rung.iterations = iterations;
    rung.microseconds = medianMicroseconds(
        kSecondsPerRung, [] {}, [&] { y = solve(solver, iterations); });
    rung.x = system.solutionOf(y);
    run.rungs.push_back(std::move(rung));
    const bool solved = (system.rhs - system.matrix * y).norm() < kEnough * system.rhs.norm();
    if (solved || run.rungs.back().microseconds > kLongestSolve) break;
  }
  return run;
}

}  // namespace

std::vector<SolverRun> runLibrarySolvers(const RecordedMesh& shared, const LinearRecord& record) {
  const ReducedSystem system(shared, record);
  const auto iterate = [&](auto& solver, int iterations) -> Vector {
    if (iterations == 0) return Vector::Zero(system.rhs.size());
    solver.setMaxIterations(iterations);
    solver.setTolerance(0);
    return solver.solve(system.rhs);
  };
  const auto direct = [&](auto& solver, int) -> Vector { return solver.solve(system.rhs); };
  const std::vector<int> once{1};
  using Diagonal = Eigen::ConjugateGradient<Sparse, Eigen::Lower | Eigen::Upper>;
  using Incomplete = Eigen::ConjugateGradient<Sparse, Eigen::Lower | Eigen::Upper, Eigen::IncompleteCholesky<double>>;
  std::vector<SolverRun> runs;
  runs.push_back(measured<Diagonal>("Eigen CG, diagonal", system, kLadder, iterate));
  runs.push_back(measured<Incomplete>("Eigen CG, incomplete", system, kLadder, iterate));
  runs.push_back(measured<Eigen::SimplicialLDLT<Sparse>>("Eigen SimplicialLDLT", system, once, direct));
#ifdef HAIRMESH_CHOLMOD
  runs.push_back(measured<Eigen::CholmodSupernodalLLT<Sparse>>("CHOLMOD supernodal", system, once, direct));
#endif
  return runs;
}

}  // namespace bench
