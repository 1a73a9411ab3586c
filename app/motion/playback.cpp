#include "app/motion/playback.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

#include "app/motion/seam.h"

namespace app {

namespace {

// As many rounds on, `round` being the way over one.
GroundPlace roundsOn(const GroundPlace& place, GroundPlace round, long rounds) {
  GroundPlace way;
  for (; rounds > 0; rounds /= 2) {
    if (rounds % 2) way = way * round;
    round = round * round;
  }
  return place * way;
}

void moveTime(const Clip& clip, double clip_seconds, Playback& playback, long& rounds) {
  const double duration = clip.duration();
  playback.time += clip_seconds;
  if (playback.loop.kind == LoopKind::kStop) {
    playback.time = std::clamp(playback.time, 0.0, duration);
    return;
  }
  const double turned = std::floor(playback.time / duration);
  playback.time = std::fmod(playback.time, duration);
  if (playback.time < 0) playback.time += duration;
  rounds = turned > 0 ? static_cast<long>(std::min(turned, 1e15)) : 0;
  if (playback.loop.kind == LoopKind::kGoOn) playback.place = roundsOn(playback.place, playback.loop.travel, rounds);
}

}  // namespace

Rigid GroundPlace::rigid() const {
  return Eigen::Translation3d(x, 0, z) * Eigen::AngleAxisd(turn, Vec3::UnitY());
}

GroundPlace operator*(const GroundPlace& outer, const GroundPlace& inner) {
  const double c = std::cos(outer.turn), s = std::sin(outer.turn);
  return {outer.x + c * inner.x + s * inner.z, outer.z - s * inner.x + c * inner.z,
          std::remainder(outer.turn + inner.turn, 2 * std::numbers::pi)};
}

long advancePlayback(const Clip& clip, double seconds, Playback& playback) {
  if (!std::isfinite(playback.time)) playback.time = 0;
  const double step = seconds * playback.speed;
  const bool moves = !playback.paused && step > 0 && std::isfinite(step);
  long rounds = 0;
  moveTime(clip, moves ? step : 0, playback, rounds);
  return rounds;
}

void startPlayback(const Clip& clip, double offset, Playback& playback) {
  playback.time = 0;
  playback.place = {};
  long rounds = 0;
  moveTime(clip, std::isfinite(offset) ? std::max(0.0, offset) : 0, playback, rounds);
}

void poseAt(const Skeleton& skeleton, const Clip& clip, const Playback& playback, Pose& pose,
            std::span<const unsigned char> needed) {
  assert(clip.joint_count == static_cast<int>(skeleton.joints.size()) && clip.frameCount() > 0);
  const ClipLoop& loop = playback.loop;
  const double duration = clip.duration();
  const double time = std::isfinite(playback.time) ? std::clamp(playback.time, 0.0, duration) : 0;
  const PlacedMoment now = placedMoment(skeleton, clip, loop, time);
  const Rigid place = playback.place.rigid();

  const bool blending = loop.blend > 0 && time > duration - loop.blend;
  SeamMoments seam;
  if (blending) seam = seamMoments(skeleton, clip, loop);
  const SeamWeights weights(duration - time, loop.blend);

  pose.world.resize(skeleton.joints.size(), Rigid::Identity());
  for (std::size_t j = 0; j < skeleton.joints.size(); ++j) {
    if (!needed.empty() && !needed[j]) continue;
    Rigid local = placedLocal(skeleton, clip, now, static_cast<int>(j));
    if (blending) closeGap(seamGap(skeleton, clip, seam, static_cast<int>(j)), weights, local);
    const int parent = skeleton.joints[j].parent;
    pose.world[j] = (parent < 0 ? place : pose.world[static_cast<std::size_t>(parent)]) * local;
  }
}

GroundPlace placeToGoOn(const Skeleton& skeleton, const Clip& clip, const Pose& pose) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  Vec3 centre = Vec3::Zero();
  int roots = 0;
  for (std::size_t j = 0; j < skeleton.joints.size(); ++j) {
    if (skeleton.joints[j].parent >= 0) continue;
    sum += pose.world[j].linear() * sampleLocal(clip, {0, 0, 0}, static_cast<int>(j)).linear().transpose();
    centre += pose.world[j].translation();
    ++roots;
  }
  centre /= std::max(roots, 1);
  return {centre.x(), centre.z(), alignedTurn(sum)};
}

}  // namespace app
