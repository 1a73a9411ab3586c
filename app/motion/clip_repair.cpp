#include "app/motion/clip_repair.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

namespace app {

namespace {

constexpr int kLongestFault = 3, kAround = 3;  // frames
constexpr double kFactor = 4, kCatchesUp = 1.5;
constexpr double kPopTurn = 0.15, kPopWay = 0.05;      // rad, m
constexpr double kJumpWay = 0.25, kJumpSpeed = 15;     // m, m/s
constexpr double kSameTurn = 1e-9, kSameWay = 1e-9;    // rad, m: a frame that repeats another
constexpr double kMovesTurn = 1e-4, kMovesWay = 1e-4;  // and one that does not

// A clip's frames by joint.
struct Frames {
  Clip& clip;
  int count() const { return clip.frameCount(); }
  std::size_t at(int frame, int joint) const {
    return static_cast<std::size_t>(frame) * static_cast<std::size_t>(clip.joint_count) +
           static_cast<std::size_t>(joint);
  }
  double turn(int a, int b, int joint) const {
    return clip.rotations[at(a, joint)].angularDistance(clip.rotations[at(b, joint)]);
  }
  double way(int a, int b, int joint) const {
    return (clip.translations[at(a, joint)] - clip.translations[at(b, joint)]).norm();
  }
  // Puts the frames between two on the straight way from one to the other.
  void join(int from, int to, int joint) {
    const std::size_t a = at(from, joint), b = at(to, joint);
    for (int f = from + 1; f < to; ++f) {
      const double part = static_cast<double>(f - from) / (to - from);
      clip.rotations[at(f, joint)] = clip.rotations[a].slerp(part, clip.rotations[b]);
      clip.translations[at(f, joint)] = (1 - part) * clip.translations[a] + part * clip.translations[b];
    }
  }
};

// Largest over the joints, of the step from one frame to the next, in units of the smallest that counts as one.
double stepOf(const Frames& frames, int frame, double turn, double way) {
  double most = 0;
  for (int j = 0; j < frames.clip.joint_count; ++j)
    most = std::max({most, frames.turn(frame - 1, frame, j) / turn, frames.way(frame - 1, frame, j) / way});
  return most;
}

int mendDropped(Frames frames) {
  const auto repeats = [&](int frame) { return stepOf(frames, frame, kSameTurn, kSameWay) < 1; };
  const auto moves = [&](int frame) {
    return frame < frames.count() ? stepOf(frames, frame, kMovesTurn, kMovesWay) : 0;
  };
  int mended = 0;
  for (int f = 2; f + 1 < frames.count(); ++f) {
    if (!repeats(f)) continue;
    int next = f + 1;
    while (next < frames.count() && repeats(next)) ++next;
    if (next - f <= kLongestFault && moves(f - 1) > 1 &&
        moves(next) > kCatchesUp * 0.5 * (moves(f - 1) + moves(next + 1))) {
      for (int j = 0; j < frames.clip.joint_count; ++j) frames.join(f - 1, next, j);
      mended += next - f;
    }
    f = next;
  }
  return mended;
}

// The largest of the steps of `measure` next to frames `first` (that of a fault) to `next` (the first after it);
// infinite where there are none.
template <class Measure>
double stepsAround(const Frames& frames, int first, int next, const Measure& measure) {
  if (first <= 1 && next >= frames.count() - 1) return std::numeric_limits<double>::infinity();
  double most = 0;
  for (int f = std::max(1, first - kAround); f < first; ++f) most = std::max(most, measure(f - 1, f));
  for (int f = next + 1; f <= std::min(frames.count() - 1, next + kAround); ++f)
    most = std::max(most, measure(f - 1, f));
  return most;
}

// Whether frames `first` to before `next` leave the path of the frames around them, by the given way of measuring.
template <class Measure>
bool leavesPath(const Frames& frames, int first, int next, double least, const Measure& measure) {
  const double step = std::min(measure(first - 1, first), measure(next - 1, next));
  if (step < least || step < kFactor * measure(first - 1, next) / (next - first + 1)) return false;
  return step > kFactor * stepsAround(frames, first, next, measure);
}

struct Pops {
  int mended = 0, frame = 0, joint = 0;  // in all; the largest one
  double largest = 0;                    // in units of the smallest
};

Pops mendPops(const Skeleton& skeleton, Frames frames) {
  Pops pops;
  for (int j = 0; j < frames.clip.joint_count; ++j) {
    const bool root = skeleton.joints[static_cast<std::size_t>(j)].parent < 0;
    const auto turn = [&](int a, int b) { return frames.turn(a, b, j); };
    const auto way = [&](int a, int b) { return frames.way(a, b, j); };
    for (int f = 1; f + 1 < frames.count(); ++f) {
      const double size = std::max(turn(f - 1, f) / kPopTurn, root ? way(f - 1, f) / kPopWay : 0);
      if (size < 1) continue;
      for (int next = f + 1; next <= std::min(f + kLongestFault, frames.count() - 1); ++next) {
        if (!leavesPath(frames, f, next, kPopTurn, turn) && !(root && leavesPath(frames, f, next, kPopWay, way)))
          continue;
        frames.join(f - 1, next, j);
        pops.mended += next - f;
        if (size > pops.largest) pops.largest = size, pops.frame = f, pops.joint = j;
        break;
      }
    }
  }
  return pops;
}

// Over the ground, mean of the root joints.
Vec3 groundCentre(const Skeleton& skeleton, const Frames& frames, int frame) {
  Vec3 sum = Vec3::Zero();
  int roots = 0;
  for (int j = 0; j < frames.clip.joint_count; ++j) {
    if (skeleton.joints[static_cast<std::size_t>(j)].parent >= 0) continue;
    sum += frames.clip.translations[frames.at(frame, j)];
    ++roots;
  }
  return Vec3(sum.x(), 0, sum.z()) / std::max(roots, 1);
}

int mendJumps(const Skeleton& skeleton, Frames frames) {
  std::vector<Vec3> centres;
  for (int f = 0; f < frames.count(); ++f) centres.push_back(groundCentre(skeleton, frames, f));
  const auto way = [&](int a, int b) {
    return (centres[static_cast<std::size_t>(a)] - centres[static_cast<std::size_t>(b)]).norm();
  };
  const double least = std::max(kJumpWay, kJumpSpeed * frames.clip.frame_time);
  Vec3 carried = Vec3::Zero();
  int jumps = 0;
  for (int f = 1; f < frames.count(); ++f) {
    if (way(f - 1, f) > least && way(f - 1, f) > kFactor * stepsAround(frames, f, f, way)) {
      carried += centres[static_cast<std::size_t>(f) - 1] - centres[static_cast<std::size_t>(f)];
      ++jumps;
    }
    for (int j = 0; j < frames.clip.joint_count && jumps > 0; ++j) {
      if (skeleton.joints[static_cast<std::size_t>(j)].parent < 0) frames.clip.translations[frames.at(f, j)] += carried;
    }
  }
  return jumps;
}

}  // namespace

std::vector<std::string> repairClip(const Skeleton& skeleton, Clip& clip) {
  std::vector<std::string> notes;
  char line[200];
  const auto note = [&](const char* format, auto... values) {
    std::snprintf(line, sizeof line, format, values...);
    notes.emplace_back(line);
  };
  if (const int dropped = mendDropped({clip}); dropped > 0) note("%d dropped frames: made even steps", dropped);
  if (const Pops pops = mendPops(skeleton, {clip}); pops.mended > 0) {
    note("pops: %d frames of joints put back on their path, the largest of '%.60s' in frame %d", pops.mended,
         skeleton.joints[static_cast<std::size_t>(pops.joint)].name.c_str(), pops.frame);
  }
  if (const int jumps = mendJumps(skeleton, {clip}); jumps > 0)
    note("jumps: %d over the ground, carried over: the figure goes on from where it was", jumps);
  return notes;
}

}  // namespace app
