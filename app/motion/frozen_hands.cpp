#include "app/motion/frozen_hands.h"

#include <algorithm>
#include <cstdio>

#include "app/figure/character_roles.h"

namespace app {

namespace {

constexpr double kKeptTurn = 1e-9;       // rad, from one frame to the next: it keeps its turn
constexpr double kShortestFreeze = 0.5;  // s
constexpr double kArmTurned = 0.2;       // rad, of the arm above in that time, at least
constexpr double kOfOthers = 0.9;        // of the other frames: it moves

double stepTurn(const Clip& clip, int frame, int joint) {
  const auto at = [&](int f) {
    return static_cast<std::size_t>(f) * static_cast<std::size_t>(clip.joint_count) + static_cast<std::size_t>(joint);
  };
  return clip.rotations[at(frame - 1)].angularDistance(clip.rotations[at(frame)]);
}

struct Freeze {
  int first = 0, last = 0;  // frames
};

// The longest in which the joint keeps its turn; none where it does so in more of the others.
Freeze longestFreeze(const Clip& clip, int joint) {
  Freeze longest;
  int first = 0, moved = 0;
  for (int f = 1; f < clip.frameCount(); ++f) {
    if (stepTurn(clip, f, joint) > kKeptTurn) {
      first = f;
      ++moved;
    } else if (f - first > longest.last - longest.first) {
      longest = {first, f};
    }
  }
  const int others = clip.frameCount() - 1 - (longest.last - longest.first);
  return moved >= kOfOthers * others && moved > 0 ? longest : Freeze{};
}

}  // namespace

std::string frozenHands(const Skeleton& skeleton, const Clip& clip) {
  std::string text;
  const auto look = [&](int joint, int above) {
    if (joint < 0 || above < 0) return;
    const Freeze still = longestFreeze(clip, joint);
    if ((still.last - still.first) * clip.frame_time < kShortestFreeze) return;
    double arm = 0;
    for (int f = still.first + 1; f <= still.last; ++f) arm += stepTurn(clip, f, above);
    if (arm < kArmTurned) return;
    char line[140];
    std::snprintf(line, sizeof line, "%s'%.60s' from %.2f to %.2f s", text.empty() ? "" : ", ",
                  skeleton.joints[static_cast<std::size_t>(joint)].name.c_str(), still.first * clip.frame_time,
                  still.last * clip.frame_time);
    text += line;
  };
  for (const ArmRoles& arm : rolesAtRest(skeleton).arms) {
    look(arm.fore, arm.upper);
    look(arm.hand, arm.fore);
  }
  return text.empty() ? "" : "frozen while the arm moves, and left so: " + text;
}

}  // namespace app
