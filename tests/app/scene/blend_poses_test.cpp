// Poses between two others: limbs keep their length, and the head is where the hair is.
#include <gtest/gtest.h>

#include <cmath>

#include "app/scene/sim_to_render.h"
#include "tests/motions.h"

namespace blend_poses_test {

using namespace test;

double boneLength(const BvhMotion& motion, const Pose& pose, std::size_t joint) {
  const auto parent = static_cast<std::size_t>(motion.skeleton.joints[joint].parent);
  return (pose.world[joint].translation() - pose.world[parent].translation()).norm();
}

TEST(BlendPoses, LimbsKeepTheirLengthHoweverFarApartThePosesAre) {
  const BvhMotion motion = ownClip("jump_spin");
  constexpr int kHead = 5;
  double pinched = 0;
  for (int f = 10; f + 20 < motion.clip.frameCount(); f += 15) {
    Pose from, to, between;
    app::samplePose(motion.skeleton, motion.clip, f * motion.clip.frame_time, from);
    app::samplePose(motion.skeleton, motion.clip, (f + 15) * motion.clip.frame_time, to);
    for (const double fraction : {0.0, 0.3, 0.5, 1.0}) {
      app::blendPoses(motion.skeleton, kHead, from, to, fraction, between);
      for (std::size_t j = 0; j < motion.skeleton.joints.size(); ++j) {
        if (motion.skeleton.joints[j].parent < 0) continue;
        ASSERT_NEAR(boneLength(motion, between, j), boneLength(motion, to, j), 1e-9) << f << " " << j;
        const auto p = static_cast<std::size_t>(motion.skeleton.joints[j].parent);
        const Vec3 a = from.world[j].translation() - from.world[p].translation(),
                   b = to.world[j].translation() - to.world[p].translation();
        pinched = std::max(pinched, boneLength(motion, to, j) - (a + 0.5 * (b - a)).norm());
      }
      const Vec3 head = from.world[kHead].translation() +
                        fraction * (to.world[kHead].translation() - from.world[kHead].translation());
      EXPECT_LT((between.world[kHead].translation() - head).norm(), 1e-9) << f;
    }
  }
  EXPECT_GT(pinched, 0.01) << "m: a blend in the world would have shortened a limb";
}

TEST(BlendPoses, APoseThatStandsStillStaysToTheBit) {
  const BvhMotion motion = ownClip("walk");
  Pose pose, between;
  app::samplePose(motion.skeleton, motion.clip, 0.4, pose);
  for (const double fraction : {0.0, 0.37, 1.0}) {
    app::blendPoses(motion.skeleton, 5, pose, pose, fraction, between);
    for (std::size_t j = 0; j < pose.world.size(); ++j)
      EXPECT_EQ(between.world[j].matrix(), pose.world[j].matrix()) << j;
  }
}

}  // namespace blend_poses_test
