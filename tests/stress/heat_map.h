// The heat maps of docs/stability.md.
#pragma once

#include <string>
#include <vector>

#include "tests/stress/report.h"

namespace stress {

// Writes stability_map.svg and .png into `folder`: a panel for each of the families speed, step, state and upset, its
// cells coloured by the time that the slowest case took to come back, or marked where one failed. Does nothing but say
// so where gnuplot is not installed.
void drawHeatMaps(const std::vector<Result>& results, const std::string& folder);

}  // namespace stress
