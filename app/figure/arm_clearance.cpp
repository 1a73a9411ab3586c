#include "app/figure/arm_clearance.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>
#include <vector>

#include "app/figure/ellipsoid_fit.h"

namespace app {

namespace {

constexpr double kTouch = 0.002;   // m under the skin that needs no turn
constexpr double kRoom = 0.004;    // m over the skin, where one is turned
constexpr double kMaxTurn = 0.7;   // rad
constexpr double kNoTurn = 1e-6;   // rad
constexpr double kEvenOver = 0.1;  // s, that turns are evened out over
constexpr int kTurns = 24;         // small ones, that make up a turn
constexpr int kEvenings = 3;       // each over half the time of the one before

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

// What an arm is turned by.
struct Turns {
  std::vector<Vec3> by;          // one a frame, about axes of the world; empty where nothing is touched
  double deepest = 0, left = 0;  // m, before and after
};

class Clearance {
 public:
  Clearance(const Character& character, Arm arm)
      : character_(character), arm_(std::move(arm)), body_(bodyOf(character)) {}

  Turns turns(const Clip& clip) {
    look(clip);
    Turns turns;
    std::vector<Vec3>& by = turns.by;
    by.assign(moments_.size(), Vec3::Zero());
    turns.deepest = deepestWith(by);
    if (turns.deepest < kTouch) return {};
    // Onward and back, each from its neighbour's turn, so that a limb stays on the side that it came from.
    const int count = clip.frameCount();
    const double keeps = std::exp(-clip.frame_time / kEvenOver);
    std::vector<Vec3> onward = by, back = by;
    for (int f = 0; f < count; ++f) onward[at(f)] = clear(f, f > 0 ? Vec3(keeps * onward[at(f - 1)]) : Vec3::Zero());
    for (int f = count - 1; f >= 0; --f)
      back[at(f)] = clear(f, f + 1 < count ? Vec3(keeps * back[at(f + 1)]) : Vec3::Zero());
    for (int f = 0; f < count; ++f) by[at(f)] = 0.5 * (onward[at(f)] + back[at(f)]);
    for (int round = 0; round < kEvenings; ++round) {
      for (int f = 0; f < count && round > 0; ++f) by[at(f)] = clear(f, by[at(f)]);
      by = evened(by, clip.frame_time, kEvenOver / (1 << round));
    }
    turns.left = deepestWith(by);
    return turns;
  }

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

  // The deepest of the turned arm with the body.
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

  double deepestWith(const std::vector<Vec3>& turns) const {
    double deepest = 0;
    for (std::size_t f = 0; f < turns.size(); ++f) deepest = std::max(deepest, contact(moments_[f], turns[f]).depth);
    return deepest;
  }

  // The turn at a frame that leaves no contact, from a given one on.
  Vec3 clear(int frame, Vec3 turn) const {
    const Moment& moment = moments_[at(frame)];
    for (int k = 0; k < kTurns; ++k) {
      const Contact touch = contact(moment, turn);
      if (touch.depth < kTouch) break;
      const Vec3 lever = (touch.place - moment.shoulder).cross(touch.normal);
      turn += (touch.depth + kRoom) * lever / std::max(lever.squaredNorm(), 0.01);
      if (turn.norm() > kMaxTurn) return kMaxTurn * turn.normalized();
    }
    return turn;
  }

  // Weighted means over the frames around.
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
  std::vector<Moment> moments_;  // one a frame
};

// Turns a joint about its own place, in the world.
void turnJoint(const Skeleton& skeleton, int joint, const std::vector<Vec3>& by, Clip& clip) {
  const int parent = skeleton.joints[static_cast<std::size_t>(joint)].parent;
  Pose pose;
  for (int f = 0; f < clip.frameCount(); ++f) {
    const Vec3& turn = by[static_cast<std::size_t>(f)];
    if (turn.norm() < kNoTurn) continue;
    samplePose(skeleton, clip, f * clip.frame_time, pose);
    Eigen::Quaterniond above = Eigen::Quaterniond::Identity();
    if (parent >= 0) above = Eigen::Quaterniond(pose.world[static_cast<std::size_t>(parent)].linear());
    Eigen::Quaterniond& own = clip.rotations[static_cast<std::size_t>(f * clip.joint_count + joint)];
    own = (above.conjugate() * turnBy(turn) * above * own).normalized();
  }
}

}  // namespace

std::string clearArms(const Character& character, Clip& clip) {
  double deepest = 0, left = 0;
  for (const char* side : {"left_", "right_"}) {
    Arm arm = armOf(character, side);
    if (arm.shoulder < 0) continue;
    const int shoulder = arm.shoulder;
    const Turns turns = Clearance(character, std::move(arm)).turns(clip);
    if (turns.by.empty()) continue;
    turnJoint(character.skeleton, shoulder, turns.by, clip);
    deepest = std::max(deepest, turns.deepest);
    left = std::max(left, turns.left);
  }
  if (deepest == 0) return {};
  char line[160];
  std::snprintf(line, sizeof line,
                "arms: led up to %.0f mm into the body, turned out at the shoulders; %.0f mm are left", 1e3 * deepest,
                1e3 * left);
  return line;
}

}  // namespace app
