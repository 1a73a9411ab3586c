// Which vertices of a piece are its root edge.
#pragma once

#include <string>
#include <vector>

#include "app/groom/strips/strip_rows.h"

namespace app {

struct StripEnds {
  bool tube = false;
  std::vector<int> root;       // vertices of the root edge or ring
  std::vector<bool> left_out;  // per vertex: inside of a cap
};

// Returns what is wrong with the piece, or "".
std::string findEnds(const StripPatch& patch, const RootMeasure& measure, bool other_end, StripEnds& out);

}  // namespace app
