// Feet stand still where they stand, and nothing above the hips moves.
#include "app/motion/foot_plant.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/motions.h"

namespace foot_plant_test {

using namespace test;

int jointNamed(const BvhMotion& motion, const std::string& name) {
  for (std::size_t j = 0; j < motion.skeleton.joints.size(); ++j)
    if (motion.skeleton.joints[j].name == name) return static_cast<int>(j);
  ADD_FAILURE() << "no joint " << name;
  return 0;
}

// A joint's way over the ground from its place in the first frame, largest over frames `first` to `last`, m.
double strays(const BvhMotion& motion, int joint, int first, int last) {
  double most = 0;
  Vec3 from = Vec3::Zero();
  for (int f = first; f <= last; ++f) {
    Pose pose;
    app::samplePose(motion.skeleton, motion.clip, f * motion.clip.frame_time, pose);
    const Vec3 at = pose.world[static_cast<std::size_t>(joint)].translation();
    if (f == first) from = at;
    most = std::max(most, Vec3(at.x() - from.x(), 0, at.z() - from.z()).norm());
  }
  return most;
}

// The whole figure is carried to and fro under feet that should stand.
BvhMotion sliding(double way) {
  BvhMotion motion = ownClip("head_shake");
  for (int f = 0; f < motion.clip.frameCount(); ++f) {
    const double turn = 2 * std::numbers::pi * 0.4 * f * motion.clip.frame_time;
    motion.clip.translations[static_cast<std::size_t>(f * motion.clip.joint_count)].x() += way * std::sin(turn);
  }
  return motion;
}

TEST(FootPlant, FeetThatSlideAreHeldAndTheBodyAboveStaysAsItWas) {
  const BvhMotion before = sliding(0.03);
  BvhMotion after = before;
  const std::string note = app::plantFeet(after.skeleton, after.clip);
  EXPECT_NE(note.find("slid by up to 3"), std::string::npos) << note;
  const int last = before.clip.frameCount() - 1;
  for (const char* name : {"LeftFoot", "RightFoot"}) {
    const int foot = jointNamed(before, name);
    EXPECT_GT(strays(before, foot, 0, last), 0.025) << name;
    EXPECT_LT(strays(after, foot, 0, last), 0.002) << name;
  }
  const int head = jointNamed(before, "Head");
  for (int f = 0; f <= last; f += 7) {
    Pose one, other;
    app::samplePose(before.skeleton, before.clip, f * before.clip.frame_time, one);
    app::samplePose(after.skeleton, after.clip, f * after.clip.frame_time, other);
    EXPECT_TRUE(one.world[static_cast<std::size_t>(head)].isApprox(other.world[static_cast<std::size_t>(head)], 0))
        << f;
    // A foot keeps its attitude.
    const std::size_t foot = static_cast<std::size_t>(jointNamed(before, "LeftFoot"));
    EXPECT_TRUE(one.world[foot].linear().isApprox(other.world[foot].linear(), 1e-9)) << f;
  }
}

TEST(FootPlant, FeetThatAreDraggedOrFlyAreLeftAlone) {
  BvhMotion clean = ownClip("head_shake"), dragged = clean;
  for (int f = 0; f < dragged.clip.frameCount(); ++f)
    dragged.clip.translations[static_cast<std::size_t>(f * dragged.clip.joint_count)].z() +=
        0.5 * f * dragged.clip.frame_time;  // m/s
  EXPECT_EQ(app::plantFeet(dragged.skeleton, dragged.clip), "");
  EXPECT_EQ(app::plantFeet(clean.skeleton, clean.clip), "");
  app::Clip one;
  one.joint_count = 1;
  one.rotations = {Eigen::Quaterniond::Identity()};
  one.translations = {Vec3::Zero()};
  EXPECT_EQ(app::plantFeet({{{"a", -1, {}, {}}}}, one), "");
}

TEST(FootPlant, OwnClipsStandStill) {
  for (const char* name : {"walk", "idle_turns", "head_shake", "jump_spin", "dance"}) {
    BvhMotion motion = ownClip(name);
    EXPECT_EQ(app::plantFeet(motion.skeleton, motion.clip), "") << name;
  }
}

}  // namespace foot_plant_test
