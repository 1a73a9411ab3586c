// The project's own clips.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/motions.h"

namespace own_clips_test {

using namespace test;

TEST(OwnClips, AreAPersonStandingOnTheGround) {
  for (const char* name : {"idle_turns", "walk", "head_shake", "jump_spin", "dance"}) {
    SCOPED_TRACE(name);
    const fs::path file = kSource / "assets" / "clips" / (std::string(name) + ".bvh");
    EXPECT_LT(fs::file_size(file), 400U << 10);
    const BvhMotion motion = load(file);
    EXPECT_GE(motion.clip.duration(), 6);
    EXPECT_LE(motion.clip.duration(), 12);
    ASSERT_EQ(motion.skeleton.joints.size(), 22U);
    std::size_t toes[2] = {}, head = 0;
    for (std::size_t j = 0; j < 22; ++j) {
      if (motion.skeleton.joints[j].name == "LeftToe") toes[0] = j;
      if (motion.skeleton.joints[j].name == "RightToe") toes[1] = j;
      if (motion.skeleton.joints[j].name == "Head") head = j;
    }
    Playback captured;
    Pose before = at(motion, captured, 0);
    EXPECT_NEAR((app::restPose(motion.skeleton).world[head] * motion.end_sites[head]).y(), 1.70, 0.01);
    for (int f = 1; f < motion.clip.frameCount(); ++f) {
      const Pose pose = at(motion, captured, f * motion.clip.frame_time);
      for (const std::size_t toe : toes) {
        const Vec3 now = pose.world[toe].translation(), then = before.world[toe].translation();
        ASSERT_GT(now.y(), 0.012) << "frame " << f;  // the ball of the foot is 17 mm above the sole
        if (std::max(now.y(), then.y()) < 0.0172) {
          ASSERT_LT((now - then).norm(), 0.0012) << "planted foot slides in frame " << f;
        }
      }
      before = pose;
    }
  }
}

TEST(OwnClips, MoveTheHeadAsTheirNamesSay) {
  const auto fastestHead = [](const BvhMotion& motion) {
    double fastest = 0;
    for (int f = 1; f < motion.clip.frameCount(); ++f) {
      const double now = f * motion.clip.frame_time;
      const Pose a = at(motion, {}, now - motion.clip.frame_time), b = at(motion, {}, now);
      const std::size_t head = 5;
      EXPECT_EQ(motion.skeleton.joints[head].name, "Head");
      const Eigen::AngleAxisd turn(a.world[head].linear().transpose() * b.world[head].linear());
      fastest = std::max(fastest, turn.angle() / motion.clip.frame_time * 180 / M_PI);
    }
    return fastest;  // degrees per second
  };
  EXPECT_GT(fastestHead(ownClip("head_shake")), 500);
  EXPECT_GT(fastestHead(ownClip("jump_spin")), 500);
  EXPECT_LT(fastestHead(ownClip("walk")), 60);
  EXPECT_GT(fastestHead(ownClip("idle_turns")), 90);
}

}  // namespace own_clips_test
