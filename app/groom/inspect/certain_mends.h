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

// What --mends is for.
inline constexpr const char* kMendsHelp =
    "What mends hair of curves (of strips: --up y|z alone; of hair meshes: --unit, --up, --turn, --scale, --move), "
    "beside what is certain, which is mended by itself, and "
    "said: any, in quotes, of --unit m|cm|mm|in|ft, --up y|z|-y|-z|x|-x, --turn DEGREES, --reverse none|found|all, "
    "--width-scale X, --width M, "
    "--points N, --scale X, --move X,Y,Z, --drop-far M, --drop-bad, --drop-astray, --push-out, --no-guess; "
    "hairmesh-inspect --help tells of each";

// Puts any of these options, with blanks between, in place of what was found; --no-guess leaves that out. Returns what
// is wrong with the text, or "".
std::string readMends(std::string_view text, GroomMends& mends);

// Inspects and mends a groom: what is certain, or else what `wishes` says (as readMends). Throws InputError for wishes
// that cannot be read.
MendReport mendCertain(const GroomHints& hints, const HeadModel* head, const std::string& wishes, Groom& groom);

// One finding a line, with what was done about it.
std::string mendText(const MendReport& report);

}  // namespace app
