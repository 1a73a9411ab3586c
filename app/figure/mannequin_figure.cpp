// Stands a BVH skeleton upright. Rest offsets say nothing reliable about the pose (T, arms down, legs astride, even
// lying), so the limbs are turned to one neutral pose: all mannequins then share one bind pose whatever the file.
#include "app/figure/mannequin_figure.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "app/files/errors.h"
#include "app/motion/least_rotation.h"

namespace app {

namespace {

using Quat = Eigen::Quaterniond;

constexpr double kHeadShare = 0.135;       // chin to crown over height: adults between 1/7 and 1/8
constexpr double kSkullBaseShare = 0.30;   // skull base above the chin, over head height
constexpr double kNeckShare = 0.058;       // C7 to skull base over height
constexpr double kShouldersShare = 0.085;  // shoulder joints to skull base over height, at least
constexpr double kLevel = 0.15;            // rad, hips and shoulders that lie across
constexpr double kArmAngle = 0.72;         // rad from straight down: far enough that arm and flank stay apart

ReferencePose restReference(const BvhMotion& motion) {
  ReferencePose reference;
  const auto& joints = motion.skeleton.joints;
  for (std::size_t j = 0; j < joints.size(); ++j) {
    reference.world.push_back(joints[j].rest_world);
    reference.ends.push_back(joints[j].rest_world * motion.end_sites[j]);
  }
  return reference;
}

// Turns the joints of a pose one after the other, carrying what hangs from them.
struct Poser {
  const Skeleton& skeleton;
  const ReferencePose& before;
  std::vector<Quat> turn;  // world rotation applied to each joint's reference orientation
  std::vector<bool> turn_set;

  Poser(const Skeleton& s, const ReferencePose& r, const Quat& root)
      : skeleton(s), before(r), turn(s.joints.size(), root), turn_set(s.joints.size(), false) {}

  void set(int joint, const Quat& q) {
    turn[joint] = q;
    turn_set[joint] = true;
  }

  // Sends the bone from `joint` to `next` along `target`; the joints between and below follow until told otherwise.
  void aim(int joint, const Vec3& next, const Vec3& target, const Quat& base) {
    const Vec3 bone = base * (next - before.world[joint].translation());
    if (bone.norm() < 1e-4) return;
    set(joint, leastRotation(bone, target) * base);
  }

  ReferencePose pose() {
    ReferencePose after = before;
    for (std::size_t j = 0; j < skeleton.joints.size(); ++j) {
      const int parent = skeleton.joints[j].parent;
      if (parent >= 0 && !turn_set[j]) turn[j] = turn[parent];
      const Vec3 offset =
          parent < 0 ? Vec3::Zero()
                     : Vec3(turn[parent] * (before.world[j].translation() - before.world[parent].translation()));
      after.world[j].translation() = parent < 0 ? Vec3::Zero() : Vec3(after.world[parent].translation() + offset);
      after.world[j].linear() = (turn[j] * Quat(before.world[j].linear())).toRotationMatrix();
      after.ends[j] = after.world[j].translation() + turn[j] * (before.ends[j] - before.world[j].translation());
    }
    return after;
  }
};

Vec3 jointAt(const ReferencePose& pose, int joint) {
  return pose.world[joint].translation();
}

void poseArms(const ReferencePose& before, const BodyRoles& roles, const Quat& root, Poser& poser) {
  for (int s = 0; s < 2; ++s) {
    const ArmRoles& arm = roles.arms[s];
    if (arm.upper < 0) continue;
    const double side = s == 0 ? 1 : -1;
    const auto target = [&](double angle, double ahead) {
      return Vec3(side * std::sin(angle), -std::cos(angle), ahead).normalized();
    };
    poser.aim(arm.upper, jointAt(before, arm.fore), target(kArmAngle, -0.02), root);
    const Vec3 wrist = arm.hand >= 0 ? jointAt(before, arm.hand) : before.ends[arm.fore];
    poser.aim(arm.fore, wrist, target(kArmAngle - 0.10, 0.10), root);
    if (arm.hand >= 0) {
      const Vec3 tip = arm.tip >= 0 ? before.ends[arm.tip] : before.ends[arm.hand];
      poser.aim(arm.hand, tip, target(kArmAngle - 0.16, 0.14), root);
    }
  }
}

void poseLegs(const ReferencePose& before, const BodyRoles& roles, const Quat& root, Poser& poser) {
  for (int s = 0; s < 2; ++s) {
    const LegRoles& leg = roles.legs[s];
    if (leg.upper < 0) continue;
    const double side = s == 0 ? 1 : -1;
    poser.aim(leg.upper, jointAt(before, leg.lower), Vec3(side * 0.055, -1, 0.02).normalized(), root);
    const Vec3 ankle = leg.foot >= 0 ? jointAt(before, leg.foot) : before.ends[leg.lower];
    poser.aim(leg.lower, ankle, Vec3(side * 0.03, -1, -0.03).normalized(), root);
    if (leg.foot < 0) continue;
    const Vec3 foot = leg.toe >= 0 ? jointAt(before, leg.toe) : before.ends[leg.foot];
    const Vec3 bone = root * (foot - jointAt(before, leg.foot));
    const double ahead = std::hypot(bone.x(), bone.z());
    const Vec3 out = Vec3(side * 0.12, 0, 1).normalized();
    // A foot without a length, or one pointing at the ground, keeps the body's turn.
    if (ahead > 0.3 * bone.norm() && bone.norm() > 0.01)
      poser.aim(leg.foot, foot, Vec3(out.x() * ahead, bone.y(), out.z() * ahead), root);
    else
      poser.set(leg.foot, root);
    if (leg.toe >= 0 && leg.toe != leg.foot) poser.set(leg.toe, leastRotation(Vec3::UnitZ(), out) * root);
  }
}

// From the right joint of a pair to the left one.
Vec3 acrossHips(const ReferencePose& pose, const BodyRoles& roles) {
  if (roles.legs[0].upper < 0 || roles.legs[1].upper < 0) return Vec3::UnitX();
  return jointAt(pose, roles.legs[0].upper) - jointAt(pose, roles.legs[1].upper);
}
Vec3 acrossShoulders(const ReferencePose& pose, const BodyRoles& roles) {
  if (roles.arms[0].upper < 0 || roles.arms[1].upper < 0) return Vec3::UnitX();
  return jointAt(pose, roles.arms[0].upper) - jointAt(pose, roles.arms[1].upper);
}

bool standsStraight(const ReferencePose& before, const BodyRoles& roles, const Quat& root) {
  const Vec3 trunk = jointAt(before, roles.head) - jointAt(before, 0);
  const auto level = [&](const Vec3& across) { return (root * across).normalized().x() > std::cos(kLevel); };
  return trunk.y() >= 0.94 * trunk.norm() && level(acrossHips(before, roles)) && level(acrossShoulders(before, roles));
}

// The collar bones, so that both shoulders stand alike. `chest`: what they hang from.
void poseCollars(const ReferencePose& before, const BodyRoles& roles, int chest, const Quat& turn, Poser& poser) {
  std::array<int, 2> collars{};
  std::array<Vec3, 2> bones;
  for (std::size_t s = 0; s < 2; ++s) {
    const int upper = roles.arms[s].upper;
    if (upper < 0) return;
    collars[s] = poser.skeleton.joints[static_cast<std::size_t>(upper)].parent;
    if (collars[s] < 0 || poser.skeleton.joints[static_cast<std::size_t>(collars[s])].parent != chest) return;
    bones[s] = turn * (jointAt(before, upper) - jointAt(before, collars[s]));
  }
  const Vec3 mirror(-1, 1, 1);
  const Vec3 left = bones[0] + bones[1].cwiseProduct(mirror);
  if (left.norm() < 1e-4) return;
  for (std::size_t s = 0; s < 2; ++s)
    poser.aim(collars[s], jointAt(before, roles.arms[s].upper), s == 0 ? left : Vec3(left.cwiseProduct(mirror)), turn);
}

// Straightens a trunk that leans or twists, as of a rest pose taken from the motion: hips level, spine upright,
// shoulders above them and alike.
void poseTrunk(const ReferencePose& before, const BodyRoles& roles, const Quat& root, Poser& poser) {
  const std::vector<int>& spine = roles.spine;
  const Quat level = leastRotation(root * acrossHips(before, roles), Vec3::UnitX()) * root;
  Quat pelvis = level;
  if (spine.size() > 1) {
    const Vec3 up = level * (jointAt(before, spine[1]) - jointAt(before, spine[0]));
    if (std::hypot(up.y(), up.z()) > 1e-4)
      pelvis = Quat(Eigen::AngleAxisd(-std::atan2(up.z(), up.y()), Vec3::UnitX())) * level;
  }
  if (!spine.empty()) poser.set(spine[0], pelvis);
  for (std::size_t i = 1; i + 1 < spine.size(); ++i) {
    const bool chest = std::ranges::any_of(roles.arms, [&](const ArmRoles& arm) {
      int above = arm.upper;
      while (above >= 0 && std::ranges::find(spine, above) == spine.end())
        above = poser.skeleton.joints[static_cast<std::size_t>(above)].parent;
      return arm.upper >= 0 && above == spine[i];
    });
    poser.aim(spine[i], jointAt(before, spine[i + 1]), Vec3::UnitY(), root);
    if (!chest) continue;
    const Vec3 across = poser.turn[static_cast<std::size_t>(spine[i])] * acrossShoulders(before, roles);
    const Quat turn = Quat(Eigen::AngleAxisd(std::atan2(across.z(), across.x()), Vec3::UnitY())) *
                      poser.turn[static_cast<std::size_t>(spine[i])];
    poser.set(spine[i], turn);
    poseCollars(before, roles, spine[i], turn, poser);
  }
  poser.set(roles.head, root);
}

void measureLimbs(const ReferencePose& pose, const BodyRoles& roles, Figure& figure) {
  for (int s = 0; s < 2; ++s) {
    const ArmRoles& a = roles.arms[s];
    Figure::Arm& arm = figure.arms[s];
    arm.side = s == 0 ? 1 : -1;
    if (a.upper >= 0) {
      arm.present = true;
      arm.shoulder = jointAt(pose, a.upper);
      arm.elbow = jointAt(pose, a.fore);
      arm.wrist = a.hand >= 0 ? jointAt(pose, a.hand) : pose.ends[a.fore];
      arm.tip = a.hand >= 0 ? pose.ends[a.tip >= 0 ? a.tip : a.hand] : arm.wrist;
    }
    const LegRoles& l = roles.legs[s];
    Figure::Leg& leg = figure.legs[s];
    leg.side = arm.side;
    if (l.upper >= 0) {
      leg.present = true;
      leg.hip = jointAt(pose, l.upper);
      leg.knee = jointAt(pose, l.lower);
      leg.ankle = l.foot >= 0 ? jointAt(pose, l.foot) : pose.ends[l.lower];
      leg.toe = l.toe >= 0 ? pose.ends[l.toe] : (l.foot >= 0 ? pose.ends[l.foot] : leg.ankle);
    }
  }
}

double lowest(const ReferencePose& pose) {
  double low = 1e30;
  for (std::size_t j = 0; j < pose.ends.size(); ++j)
    low = std::min({low, pose.world[j].translation().y(), pose.ends[j].y()});
  return low;
}

// Heights first: everything else is scaled by them.
Figure measure(const ReferencePose& pose, const BodyRoles& roles) {
  Figure figure;
  measureLimbs(pose, roles, figure);
  const auto& arms = figure.arms;
  const auto& legs = figure.legs;

  const Vec3 root = jointAt(pose, roles.spine.front());
  const Vec3 head = jointAt(pose, roles.head);
  const bool has_legs = legs[0].present || legs[1].present;
  figure.pelvis = root;
  if (legs[0].present && legs[1].present) {
    figure.pelvis = 0.5 * (legs[0].hip + legs[1].hip);
    figure.hip_half = 0.5 * std::abs(legs[0].hip.x() - legs[1].hip.x());
  }
  // Trunk from hip joints to skull base is about 0.385 of the height; whole legs give the measure when there are any.
  const double trunk = std::max(head.y() - figure.pelvis.y(), 0.05);
  const double neck_extra = roles.head_is_neck ? kNeckShare : 0.0;
  const double below = has_legs ? head.y() - lowest(pose) + 0.012 * trunk : trunk / 0.385 * 0.905;
  figure.height = below / (1 - kHeadShare * (1 - kSkullBaseShare) - neck_extra);
  figure.head_height = kHeadShare * figure.height;
  figure.sole = has_legs ? lowest(pose) - 0.012 * trunk : figure.pelvis.y() - 0.52 * figure.height;
  for (const Figure::Leg& leg : legs)
    if (leg.present) figure.sole = std::min(figure.sole, leg.ankle.y() - 0.042 * figure.height);

  figure.skull_base = head + Vec3(0, neck_extra * figure.height, 0.006 * figure.height * (neck_extra > 0));
  figure.shoulder_level = figure.skull_base.y() - 0.088 * figure.height;
  if (arms[0].present && arms[1].present) {
    figure.shoulder_half = 0.5 * std::abs(arms[0].shoulder.x() - arms[1].shoulder.x());
    figure.shoulder_level = 0.5 * (arms[0].shoulder.y() + arms[1].shoulder.y());
  } else {
    figure.shoulder_half = 0.095 * figure.height;
  }
  figure.shoulder_half = std::clamp(figure.shoulder_half, 0.05 * figure.height, 0.14 * figure.height);
  figure.hip_half = std::clamp(figure.hip_half, 0.03 * figure.height, 0.08 * figure.height);
  // Head joints lie anywhere from the nape to the skull base; the skull needs a neck's length above the shoulders.
  if (const double least = figure.shoulder_level + kShouldersShare * figure.height; figure.skull_base.y() < least) {
    figure.skull_base.y() = least;
    figure.height = (least - figure.sole) / (1 - kHeadShare * (1 - kSkullBaseShare));
    figure.head_height = kHeadShare * figure.height;
  }
  // The neck's root lies between shoulders and skull base; joint names disagree about it, shoulders do not.
  const double level =
      std::clamp(figure.shoulder_level + 0.028 * figure.height, figure.skull_base.y() - 0.075 * figure.height,
                 figure.skull_base.y() - 0.048 * figure.height);
  figure.neck_base = Vec3(figure.skull_base.x(), level, figure.skull_base.z() - 0.012 * figure.height);
  return figure;
}

void addAppendages(const Skeleton& skeleton, const ReferencePose& pose, const BodyRoles& roles, Figure& figure) {
  for (int first : roles.appendages) {
    Figure::Appendage appendage;
    int joint = first;
    appendage.points.push_back(jointAt(pose, skeleton.joints[first].parent));
    appendage.joints.push_back(skeleton.joints[first].parent);
    while (joint >= 0) {
      appendage.points.push_back(jointAt(pose, joint));
      appendage.joints.push_back(joint);
      int next = -1;
      for (std::size_t j = 0; j < skeleton.joints.size() && next < 0; ++j)
        if (skeleton.joints[j].parent == joint) next = static_cast<int>(j);
      if (next < 0 && (pose.ends[joint] - jointAt(pose, joint)).norm() > 1e-4)
        appendage.points.push_back(pose.ends[joint]);
      joint = next;
    }
    figure.appendages.push_back(std::move(appendage));
  }
}

void setRest(const ReferencePose& pose, Skeleton& skeleton) {
  for (std::size_t j = 0; j < skeleton.joints.size(); ++j) {
    Joint& joint = skeleton.joints[j];
    joint.rest_world = pose.world[j];
    joint.rest_local = joint.parent < 0 ? pose.world[j] : pose.world[joint.parent].inverse() * pose.world[j];
  }
}

}  // namespace

StoodSkeleton standSkeleton(const BvhMotion& motion, const std::string& file) {
  StoodSkeleton stood;
  stood.skeleton = motion.skeleton;
  bool is_neck = false;
  const ReferencePose reference = restReference(motion);
  const int head = findHeadJoint(motion.skeleton, reference, is_neck);
  if (head <= 0)
    throw InputError(file, "skeleton",
                     "no joint of " + std::to_string(motion.skeleton.joints.size()) + " can carry a head",
                     "name the joint that turns the head 'Head' and let it hang from a root");

  stood.roles = inferRoles(motion.skeleton, reference, head, is_neck);
  std::string how;
  const Vec3 forward = inferForward(motion.skeleton, reference, stood.roles, how);
  orderSides(reference, forward, stood.roles);
  const Quat root(Eigen::AngleAxisd(-std::atan2(forward.x(), forward.z()), Vec3::UnitY()));

  Poser poser(motion.skeleton, reference, root);
  if (!standsStraight(reference, stood.roles, root)) {
    poseTrunk(reference, stood.roles, root, poser);
    stood.notes.emplace_back("rest pose: the trunk leans or twists, it was stood upright");
  }
  poseArms(reference, stood.roles, root, poser);
  poseLegs(reference, stood.roles, root, poser);
  ReferencePose pose = poser.pose();

  stood.figure = measure(pose, stood.roles);
  const Vec3 lift(-stood.figure.pelvis.x(), -stood.figure.sole, -stood.figure.pelvis.z());
  for (Rigid& w : pose.world) w.translation() += lift;
  for (Vec3& e : pose.ends) e += lift;
  stood.figure = measure(pose, stood.roles);
  stood.figure.sole = 0;
  addAppendages(motion.skeleton, pose, stood.roles, stood.figure);
  setRest(pose, stood.skeleton);

  char text[200];
  std::snprintf(text, sizeof text, "figure: %.2f m tall, %d arms, %d legs; it faces %+.2f, %+.2f (x, z), told by %s",
                stood.figure.height, stood.figure.arms[0].present + stood.figure.arms[1].present,
                stood.figure.legs[0].present + stood.figure.legs[1].present, forward.x(), forward.z(), how.c_str());
  stood.notes.push_back(text);
  stood.notes.push_back("head: joint '" + motion.skeleton.joints[head].name + "'" +
                        (is_neck ? ", a neck that carries the skull" : ""));
  return stood;
}

}  // namespace app
