// The table of skips: what a frame leaves out because nothing needs it. Each has a name, a switch, a counter, a bound
// on what it may change, and the test that holds it to that bound. The command line (--skip), the window and the
// reports go by this table alone.
#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>

namespace app {

enum SkipId {
  kSkipSleep,
  kSkipUnseen,
  kSkipFarSteps,
  kSkipFarMesh,
  kSkipPose,
  kSkipBones,
  kSkipFrame,
  kSkipRows,
  kSkipShadows,
  kSkipView,
  kSkipShadowView,
  kSkipBodyParts,
  kSkipBodyDetail,
  kSkipStrands,
  kSkipSegments,
  kSkipShadowDetail,
  kSkipSkin,
  kSkipShading,
  kSkipHairLight,
  kSkipSkyVisibility,
  kSkipEvents,
  kSkipCount
};

// One row of the table.
struct Skip {
  SkipId id;
  const char* name;
  const char* stage;   // simulation, character, drawing, window
  const char* counts;  // what its counter counts
  bool exact;          // changes no bit of state and picture
  const char* bound;   // of an approximate one: what it may change at most
  const char* help;
  const char* proof;  // "file: Suite.Test"

  // Whether the time that it saves can be told: what it leaves out is a whole step, which has a usual cost.
  bool timed() const { return id == kSkipSleep || id == kSkipUnseen || id == kSkipFarSteps; }
};

// In panel order; row i has id i.
std::span<const Skip> skipTable();
const Skip* findSkip(std::string_view name);

// What is never done in vain and has no switch, because no state of the program does it.
enum BuiltInId {
  kNoContact,
  kSolvedAtStart,
  kNoNewBalance,
  kNoStiffness,
  kOutOfReach,
  kPausedFrame,
  kNoPicture,
  kHiddenPanels,
  kBuiltInCount
};
struct BuiltInSkip {
  BuiltInId id;
  const char* name;
  const char* counts;  // what its counter counts
  const char* what;
  const char* proof;
};
// Row i has id i.
std::span<const BuiltInSkip> builtInSkips();

// Which skips are on.
struct SkipSet {
  std::array<bool, kSkipCount> on;
  SkipSet() { on.fill(true); }
  bool operator[](SkipId id) const { return on[id]; }
  bool operator==(const SkipSet&) const = default;
};

// "NAME=on|off", "all=off". Returns an empty string, or what is wrong and what would mend it; then nothing changed.
std::string setSkip(std::string_view text, SkipSet& skips);

// How much a frame left out, of how much, and the time (s) that this saved where it can be told (Skip::timed).
struct SkipCount {
  long skipped = 0, of = 0;
  double seconds = 0;
};
using SkipCounts = std::array<SkipCount, kSkipCount>;
using BuiltInCounts = std::array<SkipCount, kBuiltInCount>;

// The table of skips in Markdown.
std::string skipTableText();

}  // namespace app
