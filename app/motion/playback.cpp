// The clock that plays a clip, and the loop's seam.
//
// A crossfade of the clip's end with its beginning would mix two different phases of a walk that loops cleanly. Instead
// the difference between the first and the last pose is added to the end of the clip, grown from zero over the blend by
// a cubic whose end value and slope close both the gap in pose and the gap in velocity (the offset form that games call
// inertialization: Bollo 2018, GDC). Where there is no gap nothing changes. Rotations use rotation vectors in the
// joint's frame: q(t) exp(r(t)), r = log(q_last^-1 q_first) at the seam.
#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include "app/motion/clip_sampling.h"
#include "app/motion/motion.h"

namespace app {

namespace {

Vec3 horizontal(const Vec3& v) {
  return {v.x(), 0, v.z()};
}

// Net motion over the ground from the first to the last frame.
struct GroundTravel {
  Vec3 start = Vec3::Zero();   // m, mean of the root joints, horizontal
  Vec3 travel = Vec3::Zero();  // m, horizontal
  double turn = 0;             // rad about y that brings the last frame's heading back to the first's
};

Vec3 rootCentre(const Skeleton& skeleton, const Clip& clip, const ClipMoment& moment) {
  Vec3 sum = Vec3::Zero();
  int roots = 0;
  for (std::size_t j = 0; j < skeleton.joints.size(); ++j) {
    if (skeleton.joints[j].parent >= 0) continue;
    sum += sampleLocal(clip, moment, static_cast<int>(j)).translation();
    ++roots;
  }
  return horizontal(sum / std::max(roots, 1));
}

// The turn is the angle that best aligns all roots' last orientations with their first ones: it maximizes
// sum tr(R_y(turn) R_last R_first^T), and stays defined when the body is upside down.
GroundTravel groundTravel(const Skeleton& skeleton, const Clip& clip) {
  const int last = clip.frameCount() - 1;
  const ClipMoment first_moment{0, 0, 0}, last_moment{last, last, 0};
  GroundTravel ground;
  ground.start = rootCentre(skeleton, clip, first_moment);
  ground.travel = rootCentre(skeleton, clip, last_moment) - ground.start;
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (std::size_t j = 0; j < skeleton.joints.size(); ++j) {
    if (skeleton.joints[j].parent >= 0) continue;
    const int joint = static_cast<int>(j);
    sum += sampleLocal(clip, last_moment, joint).linear() * sampleLocal(clip, first_moment, joint).linear().transpose();
  }
  ground.turn = std::atan2(sum(2, 0) - sum(0, 2), sum(0, 0) + sum(2, 2));
  return ground;
}

// A time of the clip and where the figure is put on the ground then.
struct PlacedMoment {
  ClipMoment moment;
  Rigid placement = Rigid::Identity();
};

PlacedMoment placedMoment(const Skeleton& skeleton, const Clip& clip, const GroundTravel* ground, double time) {
  PlacedMoment placed{clipMoment(clip, time), Rigid::Identity()};
  if (!ground) return placed;
  const double part = std::clamp(time / clip.duration(), 0.0, 1.0);
  const Vec3 centre = rootCentre(skeleton, clip, placed.moment);
  placed.placement = Eigen::Translation3d(centre - ground->start - part * ground->travel) *
                     Eigen::AngleAxisd(part * ground->turn, Vec3::UnitY()) * Eigen::Translation3d(-centre);
  return placed;
}

Rigid placedLocal(const Skeleton& skeleton, const Clip& clip, const PlacedMoment& placed, int joint) {
  const Rigid local = sampleLocal(clip, placed.moment, joint);
  return skeleton.joints[static_cast<std::size_t>(joint)].parent < 0 ? placed.placement * local : local;
}

Vec3 rotationVector(const Eigen::Matrix3d& rotation) {
  const Eigen::AngleAxisd turn(rotation);
  return turn.angle() * turn.axis();
}

Eigen::Matrix3d rotationOf(const Vec3& vector) {
  const double angle = vector.norm();
  if (angle < 1e-12) return Eigen::Matrix3d::Identity();
  return Eigen::AngleAxisd(angle, vector / angle).toRotationMatrix();
}

// The rate of the rotation vector r that gives exp(r) the angular velocity w in its own frame (inverse right Jacobian
// of the exponential map; Chirikjian 2012).
Vec3 rotationVectorRate(const Vec3& r, const Vec3& w) {
  const double angle = r.norm();
  const double square =
      angle < 1e-3 ? 1.0 / 12 : 1 / (angle * angle) - (1 + std::cos(angle)) / (2 * angle * std::sin(angle) + 1e-12);
  return w + 0.5 * r.cross(w) + square * r.cross(r.cross(w));
}

// The gap a joint has between the end of the clip and its start, in value and in velocity.
struct SeamGap {
  Vec3 shift, shift_rate;  // m, m/s, parent frame
  Vec3 turn, turn_rate;    // rad, rad/s, rotation vector in the joint frame
};

// The moments that say how the clip starts and ends: the first three frames, the last three (the first and last three
// of fewer, in order). Velocities at the ends are extrapolated from two frame intervals: differences over one lie half
// a frame off, which would read the acceleration of a clip that loops cleanly as a gap.
using SeamMoments = std::array<PlacedMoment, 6>;

SeamMoments seamMoments(const Skeleton& skeleton, const Clip& clip, const GroundTravel* ground) {
  const int last = clip.frameCount() - 1;
  SeamMoments moments;
  for (int k = 0; k < 3; ++k) {
    moments[static_cast<std::size_t>(k)] = placedMoment(skeleton, clip, ground, std::min(k, last) * clip.frame_time);
    moments[static_cast<std::size_t>(5 - k)] =
        placedMoment(skeleton, clip, ground, std::max(last - k, 0) * clip.frame_time);
  }
  return moments;
}

// Values of the two frame intervals next to an end, extrapolated to the end.
Vec3 atEnd(const Clip& clip, const Vec3& nearest, const Vec3& next) {
  return (clip.frameCount() > 2 ? Vec3(1.5 * nearest - 0.5 * next) : nearest) / clip.frame_time;
}

SeamGap seamGap(const Skeleton& skeleton, const Clip& clip, const SeamMoments& seam, int joint) {
  std::array<Rigid, 6> local;
  for (std::size_t k = 0; k < local.size(); ++k) local[k] = placedLocal(skeleton, clip, seam[k], joint);
  const Rigid &first = local[0], &last = local[5];
  const auto moved = [&](std::size_t k) { return Vec3(local[k + 1].translation() - local[k].translation()); };
  const auto turned = [&](std::size_t k) {
    return rotationVector(local[k].linear().transpose() * local[k + 1].linear());
  };
  SeamGap gap;
  gap.shift = first.translation() - last.translation();
  gap.shift_rate = atEnd(clip, moved(0), moved(1)) - atEnd(clip, moved(4), moved(3));
  const Eigen::Matrix3d across = last.linear().transpose() * first.linear();
  const Vec3 spin_first = atEnd(clip, turned(0), turned(1)), spin_last = atEnd(clip, turned(4), turned(3));
  gap.turn = rotationVector(across);
  gap.turn_rate = rotationVectorRate(gap.turn, spin_first - across.transpose() * spin_last);
  return gap;
}

}  // namespace

void advancePlayback(const Clip& clip, double seconds, Playback& playback) {
  const double duration = clip.duration();
  if (!std::isfinite(playback.time)) playback.time = 0;
  const double step = seconds * playback.speed;
  if (!playback.paused && step > 0 && std::isfinite(step)) playback.time += step;
  if (playback.loop) {
    playback.time = std::fmod(playback.time, duration);
    if (playback.time < 0) playback.time += duration;
  } else {
    playback.time = std::clamp(playback.time, 0.0, duration);
  }
}

void poseAt(const Skeleton& skeleton, const Clip& clip, const Playback& playback, Pose& pose,
            std::span<const unsigned char> needed) {
  assert(clip.joint_count == static_cast<int>(skeleton.joints.size()) && clip.frameCount() > 0);
  const double duration = clip.duration();
  const double time = std::isfinite(playback.time) ? std::clamp(playback.time, 0.0, duration) : 0;
  const GroundTravel ground = playback.in_place ? groundTravel(skeleton, clip) : GroundTravel{};
  const GroundTravel* placing = playback.in_place ? &ground : nullptr;
  const PlacedMoment now = placedMoment(skeleton, clip, placing, time);

  const double blend = std::clamp(playback.blend, 0.0, duration);
  const double part = blend > 0 ? (time - (duration - blend)) / blend : 0;  // of the blend, 0 to 1
  const bool blending = playback.loop && clip.frameCount() > 1 && part > 0;
  SeamMoments seam;
  if (blending) seam = seamMoments(skeleton, clip, placing);
  const double value_weight = part * part * (3 - 2 * part), rate_weight = blend * part * part * (part - 1);

  pose.world.resize(skeleton.joints.size(), Rigid::Identity());
  for (std::size_t j = 0; j < skeleton.joints.size(); ++j) {
    if (!needed.empty() && !needed[j]) continue;
    Rigid local = placedLocal(skeleton, clip, now, static_cast<int>(j));
    if (blending) {
      const SeamGap gap = seamGap(skeleton, clip, seam, static_cast<int>(j));
      local.translation() += value_weight * gap.shift + rate_weight * gap.shift_rate;
      local.linear() *= rotationOf(value_weight * gap.turn + rate_weight * gap.turn_rate);
    }
    const int parent = skeleton.joints[j].parent;
    pose.world[j] = parent < 0 ? local : pose.world[static_cast<std::size_t>(parent)] * local;
  }
}

}  // namespace app
