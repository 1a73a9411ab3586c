// The simulator's own solvers on recorded systems.
#pragma once

#include "tests/bench/library_solvers.h"
#include "tests/bench/preconditioners/preconditioner.h"

namespace bench {

// Modified PCG with that preconditioner and precision.
SolverRun runOwnSolver(const RecordedMesh& shared, const LinearRecord& record, Kind kind, sim::Precision precision);

// sqrt(sum |r|^2 / m) of the residual r at x, over that of the warm start.
double relativeResidual(const RecordedMesh& shared, const LinearRecord& record, const std::vector<Vector3>& x);

// m: h times the largest error of a vertex's velocity.
double displacementError(const RecordedMesh& shared, const LinearRecord& record, const std::vector<Vector3>& x);

}  // namespace bench
