// A strip, sheet or tube as rows of points from its root edge to its tip.
//
// Method: the root edge is found, and vertices are counted from it over edges. In a grid of quads, triangulated or not,
// every edge joins vertices of one row or of two that follow each other, so that the count is the row.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

#include "app/groom/strips/strip_patch.h"

namespace app {

struct StripRows {
  bool tube = false;  // rows are closed rings
  // Root first; all of one length: at least 2 points, of a tube at least 3. A row that a modeller drew to a point is
  // opened to a small share of its neighbour.
  std::vector<std::vector<Eigen::Vector3d>> rows;
  int cut_rows = 0;  // rows at the tip that could not be followed, left out
};

// Mean of the points of a row.
Eigen::Vector3d middleOf(const std::vector<Eigen::Vector3d>& row);

// Of the line through those means, from root to tip; in the rows' unit.
double lineLength(const StripRows& strip);

// How far a point is from where hair is rooted: the lower, the nearer.
using RootMeasure = std::function<double(const Eigen::Vector3d&)>;

// Returns what is wrong with the piece; empty: `out` has its rows. The root is the end whose mean measure is the lower,
// or with `other_end` the other one. Of a sheet that is as wide as long, the sides that differ more are its ends.
std::string stripRows(const StripPatch& patch, const RootMeasure& measure, bool other_end, StripRows& out);

}  // namespace app
