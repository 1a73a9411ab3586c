#include "app/figure/arm_clearance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string_view>
#include <vector>

#include "app/figure/ellipsoid_fit.h"

namespace app {

namespace {

constexpr double kTouch = 0.002;   // m under the skin that needs no turn
constexpr double kRoom = 0.004;    // m over the skin, where one is turned
constexpr double kMostTurn = 0.7;  // rad
constexpr double kEvenOver = 0.1;  // s
constexpr int kTurns = 24, kEvenings = 3;

// A place on a limb's middle line and how thick the limb is there.
struct LimbPlace {
  int joint = 0;
  Vec3 place = Vec3::Zero();  // m, joint frame
  double thickness = 0;       // m, radius
};

struct Arm {
  int shoulder = -1;  // the joint that turns
  std::vector<LimbPlace> places;
};

const BodyEllipsoid* named(const Character& character, const std::string& name) {
  const auto found = std::ranges::find(character.ellipsoids, name, &BodyEllipsoid::name);
  return found == character.ellipsoids.end() ? nullptr : &*found;
}

bool hangsFrom(const Skeleton& skeleton, int joint, int above) {
  while (joint > above) joint = skeleton.joints[static_cast<std::size_t>(joint)].parent;
  return joint == above;
}

void addPlaces(const BodyEllipsoid& limb, std::vector<LimbPlace>& places) {
  int axis = 0;
  limb.radii.maxCoeff(&axis);
  for (const double share : {-0.8, -0.4, 0.0, 0.4, 0.8}) {
    const Vec3 along = share * limb.radii[axis] * (limb.rotation * Vec3::Unit(axis));
    places.push_back({limb.joint, limb.center + along, limb.radii.minCoeff() * std::sqrt(1 - share * share)});
  }
}

Arm armOf(const Character& character, const std::string& side) {
  const BodyEllipsoid* upper = named(character, side + "upper_arm");
  const BodyEllipsoid* fore = named(character, side + "forearm");
  if (!upper || !fore || fore->joint == upper->joint || !hangsFrom(character.skeleton, fore->joint, upper->joint))
    return {};
  Arm arm{upper->joint, {}};
  addPlaces(*fore, arm.places);
  if (const BodyEllipsoid* hand = named(character, side + "hand")) addPlaces(*hand, arm.places);
  return arm;
}

// What arms keep off.
std::vector<BodyEllipsoid> bodyOf(const Character& character) {
  std::vector<BodyEllipsoid> body;
  for (const char* name : {"pelvis", "waist", "chest", "upper_chest", "left_bust", "right_bust", "neck", "head", "jaw"})
    if (const BodyEllipsoid* part = named(character, name)) body.push_back(*part);
  return body;
}

Eigen::Quaterniond turnBy(const Vec3& turn) {
  const double angle = turn.norm();
  return angle > 0 ? Eigen::Quaterniond(Eigen::AngleAxisd(angle, turn / angle)) : Eigen::Quaterniond::Identity();
}

// An arm and the body beside it at one moment, world.
struct Moment {
  Vec3 shoulder = Vec3::Zero();
  std::vector<Vec3> places;
  std::vector<Rigid> to_body;  // world to the body parts' joints
};

struct Contact {
  double depth = 0;  // m
  Vec3 place = Vec3::Zero(), normal = Vec3::UnitY();
};

class Clearance {
 public:
  Clearance(const Character& character, Arm arm)
      : character_(character), arm_(std::move(arm)), body_(bodyOf(character)) {}

  // The turns of the shoulder, one a frame, about axes of the world; empty where nothing is touched.
  std::vector<Vec3> turns(const Clip& clip) {
    look(clip);
    const int last = clip.frameCount() - 1;
    std::vector<Vec3> turns(moments_.size(), Vec3::Zero());
    deepest_ = 0;
    for (const Moment& moment : moments_) deepest_ = std::max(deepest_, contact(moment, Vec3::Zero()).depth);
    if (deepest_ < kTouch) return {};
    // Onward and back, each from its neighbour's turn, so that a limb stays on the side that it came from.
    const double keeps = std::exp(-clip.frame_time / kEvenOver);
    std::vector<Vec3> onward = turns, back = turns;
    for (int f = 0; f <= last; ++f) onward[at(f)] = clear(f, f > 0 ? Vec3(keeps * onward[at(f - 1)]) : Vec3::Zero());
    for (int f = last; f >= 0; --f) back[at(f)] = clear(f, f < last ? Vec3(keeps * back[at(f + 1)]) : Vec3::Zero());
    for (int f = 0; f <= last; ++f) turns[at(f)] = 0.5 * (onward[at(f)] + back[at(f)]);
    for (int round = 0; round < kEvenings; ++round) {
      turns = evened(turns, clip.frame_time, kEvenOver / (1 << round));
      if (round + 1 < kEvenings)
        for (int f = 0; f <= last; ++f) turns[at(f)] = clear(f, turns[at(f)]);
    }
    left_ = 0;
    for (int f = 0; f <= last; ++f) left_ = std::max(left_, contact(moments_[at(f)], turns[at(f)]).depth);
    return turns;
  }

  double deepest() const { return deepest_; }  // m, before
  double left() const { return left_; }        // m, after

 private:
  static std::size_t at(int index) { return static_cast<std::size_t>(index); }

  void look(const Clip& clip) {
    moments_.resize(at(clip.frameCount()));
    Pose pose;
    for (int f = 0; f < clip.frameCount(); ++f) {
      samplePose(character_.skeleton, clip, f * clip.frame_time, pose);
      Moment& moment = moments_[at(f)];
      moment.shoulder = pose.world[at(arm_.shoulder)].translation();
      moment.places.clear();
      for (const LimbPlace& place : arm_.places) moment.places.push_back(pose.world[at(place.joint)] * place.place);
      moment.to_body.clear();
      for (const BodyEllipsoid& part : body_)
        moment.to_body.push_back(pose.world[at(part.joint)].inverse(Eigen::Isometry));
    }
  }

  Contact contact(const Moment& moment, const Vec3& turn) const {
    Contact deepest;
    const Eigen::Quaterniond rotation = turnBy(turn);
    for (std::size_t k = 0; k < arm_.places.size(); ++k) {
      const Vec3 place = moment.shoulder + rotation * (moment.places[k] - moment.shoulder);
      for (std::size_t b = 0; b < body_.size(); ++b) {
        const Vec3 p = moment.to_body[b] * place;
        if ((p - body_[b].center).norm() > body_[b].radii.maxCoeff() + arm_.places[k].thickness) continue;
        const double depth = arm_.places[k].thickness - ellipsoidGap(body_[b], p);
        if (depth <= deepest.depth) continue;
        const Vec3 q = body_[b].rotation.conjugate() * (p - body_[b].center);
        const Vec3 slope = q.cwiseQuotient(body_[b].radii.cwiseAbs2());
        if (slope.squaredNorm() < 1e-12) continue;
        deepest = {depth, place, moment.to_body[b].linear().transpose() * (body_[b].rotation * slope.normalized())};
      }
    }
    return deepest;
  }

  Vec3 clear(int frame, Vec3 turn) const {
    const Moment& moment = moments_[at(frame)];
    for (int k = 0; k < kTurns; ++k) {
      const Contact touch = contact(moment, turn);
      if (touch.depth < kTouch) break;
      const Vec3 lever = (touch.place - moment.shoulder).cross(touch.normal);
      turn += (touch.depth + kRoom) * lever / std::max(lever.squaredNorm(), 0.01);
      if (turn.norm() > kMostTurn) return kMostTurn * turn.normalized();
    }
    return turn;
  }

  static std::vector<Vec3> evened(const std::vector<Vec3>& turns, double frame_time, double over) {
    std::vector<Vec3> even(turns.size(), Vec3::Zero());
    const int reach = static_cast<int>(std::ceil(2 * over / frame_time)), count = static_cast<int>(turns.size());
    for (int f = 0; f < count; ++f) {
      double sum = 0;
      for (int g = std::max(f - reach, 0); g <= std::min(f + reach, count - 1); ++g) {
        const double far = (g - f) * frame_time / over, weight = std::exp(-2 * far * far);
        even[at(f)] += weight * turns[at(g)];
        sum += weight;
      }
      even[at(f)] /= sum;
    }
    return even;
  }

  const Character& character_;
  Arm arm_;
  std::vector<BodyEllipsoid> body_;
  std::vector<Moment> moments_;
  double deepest_ = 0, left_ = 0;
};

}  // namespace

std::string clearArms(const Character& character, Clip& clip) {
  double deepest = 0, left = 0;
  for (const char* side : {"left_", "right_"}) {
    Arm arm = armOf(character, side);
    if (arm.shoulder < 0) continue;
    const int shoulder = arm.shoulder;
    Clearance clearance(character, std::move(arm));
    const std::vector<Vec3> turns = clearance.turns(clip);
    if (turns.empty()) continue;
    const int parent = character.skeleton.joints[static_cast<std::size_t>(shoulder)].parent;
    std::vector<Eigen::Quaterniond> turned;
    Pose pose;
    for (int f = 0; f < clip.frameCount(); ++f) {
      samplePose(character.skeleton, clip, f * clip.frame_time, pose);
      const Eigen::Quaterniond base(parent < 0
                                        ? Eigen::Matrix3d(Eigen::Matrix3d::Identity())
                                        : Eigen::Matrix3d(pose.world[static_cast<std::size_t>(parent)].linear()));
      Eigen::Quaterniond& own = clip.rotations[static_cast<std::size_t>(f * clip.joint_count + shoulder)];
      if (turns[static_cast<std::size_t>(f)].norm() > 1e-6)
        own = (base.conjugate() * turnBy(turns[static_cast<std::size_t>(f)]) * base * own).normalized();
    }
    deepest = std::max(deepest, clearance.deepest());
    left = std::max(left, clearance.left());
  }
  if (deepest == 0) return {};
  char line[160];
  std::snprintf(line, sizeof line,
                "arms: led up to %.0f mm into the body, turned out at the shoulders; %.0f mm are left", 1e3 * deepest,
                1e3 * left);
  return line;
}

}  // namespace app
