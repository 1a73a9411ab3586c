// Which way each strand of a groom runs: from root to tip, or from tip to root.
#pragma once

#include <vector>

#include "app/groom/inspect/groom_shape.h"

namespace app {

struct StrandDirections {
  SphereFit skull;           // about which the roots lie
  std::vector<bool> turned;  // per strand looked at: it runs from tip to root
  std::size_t turned_count = 0;
  bool certain = false;
};

// Strands run as those that they lie beside, and all of them so that their roots lie about a skull, which the strands
// leave; else as the file has them, where roots lie nearer to a skull so.
StrandDirections strandDirections(const StrandEnds& ends);

// Of every strand of the groom: whether it runs from tip to root. Those that are not looked at go as the one that they
// lie beside, or as most do where that would root them far off the skull.
std::vector<bool> backwardStrands(const Groom& groom);

}  // namespace app
