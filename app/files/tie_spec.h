// Hair ties as a scene file has them.
//
//   "ties": [{ "at": "back", "high", "low", "left", "right" or [x, y, z], "radius": 0.02, "side": "all", "left" or
//              "right", "above": -1, "braided": false, "bun": false }]
//   "ties": "buns"                        a name as --tie takes it, one tie alone, or names in the list
// Numbers are metres in the scalp's frame (x to the figure's left, y up, z forward); "above" counts from the head's
// middle, and hair that is rooted lower stays out. Every key may be left out. A bundle goes to the first tie that takes
// it. The hair in the ring is pinned to the head. What hangs from a braided tie is drawn as a plait of three strands,
// what hangs from one with a bun is wound about it and pinned to the head; see app/scene/braid.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "app/files/json_reader.h"
#include "app/styles/style_tie.h"

namespace app {

struct TieSpec {
  std::string place = "back";   // or `at`
  std::optional<sim::Vec3> at;  // m
  double radius = 0.02;         // m
  std::string side;             // all, left or right; empty: that of the place
  double above = -1;            // m over the head's middle
  bool braided = false;         // the tail is drawn as a plait
  bool bun = false;             // it is wound to a bun, as a rope or as a plait
};

inline constexpr std::size_t kMaxTies = 8;
inline constexpr double kThinnestTie = 0.008, kWidestTie = 0.08;  // m

// Throws InputError.
std::vector<TieSpec> readTies(const JsonPlace& place);
nlohmann::json writeTies(const std::vector<TieSpec>& ties);

// From the command line or a panel: none, two (left and right), plait or bun (back), plaits or buns (left and right), a
// place, or JSON as in a scene. Throws InputError.
std::vector<TieSpec> tiesFromText(std::string_view text);

// For messages: "tie high", "ties left and right", "tie at 0, 0.1, -0.2 m".
std::string tieTitle(const std::vector<TieSpec>& ties);

// On a head. A named place stands `radius` and 14 mm off its scalp; that of a bun, two fifths of `radius` and 10 mm. All
// are `lower` (rad about the head's middle) down from where they are by name.
std::vector<HairTie> placeTies(const std::vector<TieSpec>& ties, const Scalp& scalp, double lower = 0);

}  // namespace app
