// The clock that plays a clip, round after round.
#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "app/figure/character.h"

namespace app {

// What a figure does at its clip's end.
enum class LoopKind {
  kAuto,     // in place or going on, whichever suits the clip: see clipLoop
  kGoOn,     // the next round begins where the figure is, facing as it does
  kInPlace,  // the figure stays about its place
  kStop,     // it stands in the last pose
  kNone      // the clip begins again as it was captured, without a blend
};

// In the order of LoopKind.
inline constexpr std::array<std::string_view, 5> kLoopNames{"auto", "go-on", "in-place", "stop", "none"};
inline std::string_view loopName(LoopKind kind) {
  return kLoopNames[static_cast<std::size_t>(kind)];
}
inline std::optional<LoopKind> parseLoop(std::string_view name) {
  const auto at = std::find(kLoopNames.begin(), kLoopNames.end(), name);
  if (at == kLoopNames.end()) return std::nullopt;
  return static_cast<LoopKind>(at - kLoopNames.begin());
}

// A place on the ground and a heading: turned about y, then shifted.
struct GroundPlace {
  double x = 0, z = 0, turn = 0;  // m, m, rad
  Rigid rigid() const;
};
GroundPlace operator*(const GroundPlace& outer, const GroundPlace& inner);

// How the rounds of a clip follow each other; found once from the clip.
struct ClipLoop {
  LoopKind kind = LoopKind::kStop;  // never kAuto
  bool treadmill = false;           // in place: travel is taken out evenly, as a treadmill does
  GroundPlace start;                // where the clip's first frame stands, heading left out
  GroundPlace travel;               // from there to its last frame
  double blend = 0;                 // s before the end over which the pose leads into the first one
  double haste = 0;                 // the fastest joint of the blend against the fastest it may be

  // Whether the figure jumps over the ground at the seam.
  bool cuts() const { return kind == LoopKind::kNone || (kind == LoopKind::kInPlace && !treadmill); }
};

// A clip stays in place by itself when it ends facing as it began, to 30 degrees, and its root (the mean of the root
// joints) ends within a tenth of its height of where it began, or never strays more than a quarter of its height from
// even travel along a straight line. Of such clips kAuto makes kInPlace, on a treadmill; of others kGoOn. In place, the
// others travel as they were captured and jump home at the seam.
//
// The blend takes the shortest time, 0.4 s or more, in which no joint turns faster than it does in the clip or than 1.5
// rad/s, by more than a tenth; where all of the clip is too short for that, the least hasty one.
//
// kAuto makes kStop of a clip shorter than a quarter of a second, every kind does of a single frame.
ClipLoop clipLoop(const Skeleton& skeleton, const Clip& clip, LoopKind asked);

// "go-on, blend 0.40 s".
std::string loopText(const ClipLoop& loop);

// Plays a clip: speed 0 to 20 (larger is allowed), pause, scrub, rounds. The first round begins over the origin.
struct Playback {
  double time = 0;  // s into the clip; may be set to any value, poses clamp it to the clip
  double speed = 1;
  bool paused = false;
  ClipLoop loop;
  GroundPlace place;  // where the present round begins
};

// Moves the clock by `seconds` of wall time and returns the rounds begun, however large the step. Negative and
// non-finite seconds or speeds do not move it.
long advancePlayback(const Clip& clip, double seconds, Playback& playback);

// Begins anew, `offset` clip seconds after the start of the first round.
void startPlayback(const Clip& clip, double offset, Playback& playback);

// Pose of the playback. Before a seam the last `blend` seconds lead into the first frame with matching pose and
// velocity, joint by joint, and the rest of the clip is untouched: a clip that already loops is played as it is.
// Allocates only when `pose` grows. With `needed` (one flag a joint, ancestors of needed joints being needed) the other
// joints are left as they were.
void poseAt(const Skeleton& skeleton, const Clip& clip, const Playback& playback, Pose& pose,
            std::span<const unsigned char> needed = {});

// The place from which a clip's first frame stands and faces as a figure of the same skeleton does in `pose`.
GroundPlace placeToGoOn(const Skeleton& skeleton, const Clip& clip, const Pose& pose);

}  // namespace app
