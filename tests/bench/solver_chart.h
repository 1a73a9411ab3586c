// Linear solvers on identical systems: residual against microseconds.
#pragma once

#include <string>

namespace bench {

struct SolverChartOptions {
  std::string folder;  // solvers.csv and solvers_<scene>.svg and .png go here
};

// Records systems of three scenes (a head shake without contact, a walk of the large mesh with contacts, a jump at ten
// times its speed) and gives them to Modified PCG with every preconditioner of preconditioners/ in both
// precisions and to the solvers of the libraries. Residuals are accelerations, sqrt(sum |r|^2 / m), over the warm
// start's; displacement errors are h times the largest error of a velocity. Prints a table and writes the CSV and the
// plots.
void runSolverChart(const SolverChartOptions& options);

}  // namespace bench
