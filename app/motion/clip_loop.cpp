// How the rounds of a clip follow each other: where it ends, whether it stays in place, how long its seam takes.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <vector>

#include "app/motion/seam.h"

namespace app {

namespace {

constexpr double kFacesAlike = 30 * std::numbers::pi / 180;  // rad: hips twist in a gait
constexpr double kComesBack = 0.1, kEven = 0.25;             // of the root's height
constexpr double kShortestRound = 0.25;                      // s
constexpr double kShortestBlend = 0.4;                       // s
constexpr double kLonger = 1.25;                             // a blend over the one tried before
constexpr double kSlowTurn = 1.5;                            // rad/s
constexpr double kTooFast = 1.1;
constexpr int kBlendSamples = 48;

GroundPlace travelOf(const Skeleton& skeleton, const Clip& clip) {
  const int last = clip.frameCount() - 1;
  const ClipMoment first_moment{0, 0, 0}, last_moment{last, last, 0};
  const Vec3 way = rootCentre(skeleton, clip, last_moment) - rootCentre(skeleton, clip, first_moment);
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (std::size_t j = 0; j < skeleton.joints.size(); ++j) {
    if (skeleton.joints[j].parent >= 0) continue;
    const int joint = static_cast<int>(j);
    sum += sampleLocal(clip, last_moment, joint).linear() * sampleLocal(clip, first_moment, joint).linear().transpose();
  }
  return {way.x(), way.z(), alignedTurn(sum)};
}

// m, mean over root joints and frames.
double rootHeight(const Skeleton& skeleton, const Clip& clip) {
  double sum = 0;
  int count = 0;
  for (int f = 0; f < clip.frameCount(); ++f) {
    for (std::size_t j = 0; j < skeleton.joints.size(); ++j) {
      if (skeleton.joints[j].parent >= 0) continue;
      sum += sampleLocal(clip, {f, f, 0}, static_cast<int>(j)).translation().y();
      ++count;
    }
  }
  return count > 0 ? std::abs(sum) / count : 0;
}

bool staysInPlace(const Skeleton& skeleton, const Clip& clip, const ClipLoop& loop) {
  const double height = rootHeight(skeleton, clip);
  if (std::abs(loop.travel.turn) > kFacesAlike) return false;
  const Vec3 start(loop.start.x, 0, loop.start.z), travel(loop.travel.x, 0, loop.travel.z);
  if (travel.norm() < kComesBack * height) return true;
  const int last = clip.frameCount() - 1;
  for (int f = 0; f <= last; ++f) {
    const Vec3 even = start + static_cast<double>(f) / last * travel;
    if ((rootCentre(skeleton, clip, {f, f, 0}) - even).norm() > kEven * height) return false;
  }
  return true;
}

double angleBetween(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b) {
  return Eigen::AngleAxisd(a.transpose() * b).angle();
}

// rad/s, per joint: the fastest that it turns against its parent from one frame to the next.
std::vector<double> fastestTurns(const Skeleton& skeleton, const Clip& clip) {
  std::vector<double> fastest(skeleton.joints.size(), 0);
  const std::size_t joints = fastest.size();
  for (std::size_t i = joints; i < clip.rotations.size(); ++i) {
    double& turn = fastest[i % joints];
    turn = std::max(turn, clip.rotations[i - joints].angularDistance(clip.rotations[i]) / clip.frame_time);
  }
  return fastest;
}

// The fastest joint of a blend of so many seconds, against the fastest that it may be.
double hasteOf(const Skeleton& skeleton, const Clip& clip, const ClipLoop& loop, const SeamMoments& seam,
               const std::vector<double>& allowed, double blend) {
  const int samples = std::clamp(static_cast<int>(blend / clip.frame_time), 4, kBlendSamples);
  double haste = 0;
  for (std::size_t j = 0; j < skeleton.joints.size(); ++j) {
    const int joint = static_cast<int>(j);
    const SeamGap gap = seamGap(skeleton, clip, seam, joint);
    Rigid before = Rigid::Identity();
    for (int s = 0; s <= samples; ++s) {
      const double left = blend * (samples - s) / samples;
      const PlacedMoment now = placedMoment(skeleton, clip, loop, clip.duration() - left);
      Rigid local = placedLocal(skeleton, clip, now, joint);
      closeGap(gap, {left, blend}, local);
      const double turn = s > 0 ? angleBetween(before.linear(), local.linear()) * samples / blend : 0;
      haste = std::max(haste, turn / allowed[j]);
      before = local;
    }
  }
  return haste;
}

// The shortest blend that is slow enough, or the least hasty one.
void chooseBlend(const Skeleton& skeleton, const Clip& clip, ClipLoop& loop) {
  std::vector<double> allowed = fastestTurns(skeleton, clip);
  const double fastest = *std::max_element(allowed.begin(), allowed.end());
  for (double& turn : allowed) turn = std::max({turn, std::min(kSlowTurn, fastest), 1e-6});
  const SeamMoments seam = seamMoments(skeleton, clip, loop);
  const double longest = clip.duration();
  for (double blend = std::min(kShortestBlend, longest);; blend = std::min(kLonger * blend, longest)) {
    const double haste = hasteOf(skeleton, clip, loop, seam, allowed, blend);
    if (loop.blend == 0 || haste < loop.haste) loop.blend = blend, loop.haste = haste;
    if (haste <= kTooFast || blend >= longest) return;
  }
}

}  // namespace

std::string loopText(const ClipLoop& loop) {
  std::string text(loopName(loop.kind));
  char blend[32];
  std::snprintf(blend, sizeof blend, ", blend %.2f s", loop.blend);
  return loop.blend > 0 ? text + blend : text;
}

ClipLoop clipLoop(const Skeleton& skeleton, const Clip& clip, LoopKind asked) {
  ClipLoop loop;
  loop.kind = asked;
  const Vec3 start = rootCentre(skeleton, clip, {0, 0, 0});
  loop.start = {start.x(), start.z(), 0};
  if (clip.frameCount() < 2) {
    loop.kind = LoopKind::kStop;
    return loop;
  }
  loop.travel = travelOf(skeleton, clip);
  const bool stays = staysInPlace(skeleton, clip, loop);
  if (asked == LoopKind::kAuto && clip.duration() < kShortestRound) {
    loop.kind = LoopKind::kStop;
    return loop;
  }
  if (asked == LoopKind::kAuto) loop.kind = stays ? LoopKind::kInPlace : LoopKind::kGoOn;
  if (loop.kind != LoopKind::kInPlace && loop.kind != LoopKind::kGoOn) return loop;
  loop.treadmill = loop.kind == LoopKind::kInPlace && stays;
  chooseBlend(skeleton, clip, loop);
  return loop;
}

}  // namespace app
