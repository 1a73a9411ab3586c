// The gate's figures that a sweep answers.
#pragma once

#include <functional>

#include "tests/bench/gate.h"

namespace bench {

// A short sweep of every scene: how many times the fastest configuration with an equal or smaller error is faster than
// the default, and the reference's own error over the smallest error of the sweep. `add` takes each as it is known.
void addSweepFigures(const GateOptions& options, const std::function<void(const Figure&)>& add);

}  // namespace bench
