// The inspector's mends where a groom becomes a hair mesh: what is certain is done, and what else a person asks for.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "app/groom/inspect/groom_inspect.h"

namespace app {

struct MendedFinding {
  GroomFinding finding;
  bool done = false;
};

struct MendReport {
  std::vector<MendedFinding> findings;
  bool unit_known = false;  // points are metres now; else they are in the file's unit
  double unit = 1;          // metres that a unit of the file stood for, where it is known
  bool on_head = false;     // roots lie on the head now, in the median
};

// Puts options of hairmesh-inspect in place of what was found: "--unit cm --up z --turn 180 --reverse all --width-scale
// 0.1
// --width 8e-5 --points 16 --move 0,0.1,0 --drop-far 0.03 --drop-bad --drop-astray --push-out --no-guess", any of them.
// Returns what is wrong with the text, or "". --no-guess leaves out what was found.
std::string readMends(std::string_view text, GroomMends& mends);

// Inspects and mends a groom: what is certain, or else what `wishes` says (as readMends). Throws InputError for wishes
// that cannot be read.
MendReport mendCertain(const GroomHints& hints, const HeadModel* head, const std::string& wishes, Groom& groom);

// One finding a line, with what was done about it.
std::string mendText(const MendReport& report);

}  // namespace app
