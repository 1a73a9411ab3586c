// Sampling and playing clips, and the seam of a loop.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "tests/motions.h"

namespace playback_test {

using namespace test;

// Fastest joint over the clip without its blend, m/s.
double topSpeed(const BvhMotion& motion, const Playback& playback) {
  Playback open = playback;
  open.loop.blend = 0;
  double largest = 0;
  for (int f = 0; f + 1 < motion.clip.frameCount(); ++f) {
    const double t = f * motion.clip.frame_time;
    largest = std::max(largest, distance(at(motion, open, t), at(motion, open, t + motion.clip.frame_time)));
  }
  return largest / motion.clip.frame_time;
}

// Per joint, the largest change of velocity from one frame interval to the next, m/s: sampled motion has no smoother
// one.
std::vector<double> largestKinks(const BvhMotion& motion, const Playback& playback) {
  Playback open = playback;
  open.loop.blend = 0;
  std::vector<double> kinks(motion.skeleton.joints.size(), 0);
  for (int f = 1; f + 1 < motion.clip.frameCount(); ++f) {
    const double h = motion.clip.frame_time;
    const Pose a = at(motion, open, (f - 1) * h), b = at(motion, open, f * h), c = at(motion, open, (f + 1) * h);
    for (std::size_t j = 0; j < kinks.size(); ++j) {
      const Vec3 change = a.world[j].translation() - 2 * b.world[j].translation() + c.world[j].translation();
      kinks[j] = std::max(kinks[j], change.norm() / h);
    }
  }
  return kinks;
}

TEST(SamplePose, AFramesOwnTimeGivesThatFrameExactly) {
  const BvhMotion motion = ownClip("jump_spin");
  const auto joints = static_cast<std::size_t>(motion.clip.joint_count);
  for (int f = 0; f < motion.clip.frameCount(); ++f) {
    Pose pose;
    app::samplePose(motion.skeleton, motion.clip, f * motion.clip.frame_time, pose);
    for (std::size_t j = 0; j < joints; ++j) {
      const std::size_t i = static_cast<std::size_t>(f) * joints + j;
      app::Rigid world = Eigen::Translation3d(motion.clip.translations[i]) * motion.clip.rotations[i];
      const int parent = motion.skeleton.joints[j].parent;
      if (parent >= 0) world = pose.world[static_cast<std::size_t>(parent)] * world;
      ASSERT_EQ(pose.world[j].matrix(), world.matrix()) << "frame " << f << " joint " << j;
    }
  }
}

TEST(SamplePose, BetweenFramesIsBetween) {
  const BvhMotion motion = turning(5);
  for (const double part : {0.25, 0.5, 0.9}) {
    Pose pose;
    app::samplePose(motion.skeleton, motion.clip, (1 + part) * 0.1, pose);
    EXPECT_NEAR(pose.world[0].translation().x(), 0.1 * (1 + part), 1e-12);
    const double yaw = std::atan2(pose.world[0].linear()(0, 2), pose.world[0].linear()(2, 2));
    EXPECT_NEAR(yaw, (1 + part) * 10 * M_PI / 180, 1e-9);
  }
}

TEST(SamplePose, TimesOutsideTheClipAreItsEnds) {
  const BvhMotion motion = turning(5);
  const Pose first = at(motion, playing(motion, LoopKind::kStop), 0);
  const auto sampled = [&](double time) {
    Pose pose;
    app::samplePose(motion.skeleton, motion.clip, time, pose);
    return pose;
  };
  EXPECT_EQ(distance(sampled(-3), first), 0);
  EXPECT_EQ(distance(sampled(std::nan("")), first), 0);
  EXPECT_EQ(distance(sampled(1e300), sampled(0.4)), 0);
  EXPECT_EQ(distance(sampled(HUGE_VAL), sampled(0.4)), 0);
}

TEST(RestPose, IsTheSkeletonsRestWorld) {
  const BvhMotion motion = ownClip("walk");
  const Pose rest = app::restPose(motion.skeleton);
  ASSERT_EQ(rest.world.size(), motion.skeleton.joints.size());
  for (std::size_t j = 0; j < rest.world.size(); ++j) {
    EXPECT_TRUE(rest.world[j].linear().isIdentity(0));
    EXPECT_EQ(rest.world[j].matrix(), motion.skeleton.joints[j].rest_world.matrix());
  }
}

TEST(AdvancePlayback, ObeysSpeedPauseAndTheClipsEnds) {
  const app::Clip clip = turning(11).clip;  // 1 s
  Playback playback;
  playback.speed = 20;
  playback.loop.kind = LoopKind::kNone;
  app::advancePlayback(clip, 0.02, playback);
  EXPECT_NEAR(playback.time, 0.4, 1e-12);
  playback.paused = true;
  app::advancePlayback(clip, 0.02, playback);
  EXPECT_NEAR(playback.time, 0.4, 1e-12);
  playback.paused = false;
  app::advancePlayback(clip, 0.05, playback);
  EXPECT_NEAR(playback.time, 0.4, 1e-12) << "a loop wraps";
  playback.loop.kind = LoopKind::kStop;
  app::advancePlayback(clip, 7, playback);
  EXPECT_EQ(playback.time, clip.duration()) << "without a loop it stays at the end";
  playback.speed = 0;
  app::advancePlayback(clip, 1, playback);
  EXPECT_EQ(playback.time, clip.duration());
}

TEST(AdvancePlayback, NoStepLeavesTheClip) {
  const app::Clip clip = turning(11).clip;
  for (const double step : {1e-300, 0.3, 17.77, 1e9, 1e300, HUGE_VAL, -5.0, -HUGE_VAL, std::nan("")}) {
    for (const double scrub : {0.0, 0.99, 1.0, 55.0, -3.0, std::nan("")}) {
      for (const LoopKind kind : {LoopKind::kGoOn, LoopKind::kInPlace, LoopKind::kStop, LoopKind::kNone}) {
        Playback playback;
        playback.time = scrub;
        playback.speed = 3;
        playback.loop.kind = kind;
        playback.loop.travel = {1, 2, 0.3};
        app::advancePlayback(clip, step, playback);
        EXPECT_TRUE(playback.place.rigid().matrix().allFinite());
        EXPECT_GE(playback.time, 0) << step << " from " << scrub;
        EXPECT_LE(playback.time, clip.duration()) << step << " from " << scrub;
      }
    }
  }
}

// Every clip at hand, going on and staying in place.
void forEachLoop(const std::function<void(const BvhMotion&, const Playback&)>& look) {
  const std::vector<BvhMotion> clips = allClips();
  ASSERT_GE(clips.size(), 5U);
  for (const BvhMotion& motion : clips) {
    for (const LoopKind kind : {LoopKind::kGoOn, LoopKind::kInPlace}) {
      SCOPED_TRACE(motion.clip.name + " " + std::string(app::loopName(kind)));
      look(motion, playing(motion, kind));
    }
  }
}

// The playback at the start of its next round.
Playback nextRound(const BvhMotion& motion, Playback playback) {
  playback.time = 0;
  app::advancePlayback(motion.clip, motion.clip.duration(), playback);
  return playback;
}

TEST(Seam, JoinsTheClipsEndToItsStart) {
  forEachLoop([](const BvhMotion& motion, const Playback& playback) {
    const Playback next = nextRound(motion, playback);
    Pose last = at(motion, playback, motion.clip.duration());
    if (playback.loop.cuts()) {
      for (app::Rigid& joint : last.world) joint = playback.loop.travel.rigid().inverse() * joint;
    }
    EXPECT_LT(distance(last, at(motion, next, 0)), 1e-6);
  });
}

// Largest angle between two neighbouring moments of a joint against its parent, rad.
double largestTurn(const BvhMotion& motion, const Pose& a, const Pose& b) {
  double largest = 0;
  for (std::size_t j = 0; j < a.world.size(); ++j) {
    const auto local = [&](const Pose& pose) -> Eigen::Matrix3d {
      const int parent = motion.skeleton.joints[j].parent;
      if (parent < 0) return pose.world[j].linear();
      return pose.world[static_cast<std::size_t>(parent)].linear().transpose() * pose.world[j].linear();
    };
    largest = std::max(largest, Eigen::AngleAxisd(local(a).transpose() * local(b)).angle());
  }
  return largest;
}

TEST(Seam, TurnsNoJointFasterThanTheClipsFastest) {
  forEachLoop([](const BvhMotion& motion, const Playback& playback) {
    Playback open = playback;
    open.loop.blend = 0;
    const double step = motion.clip.frame_time;
    double fastest = 0, blended = 0;
    for (int f = 1; f < motion.clip.frameCount(); ++f) {
      const double before = (f - 1) * step, now = f * step;
      fastest = std::max(fastest, largestTurn(motion, at(motion, open, before), at(motion, open, now)));
      blended = std::max(blended, largestTurn(motion, at(motion, playback, before), at(motion, playback, now)));
    }
    EXPECT_LT(blended, 1.1 * fastest);
  });
}

TEST(Seam, MovesNoJointMuchFasterThanTheClipDoes) {
  forEachLoop([](const BvhMotion& motion, Playback playback) {
    if (playback.loop.cuts()) return;
    const double top = topSpeed(motion, playback), step = 1.0 / 240;
    playback.time = motion.clip.duration() - playback.loop.blend;
    Pose before, after;
    app::poseAt(motion.skeleton, motion.clip, playback, before);
    for (int k = 0; k < playback.loop.blend / step + 20; ++k) {
      app::advancePlayback(motion.clip, step, playback);
      app::poseAt(motion.skeleton, motion.clip, playback, after);
      ASSERT_LT(distance(before, after), 1.75 * top * step) << "at " << playback.time << " s";
      std::swap(before, after);
    }
  });
}

// Two joints in smooth motion that ends elsewhere and at another velocity than it began.
BvhMotion smoothMotion() {
  app::Skeleton skeleton;
  skeleton.joints = {{"a", -1, {}, {}}, {"b", 0, {}, {}}};
  app::Clip clip{"smooth", 1.0 / 60, 2, {}, {}};
  for (int f = 0; f <= 90; ++f) {
    const double t = f * clip.frame_time;
    const Vec3 swing(std::sin(4 * t), 0.3 * t, std::cos(3 * t)),
        bend(0.4 * t, 1.2 * std::sin(5 * t), 0.5 * std::cos(4 * t));
    for (const double part : {1.0, 0.7}) {
      clip.rotations.emplace_back(Eigen::AngleAxisd(bend.norm() * part, bend.normalized()));
      clip.translations.push_back(part * swing);
    }
  }
  return {skeleton, {}, {}, clip, {}};
}

TEST(Seam, KeepsVelocity) {
  std::vector<BvhMotion> clips = allClips();
  clips.push_back(smoothMotion());
  for (const BvhMotion& motion : clips) {
    SCOPED_TRACE(motion.clip.name);
    const Playback playback = playing(motion, LoopKind::kGoOn), next = nextRound(motion, playback);
    const double step = 1e-5, end = motion.clip.duration();
    const Pose a = at(motion, playback, end - step), b = at(motion, next, 0), c = at(motion, next, step);
    const std::vector<double> kink = largestKinks(motion, playback);
    for (std::size_t j = 0; j < a.world.size(); ++j) {
      const Vec3 arriving = (b.world[j].translation() - a.world[j].translation()) / step;
      const Vec3 leaving = (c.world[j].translation() - b.world[j].translation()) / step;
      EXPECT_LT((arriving - leaving).norm(), 0.01 + 3 * kink[j]) << motion.skeleton.joints[j].name;
    }
  }
}

TEST(Seam, LeavesTheRestOfTheClipAlone) {
  forEachLoop([](const BvhMotion& motion, const Playback& playback) {
    if (playback.loop.treadmill) return;
    const app::GroundPlace& start = playback.loop.start;
    for (double t = 0; t < motion.clip.duration() - playback.loop.blend; t += 0.037) {
      Pose plain;
      app::samplePose(motion.skeleton, motion.clip, t, plain);
      for (app::Rigid& joint : plain.world) joint.translation() -= Vec3(start.x, 0, start.z);
      ASSERT_LT(distance(at(motion, playback, t), plain), 1e-12) << t;
    }
  });
}

TEST(Seam, AClipThatLoopsAlreadyIsPlayedAsItIs) {
  for (const char* name : {"idle_turns", "walk", "head_shake", "jump_spin", "dance"}) {
    const BvhMotion motion = ownClip(name);
    const Playback playback = playing(motion, LoopKind::kAuto);
    EXPECT_TRUE(playback.loop.treadmill) << name;
    Playback open = playback;
    open.loop.blend = 0;
    for (double t = motion.clip.duration() - 0.4; t < motion.clip.duration(); t += 0.01) {
      EXPECT_LT(distance(at(motion, playback, t), at(motion, open, t)), 0.005) << name << " at " << t;
    }
  }
}

TEST(Seam, ShortAndStillClipsHaveOneToo) {
  for (const int frames : {2, 3, 4}) {
    const BvhMotion motion = turning(frames);
    for (const LoopKind kind : {LoopKind::kAuto, LoopKind::kGoOn, LoopKind::kInPlace, LoopKind::kNone}) {
      Playback playback = playing(motion, kind);
      for (double t = 0; t < 0.3; t += 0.01) {
        for (const app::Rigid& joint : at(motion, playback, t).world) ASSERT_TRUE(joint.matrix().allFinite());
      }
    }
  }
}

}  // namespace playback_test
