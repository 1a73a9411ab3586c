#include <algorithm>
#include <cassert>
#include <cmath>

#include "app/figure/character.h"
#include "app/motion/clip_sampling.h"

namespace app {

ClipMoment clipMoment(const Clip& clip, double time) {
  const int last = clip.frameCount() - 1;
  assert(last >= 0 && clip.frame_time > 0);
  double frame = time / clip.frame_time;
  if (!(frame > 0)) frame = 0;  // NaN as well
  if (frame >= last) return {last, last, 0};
  // k * frame_time / frame_time is not always k: without the snap a frame's own time would give a mixture.
  const double nearest = std::round(frame);
  if (std::abs(frame - nearest) < 1e-9 * std::max(1.0, nearest)) frame = nearest;
  const int first = static_cast<int>(frame);
  return {first, std::min(first + 1, last), frame - first};
}

Rigid sampleLocal(const Clip& clip, const ClipMoment& moment, int joint) {
  const auto at = [&](int frame) {
    return static_cast<std::size_t>(frame) * static_cast<std::size_t>(clip.joint_count) +
           static_cast<std::size_t>(joint);
  };
  const std::size_t a = at(moment.first), b = at(moment.second);
  if (moment.fraction == 0) return Eigen::Translation3d(clip.translations[a]) * clip.rotations[a];
  const Vec3 translation = clip.translations[a] + moment.fraction * (clip.translations[b] - clip.translations[a]);
  return Eigen::Translation3d(translation) * clip.rotations[a].slerp(moment.fraction, clip.rotations[b]);
}

void samplePose(const Skeleton& skeleton, const Clip& clip, double time, Pose& pose) {
  assert(clip.joint_count == static_cast<int>(skeleton.joints.size()));
  const ClipMoment moment = clipMoment(clip, time);
  pose.world.resize(skeleton.joints.size());
  for (std::size_t j = 0; j < skeleton.joints.size(); ++j) {
    const Rigid local = sampleLocal(clip, moment, static_cast<int>(j));
    const int parent = skeleton.joints[j].parent;
    pose.world[j] = parent < 0 ? local : pose.world[static_cast<std::size_t>(parent)] * local;
  }
}

Pose restPose(const Skeleton& skeleton) {
  Pose pose;
  pose.world.reserve(skeleton.joints.size());
  for (const Joint& joint : skeleton.joints) pose.world.push_back(joint.rest_world);
  return pose;
}

}  // namespace app
