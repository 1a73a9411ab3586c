// How a clip's rounds follow each other.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/motions.h"

namespace clip_loop_test {

using namespace test;

// The playback at the start of its next round.
Playback nextRound(const BvhMotion& motion, Playback playback) {
  playback.time = 0;
  app::advancePlayback(motion.clip, motion.clip.duration(), playback);
  return playback;
}

// One root joint at (x, z) facing `turn` (rad about y) in each frame, and a joint above it.
BvhMotion path(const std::vector<std::array<double, 3>>& frames) {
  app::Skeleton skeleton;
  skeleton.joints = {{"a", -1, {}, {}}, {"b", 0, {}, {}}};
  app::Clip clip{"path", 0.1, 2, {}, {}};
  for (const auto& [x, z, turn] : frames) {
    clip.rotations.emplace_back(Eigen::AngleAxisd(turn, Vec3::UnitY()));
    clip.rotations.emplace_back(Eigen::Quaterniond::Identity());
    clip.translations.emplace_back(x, 0.9, z);
    clip.translations.emplace_back(0, 0.6, 0.05);
  }
  return {skeleton, {}, {}, clip, {}};
}

LoopKind chosen(const BvhMotion& motion) {
  return playing(motion, LoopKind::kAuto).loop.kind;
}

TEST(ClipLoop, IsChosenByWhereTheClipEndsAndHowItGetsThere) {
  std::vector<std::array<double, 3>> there_and_back, even, stop_and_go, turned;
  for (int f = 0; f <= 20; ++f) {
    const double part = f / 20.0;
    there_and_back.push_back({std::sin(M_PI * part), 0, 0});
    even.push_back({3 + 0.1 * std::sin(20 * part), 2 * part, 0});
    stop_and_go.push_back({0, f < 15 ? 0 : 2 * (part - 0.75) / 0.25, 0});
    turned.push_back({0, 0, part});
  }
  EXPECT_EQ(chosen(path(there_and_back)), LoopKind::kInPlace);
  EXPECT_EQ(chosen(path(even)), LoopKind::kInPlace);
  EXPECT_EQ(chosen(path(stop_and_go)), LoopKind::kGoOn);
  EXPECT_EQ(chosen(path(turned)), LoopKind::kGoOn);
  EXPECT_EQ(chosen(path({{0, 0, 0}})), LoopKind::kStop) << "one frame";
  EXPECT_EQ(chosen(path({{0, 0, 0}, {1, 1, 1}})), LoopKind::kStop) << "a tenth of a second";
  EXPECT_EQ(playing(path(stop_and_go), LoopKind::kInPlace).loop.treadmill, false);
}

TEST(ClipLoop, ABlendTakesTheTimeThatItsGapNeeds) {
  BvhMotion motion = path(std::vector<std::array<double, 3>>(40, {0, 0, 0}));
  for (int f = 0; f < 40; ++f)
    motion.clip.rotations[static_cast<std::size_t>(2 * f + 1)] = Eigen::AngleAxisd(0.05 * f, Vec3::UnitX());
  const Playback playback = playing(motion, LoopKind::kAuto);
  EXPECT_EQ(playback.loop.kind, LoopKind::kInPlace) << "4 s for 2 rad";
  EXPECT_GT(playback.loop.blend, 1) << "at 1.5 rad/s";
}

TEST(ClipLoop, GoingOnRoundForRoundEqualsOneGreatStep) {
  const BvhMotion motion = turning(11);  // 1 m and 100 degrees within 1 s
  Playback round_for_round = playing(motion, LoopKind::kGoOn), at_once = round_for_round;
  EXPECT_NEAR(round_for_round.loop.travel.turn, 100 * M_PI / 180, 1e-6);
  long rounds = 0;
  for (int k = 0; k < 75; ++k) rounds += app::advancePlayback(motion.clip, 0.1, round_for_round);
  EXPECT_EQ(app::advancePlayback(motion.clip, 7.5, at_once), 7);
  EXPECT_EQ(rounds, 7);
  EXPECT_TRUE(round_for_round.place.rigid().isApprox(at_once.place.rigid(), 1e-9));
  EXPECT_NEAR(round_for_round.time, at_once.time, 1e-9);
  const Pose last = at(motion, playing(motion, LoopKind::kGoOn), 1);
  EXPECT_LT((last.world[0].translation() - Vec3(1, 0.9, 0)).norm(), 0.05) << "it travels";
}

TEST(ClipLoop, OnATreadmillTravelIsTakenOut) {
  const BvhMotion walk = ownClip("walk");
  double farthest = 0;
  const Playback stays = playing(walk, LoopKind::kInPlace);
  for (double t = 0; t < walk.clip.duration(); t += 0.05) {
    const Vec3 hips = at(walk, stays, t).world[0].translation();
    farthest = std::max(farthest, Vec3(hips.x(), 0, hips.z()).norm());
  }
  EXPECT_LT(farthest, 0.1);
  EXPECT_GT(at(walk, playing(walk, LoopKind::kGoOn), 6).world[0].translation().z(), 6) << "going on it travels";
}

TEST(ClipLoop, AnotherClipGoesOnFromAPose) {
  const BvhMotion motion = turning(11);
  Playback playback = playing(motion, LoopKind::kGoOn);
  playback.place = {4, -2, 1.1};
  const Pose pose = at(motion, playback, 0.63);
  playback.place = app::placeToGoOn(motion.skeleton, motion.clip, pose);
  EXPECT_LT((at(motion, playback, 0).world[0].translation() - pose.world[0].translation()).norm(), 1e-9);
  EXPECT_TRUE(at(motion, playback, 0).world[0].linear().isApprox(pose.world[0].linear(), 1e-6));
}

TEST(ClipLoop, KeepsLooseBodiesTogether) {
  // A motion of rigid bodies has no hierarchy: every body is a root, and all must be placed alike.
  app::Skeleton skeleton;
  app::Clip clip;
  clip.frame_time = 0.1;
  clip.joint_count = 3;
  skeleton.joints.resize(3);
  for (int f = 0; f < 4; ++f) {
    const Eigen::Quaterniond turn(Eigen::AngleAxisd(0.3 * f, Vec3::UnitY()));
    for (int j = 0; j < 3; ++j) {
      clip.rotations.push_back(turn);
      clip.translations.push_back(turn * Vec3(0.2 * j, 1 + j, -0.1 * j) + Vec3(0.5 * f, 0, 0));
    }
  }
  const BvhMotion motion{skeleton, {}, {}, clip, {}};
  Playback going = playing(motion, LoopKind::kGoOn);
  const Playback blended = going, stopped = playing(motion, LoopKind::kStop);
  going.loop.blend = 0;
  for (const double t : {0.1, 0.2, 0.3}) {
    const Pose placed = at(motion, going, t), captured = at(motion, stopped, t);
    for (std::size_t j = 1; j < 3; ++j) {
      const app::Rigid a = placed.world[0].inverse() * placed.world[j];
      EXPECT_TRUE(a.isApprox(captured.world[0].inverse() * captured.world[j], 1e-6));
    }
  }
  EXPECT_LT(distance(at(motion, nextRound(motion, blended), 0), at(motion, blended, 0.3)), 1e-9);
}

}  // namespace clip_loop_test
