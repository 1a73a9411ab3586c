// Hands that a capture lost for a while are named, and those that it never had are not.
#include "app/motion/frozen_hands.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/motions.h"

namespace frozen_hands_test {

using test::BvhMotion;

TEST(FrozenHands, NoCleanClipHasAny) {
  for (const BvhMotion& motion : test::allClips())
    EXPECT_EQ(app::frozenHands(motion.skeleton, motion.clip), "") << motion.clip.name;
}

TEST(FrozenHands, AStretchOfOneIsNamedWithItsTime) {
  BvhMotion motion = test::ownClip("walk");
  int looked = 0;
  for (std::size_t j = 0; j < motion.skeleton.joints.size(); ++j) {
    const std::string& name = motion.skeleton.joints[j].name;
    if (name != "LeftForeArm" && name != "RightForeArm") continue;
    ++looked;
    for (const double seconds : {0.4, 0.7}) {
      app::Clip clip = motion.clip;
      const int first = 60, last = first + static_cast<int>(seconds / clip.frame_time + 0.5);
      ASSERT_LT(last, clip.frameCount());
      const auto at = [&](int f) { return static_cast<std::size_t>(f * clip.joint_count) + j; };
      for (int f = first; f <= last; ++f) clip.rotations[at(f)] = clip.rotations[at(first)];
      const std::string note = app::frozenHands(motion.skeleton, clip);
      if (seconds < 0.5) {
        EXPECT_EQ(note, "") << name;
        continue;
      }
      EXPECT_NE(note.find("'" + name + "' from "), std::string::npos) << note;
      EXPECT_EQ(note.find(", '"), std::string::npos) << note;
    }
    app::Clip never = motion.clip;
    for (int f = 0; f < never.frameCount(); ++f)
      never.rotations[static_cast<std::size_t>(f * never.joint_count) + j] = never.rotations[j];
    EXPECT_EQ(app::frozenHands(motion.skeleton, never), "") << "it was not captured";
  }
  EXPECT_EQ(looked, 2);
}

}  // namespace frozen_hands_test
