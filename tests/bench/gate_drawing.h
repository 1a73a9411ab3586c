// The gate's figures of drawing time against the picture's error.
#pragma once

#include <functional>

#include "tests/bench/gate.h"

namespace bench {

// A short sweep of every scene: how many times the fastest setting with no more error is faster than the default.
// `add` takes each as it is known. Without OpenGL there is none. Throws app::InputError.
void addDrawingFigures(const GateOptions& options, const std::function<void(const Figure&)>& add);

}  // namespace bench
