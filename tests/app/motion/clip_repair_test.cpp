// Captures with faults planted into them come back to what they were.
#include "app/motion/clip_repair.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/motions.h"

namespace clip_repair_test {

using namespace test;

std::size_t indexOf(const app::Clip& clip, int frame, int joint) {
  return static_cast<std::size_t>(frame * clip.joint_count + joint);
}

// Largest distance of a joint between two clips over all frames, m.
double difference(const BvhMotion& a, const BvhMotion& b) {
  double most = 0;
  for (int f = 0; f < a.clip.frameCount(); ++f) {
    Pose one, other;
    app::samplePose(a.skeleton, a.clip, f * a.clip.frame_time, one);
    app::samplePose(b.skeleton, b.clip, f * b.clip.frame_time, other);
    most = std::max(most, distance(one, other));
  }
  return most;
}

int headOf(const BvhMotion& motion) {
  for (std::size_t j = 0; j < motion.skeleton.joints.size(); ++j) {
    if (motion.skeleton.joints[j].name == "Head") return static_cast<int>(j);
  }
  ADD_FAILURE() << "no head";
  return 0;
}

TEST(ClipRepair, CleanClipsStayAsTheyAre) {
  const std::vector<BvhMotion> clips = allClips();
  ASSERT_GE(clips.size(), 5U);
  for (const BvhMotion& motion : clips) {
    BvhMotion repaired = motion;
    const std::vector<std::string> notes = app::repairClip(repaired.skeleton, repaired.clip);
    for (const std::string& note : notes) EXPECT_EQ(note.find("jumps"), std::string::npos) << motion.clip.name << note;
    // The dance captured by a suit has fingers that pop.
    const double limit = motion.clip.name == "rokoko_dance" ? 0.1 : 0;
    EXPECT_LE(difference(motion, repaired), limit) << motion.clip.name << ": " << (notes.empty() ? "" : notes[0]);
  }
}

TEST(ClipRepair, PopsOfTheHeadAndTheRootArePutBack) {
  const BvhMotion clean = ownClip("walk");
  const int head = headOf(clean);
  for (const int length : {1, 2, 3}) {
    BvhMotion motion = clean;
    for (int f = 100; f < 100 + length; ++f) {
      motion.clip.rotations[indexOf(motion.clip, f, head)] *= Eigen::Quaterniond(Eigen::AngleAxisd(0.9, Vec3::UnitZ()));
      motion.clip.translations[indexOf(motion.clip, f + 80, 0)] += Vec3(2, 0, 0);
    }
    ASSERT_GT(difference(clean, motion), 1.9);
    const std::vector<std::string> notes = app::repairClip(motion.skeleton, motion.clip);
    ASSERT_EQ(notes.size(), 1U) << length;
    EXPECT_NE(notes[0].find("pops: " + std::to_string(2 * length) + " frames"), std::string::npos) << notes[0];
    EXPECT_LT(difference(clean, motion), 0.005) << length;
  }
}

TEST(ClipRepair, AJumpOverTheGroundIsCarriedOver) {
  const BvhMotion clean = ownClip("walk");
  BvhMotion motion = clean;
  for (int f = 200; f < motion.clip.frameCount(); ++f)
    motion.clip.translations[indexOf(motion.clip, f, 0)] += Vec3(-2, 0, 1);
  const std::vector<std::string> notes = app::repairClip(motion.skeleton, motion.clip);
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_NE(notes[0].find("jumps: 1"), std::string::npos) << notes[0];
  EXPECT_LT(difference(clean, motion), 0.03) << "but for a frame's way";
}

TEST(ClipRepair, DroppedFramesBecomeEvenSteps) {
  const BvhMotion clean = ownClip("walk");
  BvhMotion motion = clean;
  for (const int f : {150, 200, 201, 230, 231, 232}) {
    for (int j = 0; j < motion.clip.joint_count; ++j) {
      motion.clip.rotations[indexOf(motion.clip, f, j)] = motion.clip.rotations[indexOf(motion.clip, f - 1, j)];
      motion.clip.translations[indexOf(motion.clip, f, j)] = motion.clip.translations[indexOf(motion.clip, f - 1, j)];
    }
  }
  const double faulty = difference(clean, motion);
  const std::vector<std::string> notes = app::repairClip(motion.skeleton, motion.clip);
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_EQ(notes[0], "6 dropped frames: made even steps");
  EXPECT_LT(difference(clean, motion), 0.25 * faulty);
}

TEST(ClipRepair, ShortClipsAreLeftAlone) {
  for (const int frames : {2, 3, 4}) {
    BvhMotion motion = turning(frames);
    EXPECT_TRUE(app::repairClip(motion.skeleton, motion.clip).empty()) << frames;
  }
  app::Clip one{"one", 0.1, 1, {Eigen::Quaterniond::Identity()}, {Vec3::Zero()}};
  EXPECT_TRUE(app::repairClip({{{"a", -1, {}, {}}}}, one).empty());
}

}  // namespace clip_repair_test
