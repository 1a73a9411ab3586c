// Solvers of the libraries that others would use, on the same systems.
#pragma once

#include <string>
#include <vector>

#include "tests/bench/linear_record.h"

namespace bench {

// After so many iterations: the time since the set-up, and the solution.
struct SolverRung {
  int iterations = 0;
  double microseconds = 0;
  std::vector<Vector3> x;
};

struct SolverRun {
  std::string solver, precision;
  double first_microseconds = 0;   // set-up from nothing: analysis of the pattern and all below
  double set_up_microseconds = 0;  // what the next system of the same mesh costs before its first iteration
  std::vector<SolverRung> rungs;
};

// A run ends with the rung that takes so long: what is slower is off the chart.
inline constexpr double kLongestSolve = 2e4;     // microseconds
inline constexpr double kSecondsPerRung = 0.01;  // of repetitions

// Numbers of iterations after which a solve is looked at.
inline const std::vector<int> kLadder{0,  1,  2,  3,   4,   6,   8,   12,  16,  24,  32,
                                      48, 64, 96, 128, 192, 256, 384, 512, 768, 1024};

// Eigen's ConjugateGradient with its diagonal and its incomplete Cholesky preconditioner and its SimplicialLDLT, and
// SuiteSparse's CHOLMOD where the build found it; all in double precision, as they are meant. They know no filters: the
// constrained directions are eliminated beforehand, which is not charged to them, nor is the conversion.
std::vector<SolverRun> runLibrarySolvers(const RecordedMesh& shared, const LinearRecord& record);

}  // namespace bench
