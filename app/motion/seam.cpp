#include "app/motion/seam.h"

#include <algorithm>
#include <cmath>

namespace app {

namespace {

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

constexpr double kClosest = 1.0 / 60;  // s, between moments that a velocity is taken from
constexpr double kRateBlend = 0.25;    // s

// Values of the two intervals next to an end, extrapolated to the end: differences over one lie half of it off, which
// would read the acceleration of a clip that loops cleanly as a gap.
Vec3 atEnd(const Clip& clip, const Vec3& nearest, const Vec3& next) {
  return clip.frameCount() > 2 ? Vec3(1.5 * nearest - 0.5 * next) : nearest;
}

}  // namespace

Vec3 rootCentre(const Skeleton& skeleton, const Clip& clip, const ClipMoment& moment) {
  Vec3 sum = Vec3::Zero();
  int roots = 0;
  for (std::size_t j = 0; j < skeleton.joints.size(); ++j) {
    if (skeleton.joints[j].parent >= 0) continue;
    sum += sampleLocal(clip, moment, static_cast<int>(j)).translation();
    ++roots;
  }
  return Vec3(sum.x(), 0, sum.z()) / std::max(roots, 1);
}

double alignedTurn(const Eigen::Matrix3d& sum) {
  return std::atan2(sum(0, 2) - sum(2, 0), sum(0, 0) + sum(2, 2));
}

PlacedMoment placedMoment(const Skeleton& skeleton, const Clip& clip, const ClipLoop& loop, double time) {
  PlacedMoment placed{clipMoment(clip, time), Rigid::Identity()};
  const Vec3 start(loop.start.x, 0, loop.start.z);
  placed.placement.translation() = -start;
  if (!loop.treadmill) return placed;
  const double part = std::clamp(time / clip.duration(), 0.0, 1.0);
  const Vec3 centre = rootCentre(skeleton, clip, placed.moment);
  placed.placement = Eigen::Translation3d(centre - start - part * Vec3(loop.travel.x, 0, loop.travel.z)) *
                     Eigen::AngleAxisd(-part * loop.travel.turn, Vec3::UnitY()) * Eigen::Translation3d(-centre);
  return placed;
}

Rigid placedLocal(const Skeleton& skeleton, const Clip& clip, const PlacedMoment& placed, int joint) {
  const Rigid local = sampleLocal(clip, placed.moment, joint);
  return skeleton.joints[static_cast<std::size_t>(joint)].parent < 0 ? placed.placement * local : local;
}

SeamMoments seamMoments(const Skeleton& skeleton, const Clip& clip, const ClipLoop& loop) {
  const int last = clip.frameCount() - 1;
  const int apart = std::clamp(static_cast<int>(std::round(kClosest / clip.frame_time)), 1, std::max(1, last / 2));
  const Rigid next_round = loop.treadmill ? Rigid::Identity() : loop.travel.rigid();
  SeamMoments seam;
  seam.interval = apart * clip.frame_time;
  for (int k = 0; k < 3; ++k) {
    PlacedMoment& first = seam.moments[static_cast<std::size_t>(k)];
    first = placedMoment(skeleton, clip, loop, std::min(k * apart, last) * clip.frame_time);
    first.placement = next_round * first.placement;
    seam.moments[static_cast<std::size_t>(5 - k)] =
        placedMoment(skeleton, clip, loop, std::max(last - k * apart, 0) * clip.frame_time);
  }
  return seam;
}

SeamGap seamGap(const Skeleton& skeleton, const Clip& clip, const SeamMoments& seam, int joint) {
  std::array<Rigid, 6> local;
  for (std::size_t k = 0; k < local.size(); ++k) local[k] = placedLocal(skeleton, clip, seam.moments[k], joint);
  const Rigid &first = local[0], &last = local[5];
  const auto moved = [&](std::size_t k) { return Vec3(local[k + 1].translation() - local[k].translation()); };
  const auto turned = [&](std::size_t k) {
    return rotationVector(local[k].linear().transpose() * local[k + 1].linear());
  };
  SeamGap gap;
  gap.shift = first.translation() - last.translation();
  gap.shift_rate = (atEnd(clip, moved(0), moved(1)) - atEnd(clip, moved(4), moved(3))) / seam.interval;
  const Eigen::Matrix3d across = last.linear().transpose() * first.linear();
  const Vec3 spin_first = atEnd(clip, turned(0), turned(1)) / seam.interval;
  const Vec3 spin_last = atEnd(clip, turned(4), turned(3)) / seam.interval;
  gap.turn = rotationVector(across);
  gap.turn_rate = rotationVectorRate(gap.turn, spin_first - across.transpose() * spin_last);
  return gap;
}

SeamWeights::SeamWeights(double left, double blend) {
  const double part = 1 - left / blend, rate_blend = std::min(blend, kRateBlend), rate_part = 1 - left / rate_blend;
  if (part > 0) value = part * part * (3 - 2 * part);
  if (rate_part > 0) rate = rate_blend * rate_part * rate_part * (rate_part - 1);
}

void closeGap(const SeamGap& gap, const SeamWeights& weights, Rigid& local) {
  local.translation() += weights.value * gap.shift + weights.rate * gap.shift_rate;
  local.linear() *= rotationOf(weights.value * gap.turn + weights.rate * gap.turn_rate);
}

}  // namespace app
