// Sampling and playing clips, and the project's own clips.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>

#include "app/files/text_file.h"
#include "app/motion/motion.h"

namespace {

using app::BvhMotion;
using app::Playback;
using app::Pose;
using app::Vec3;
namespace fs = std::filesystem;

const fs::path kSource = HAIRMESH_SOURCE_DIR;

BvhMotion load(const fs::path& file) {
  return app::readBvh(app::readText(file.string()), file.string());
}
BvhMotion ownClip(const std::string& name) {
  return load(kSource / "assets" / "clips" / (name + ".bvh"));
}

std::vector<BvhMotion> allClips() {
  std::vector<BvhMotion> clips;
  for (const fs::path& folder : {kSource / "assets" / "clips", kSource / ".." / "shared" / "mocap"}) {
    if (!fs::exists(folder)) continue;
    for (const auto& entry : fs::directory_iterator(folder)) {
      if (entry.path().extension() == ".bvh") clips.push_back(load(entry.path()));
    }
  }
  return clips;
}

Pose at(const BvhMotion& motion, Playback playback, double time) {
  Pose pose;
  playback.time = time;
  app::poseAt(motion.skeleton, motion.clip, playback, pose);
  return pose;
}

// Largest distance of a joint between two poses, m.
double distance(const Pose& a, const Pose& b) {
  double largest = 0;
  for (std::size_t j = 0; j < a.world.size(); ++j) {
    largest = std::max(largest, (a.world[j].translation() - b.world[j].translation()).norm());
  }
  return largest;
}

// Fastest joint over the clip without its blend, m/s.
double topSpeed(const BvhMotion& motion, const Playback& playback) {
  Playback open = playback;
  open.loop = false;
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
  open.loop = false;
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

// Two joints; the root turns about y by 10 degrees a frame and moves along x by 0.1 m a frame.
BvhMotion turning(int frames) {
  std::string text =
      "HIERARCHY\nROOT a {\nOFFSET 0 0.9 0\nCHANNELS 6 Xposition Yposition Zposition Yrotation Xrotation Zrotation\n"
      "JOINT b {\nOFFSET 0 1.5 0.1\nCHANNELS 3 Xrotation Yrotation Zrotation\n}\n}\nMOTION\nFrames: " +
      std::to_string(frames) + "\nFrame Time: 0.1\n";
  for (int f = 0; f < frames; ++f) {
    text += std::to_string(0.1 * f) + " 0.9 0 " + std::to_string(10 * f) + " 0 0 " + std::to_string(f % 2 ? 30 : 0) +
            " 0 0\n";
  }
  return app::readBvh(text, "turning");
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
  const Pose first = at(motion, {.loop = false, .in_place = false}, 0);
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
  app::advancePlayback(clip, 0.02, playback);
  EXPECT_NEAR(playback.time, 0.4, 1e-12);
  playback.paused = true;
  app::advancePlayback(clip, 0.02, playback);
  EXPECT_NEAR(playback.time, 0.4, 1e-12);
  playback.paused = false;
  app::advancePlayback(clip, 0.05, playback);
  EXPECT_NEAR(playback.time, 0.4, 1e-12) << "a loop wraps";
  playback.loop = false;
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
      for (const bool loop : {true, false}) {
        Playback playback{.time = scrub, .speed = 3, .loop = loop};
        app::advancePlayback(clip, step, playback);
        EXPECT_GE(playback.time, 0) << step << " from " << scrub;
        EXPECT_LE(playback.time, clip.duration()) << step << " from " << scrub;
      }
    }
  }
}

TEST(Seam, JoinsTheClipsEndToItsStart) {
  for (const BvhMotion& motion : allClips()) {
    SCOPED_TRACE(motion.clip.name);
    for (const bool in_place : {true, false}) {
      const Playback playback{.in_place = in_place};
      EXPECT_LT(distance(at(motion, playback, motion.clip.duration()), at(motion, playback, 0)), 1e-6);
    }
  }
}

TEST(Seam, StaysWithinTheClipsOwnSpeed) {
  for (const BvhMotion& motion : allClips()) {
    SCOPED_TRACE(motion.clip.name);
    Playback playback;
    const double top = topSpeed(motion, playback), step = 1.0 / 240;
    playback.time = motion.clip.duration() - playback.blend - 5 * step;
    Pose before, after;
    app::poseAt(motion.skeleton, motion.clip, playback, before);
    for (int k = 0; k < 150; ++k) {
      app::advancePlayback(motion.clip, step, playback);
      app::poseAt(motion.skeleton, motion.clip, playback, after);
      ASSERT_LT(distance(before, after), 1.6 * top * step) << "at " << playback.time << " s";
      std::swap(before, after);
    }
  }
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
    const Playback playback;
    const double step = 1e-5, end = motion.clip.duration();
    const Pose a = at(motion, playback, end - step), b = at(motion, playback, 0), c = at(motion, playback, step);
    const std::vector<double> kink = largestKinks(motion, playback);
    for (std::size_t j = 0; j < a.world.size(); ++j) {
      const Vec3 arriving = (b.world[j].translation() - a.world[j].translation()) / step;
      const Vec3 leaving = (c.world[j].translation() - b.world[j].translation()) / step;
      EXPECT_LT((arriving - leaving).norm(), 0.01 + 3 * kink[j]) << motion.skeleton.joints[j].name;
    }
  }
}

TEST(Seam, LeavesTheRestOfTheClipAlone) {
  for (const BvhMotion& motion : allClips()) {
    const Playback loop{.in_place = false}, open{.loop = false, .in_place = false};
    for (double t = 0; t < motion.clip.duration() - loop.blend; t += 0.037) {
      Pose plain;
      app::samplePose(motion.skeleton, motion.clip, t, plain);
      ASSERT_EQ(distance(at(motion, loop, t), plain), 0) << motion.clip.name << " at " << t;
      ASSERT_EQ(distance(at(motion, open, t), plain), 0);
    }
  }
}

TEST(Seam, AClipThatLoopsAlreadyIsPlayedAsItIs) {
  for (const char* name : {"idle_turns", "walk", "head_shake", "jump_spin", "dance"}) {
    const BvhMotion motion = ownClip(name);
    for (double t = motion.clip.duration() - 0.4; t < motion.clip.duration(); t += 0.01) {
      EXPECT_LT(distance(at(motion, {}, t), at(motion, {.loop = false}, t)), 0.005) << name << " at " << t;
    }
  }
}

TEST(Seam, ShortAndStillClipsHaveOneToo) {
  for (const int frames : {2, 3, 4}) {
    const BvhMotion motion = turning(frames);
    for (const double blend : {0.0, 0.4, 1e9, -1.0}) {
      const Playback playback{.blend = blend};
      for (double t = 0; t < 0.3; t += 0.01) {
        for (const app::Rigid& joint : at(motion, playback, t).world) ASSERT_TRUE(joint.matrix().allFinite());
      }
      if (blend > 0) {
        EXPECT_LT(distance(at(motion, playback, motion.clip.duration()), at(motion, playback, 0)), 1e-9);
      }
    }
  }
}

TEST(InPlace, TakesTravelAndTurnOutEvenly) {
  const BvhMotion motion = turning(11);  // 1 m and 100 degrees within 1 s
  const Playback playback{.loop = false};
  for (const double t : {0.0, 0.33, 0.7, 1.0}) {
    const Pose pose = at(motion, playback, t);
    EXPECT_LT((pose.world[0].translation() - Vec3(0, 0.9, 0)).norm(), 1e-9) << t;
    EXPECT_TRUE(pose.world[0].linear().isIdentity(1e-6)) << t;
  }
  const BvhMotion walk = ownClip("walk");
  double farthest = 0;
  for (double t = 0; t < walk.clip.duration(); t += 0.05) {
    const Vec3 hips = at(walk, {}, t).world[0].translation();
    farthest = std::max(farthest, Vec3(hips.x(), 0, hips.z()).norm());
  }
  EXPECT_LT(farthest, 0.1);
  EXPECT_GT(at(walk, {.in_place = false}, 6).world[0].translation().z(), 6) << "left as captured it travels";
}

TEST(InPlace, KeepsLooseBodiesTogether) {
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
  for (const double t : {0.1, 0.2, 0.3}) {
    const Pose placed = at(motion, {.loop = false}, t), captured = at(motion, {.loop = false, .in_place = false}, t);
    for (std::size_t j = 1; j < 3; ++j) {
      const app::Rigid a = placed.world[0].inverse() * placed.world[j];
      EXPECT_TRUE(a.isApprox(captured.world[0].inverse() * captured.world[j], 1e-9));
    }
  }
  EXPECT_LT(distance(at(motion, {.loop = false}, 0), at(motion, {.loop = false}, 0.3)), 1e-9);
}

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
    const Playback captured{.loop = false, .in_place = false};
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
      const Pose a = at(motion, {}, (f - 1) * motion.clip.frame_time), b = at(motion, {}, f * motion.clip.frame_time);
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

}  // namespace
