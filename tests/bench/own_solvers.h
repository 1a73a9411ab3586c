// The simulator's own solvers on recorded systems.
#pragma once

#include "tests/bench/library_solvers.h"

namespace bench {

// Modified PCG of that name and precision; `warped` in mixed precision keeps its factor in 16 bits, as in the program.
SolverRun runOwnSolver(const RecordedMesh& shared, const LinearRecord& record, sim::Solver solver,
                       sim::Precision precision);

// sqrt(sum |r|^2 / m) of the residual r at x, over that of the warm start.
double relativeResidual(const RecordedMesh& shared, const LinearRecord& record, const std::vector<Vector3>& x);

// m: h times the largest error of a vertex's velocity.
double displacementError(const RecordedMesh& shared, const LinearRecord& record, const std::vector<Vector3>& x);

}  // namespace bench
