// The gate's figures of motion: whether the governor holds its budget, and whether resolutions move alike.
#pragma once

#include <functional>

#include "tests/bench/gate.h"

namespace bench {

// Long hair walks under the governor at several budgets: a frame's milliseconds over the budget.
void addBudgetFigures(const std::function<void(const Figure&)>& add);

// A head shake in three resolutions: how far the tips' paths lie from those of the high one, over their own way.
void addConsistencyFigures(const std::function<void(const Figure&)>& add);

}  // namespace bench
