#include "app/motion/foot_plant.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <vector>

#include "app/figure/character_roles.h"
#include "app/motion/least_rotation.h"

namespace app {

namespace {

constexpr double kLow = 0.035, kSlow = 0.35, kShortest = 0.12;  // m over the lowest, m/s, s
constexpr double kStrays = 0.01, kDragged = 0.12;               // m
constexpr double kFade = 0.15;                                  // s
constexpr double kLongestReach = 0.999;                         // of the stretched leg

struct Stand {
  int first = 0, last = 0;  // frames
  Vec3 place = Vec3::Zero();
  double strays = 0;  // m
};

double fade(double seconds) {
  const double t = std::clamp(1 - seconds / kFade, 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

Vec3 overGround(const Vec3& p) {
  return Vec3(p.x(), 0, p.z());
}

// The frames in which a point stands, by its path.
std::vector<Stand> standsOf(const std::vector<Vec3>& path, double frame_time) {
  std::vector<double> heights;
  for (const Vec3& p : path) heights.push_back(p.y());
  std::nth_element(heights.begin(), heights.begin() + std::ssize(heights) / 50, heights.end());
  const double low = heights[heights.size() / 50] + kLow;
  const auto stands = [&](int f) {
    const int before = std::max(f - 1, 0), after = std::min<int>(f + 1, static_cast<int>(path.size()) - 1);
    const double way =
        overGround(path[static_cast<std::size_t>(after)] - path[static_cast<std::size_t>(before)]).norm();
    return path[static_cast<std::size_t>(f)].y() < low && way < kSlow * frame_time * (after - before);
  };
  std::vector<Stand> found;
  for (int f = 0; f < std::ssize(path); ++f) {
    if (!stands(f)) continue;
    Stand stand{f, f, Vec3::Zero(), 0};
    while (stand.last + 1 < std::ssize(path) && stands(stand.last + 1)) ++stand.last;
    f = stand.last;
    const int frames = stand.last - stand.first + 1;
    if ((frames - 1) * frame_time < kShortest) continue;
    for (int k = stand.first; k <= stand.last; ++k)
      stand.place += overGround(path[static_cast<std::size_t>(k)]) / frames;
    for (int k = stand.first; k <= stand.last; ++k)
      stand.strays = std::max(stand.strays, (overGround(path[static_cast<std::size_t>(k)]) - stand.place).norm());
    if (stand.strays > kStrays && stand.strays < kDragged) found.push_back(stand);
  }
  return found;
}

// How far the foot is to be moved in every frame.
std::vector<Vec3> movesOf(const std::vector<Stand>& stands, const std::vector<Vec3>& path, double frame_time) {
  std::vector<Vec3> moves(path.size(), Vec3::Zero());
  const auto off = [&](const Stand& stand, int frame) {
    return Vec3(stand.place - overGround(path[static_cast<std::size_t>(frame)]));
  };
  for (const Stand& stand : stands) {
    for (int f = stand.first; f <= stand.last; ++f) moves[static_cast<std::size_t>(f)] = off(stand, f);
    for (int side : {-1, 1}) {
      const int end = side < 0 ? stand.first : stand.last;
      for (int f = end + side; f >= 0 && f < std::ssize(path) && fade(std::abs(f - end) * frame_time) > 0; f += side) {
        const bool stood = std::any_of(stands.begin(), stands.end(),
                                       [&](const Stand& other) { return f >= other.first && f <= other.last; });
        if (stood) break;
        moves[static_cast<std::size_t>(f)] += fade(std::abs(f - end) * frame_time) * off(stand, end);
      }
    }
  }
  return moves;
}

Eigen::Quaterniond rotationOf(const Rigid& pose) {
  return Eigen::Quaterniond(pose.linear());
}

// The angle at the first joint of a chain of lengths a and b that reaches c.
double firstAngle(double a, double b, double c) {
  return std::acos(std::clamp((a * a + c * c - b * b) / (2 * a * c), -1.0, 1.0));
}

// Turns hip and knee so that the ankle comes to `target`; the knee bends as it did and the foot keeps its attitude.
void reach(const Skeleton& skeleton, const LegRoles& leg, const Pose& pose, const Vec3& goal, int frame, Clip& clip) {
  const auto world = [&](int joint) -> const Rigid& { return pose.world[static_cast<std::size_t>(joint)]; };
  const Vec3 hip = world(leg.upper).translation(), knee = world(leg.lower).translation(),
             ankle = world(leg.foot).translation();
  const double a = (knee - hip).norm(), b = (ankle - knee).norm(), before = (ankle - hip).norm();
  if (a < 1e-3 || b < 1e-3 || before < 1e-3 || (goal - hip).norm() < 1e-3) return;
  const double after = std::min((goal - hip).norm(), kLongestReach * (a + b));
  const Vec3 target = hip + after * (goal - hip).normalized();
  const Eigen::Quaterniond swing = leastRotation(ankle - hip, target - hip);
  Vec3 hinge = (knee - hip).cross(ankle - hip);
  if (hinge.norm() < 1e-6) return;  // a straight leg has no way to bend
  hinge = swing * hinge.normalized();
  const double angle = firstAngle(a, b, before) - firstAngle(a, b, after);
  const Eigen::Quaterniond thigh = Eigen::Quaterniond(Eigen::AngleAxisd(angle, hinge)) * swing;
  const Eigen::Quaterniond shin = leastRotation(thigh * (ankle - knee), target - (hip + thigh * (knee - hip))) * thigh;
  const auto turn = [&](int joint, const Eigen::Quaterniond& parent, const Eigen::Quaterniond& own) {
    const int above = skeleton.joints[static_cast<std::size_t>(joint)].parent;
    const Eigen::Quaterniond base =
        above < 0 ? Eigen::Quaterniond::Identity() : Eigen::Quaterniond(parent * rotationOf(world(above)));
    clip.rotations[static_cast<std::size_t>(frame * clip.joint_count + joint)] =
        (base.inverse() * (own * rotationOf(world(joint)))).normalized();
  };
  turn(leg.upper, Eigen::Quaterniond::Identity(), thigh);
  turn(leg.lower, thigh, shin);
  turn(leg.foot, shin, Eigen::Quaterniond::Identity());
}

}  // namespace

std::string plantFeet(const Skeleton& skeleton, Clip& clip) {
  if (clip.frameCount() < 3) return {};
  const BodyRoles roles = rolesAtRest(skeleton);
  int count = 0;
  double farthest = 0;
  for (const LegRoles& leg : roles.legs) {
    if (leg.upper < 0 || leg.lower < 0 || leg.foot < 0) continue;
    std::vector<Pose> poses(static_cast<std::size_t>(clip.frameCount()));
    std::vector<Vec3> path;
    for (int f = 0; f < clip.frameCount(); ++f) {
      Pose& pose = poses[static_cast<std::size_t>(f)];
      samplePose(skeleton, clip, f * clip.frame_time, pose);
      path.push_back(pose.world[static_cast<std::size_t>(leg.toe >= 0 ? leg.toe : leg.foot)].translation());
    }
    const std::vector<Stand> stands = standsOf(path, clip.frame_time);
    const std::vector<Vec3> moves = movesOf(stands, path, clip.frame_time);
    for (int f = 0; f < clip.frameCount(); ++f) {
      const Vec3& move = moves[static_cast<std::size_t>(f)];
      const Pose& pose = poses[static_cast<std::size_t>(f)];
      if (move.norm() < 1e-5) continue;
      reach(skeleton, leg, pose, pose.world[static_cast<std::size_t>(leg.foot)].translation() + move, f, clip);
    }
    count += static_cast<int>(stands.size());
    for (const Stand& stand : stands) farthest = std::max(farthest, stand.strays);
  }
  if (count == 0) return {};
  char line[120];
  std::snprintf(line, sizeof line, "feet: %d stands slid by up to %.0f mm and are held in place by hip and knee", count,
                1000 * farthest);
  return line;
}

}  // namespace app
