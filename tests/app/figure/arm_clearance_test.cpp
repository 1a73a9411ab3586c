// Arms that a clip leads into the trunk are turned out at the shoulder; all others stay as they are.
#include "app/figure/arm_clearance.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "app/figure/ellipsoid_fit.h"

namespace arm_clearance_test {

namespace fs = std::filesystem;
using app::Vec3;
using Eigen::AngleAxisd;
using Eigen::Quaterniond;

constexpr double kFrameTime = 0.02;
constexpr int kFrames = 200, kUpper = 1, kFore = 2;

void addPart(const std::string& name, int joint, const Vec3& center, const Vec3& radii, app::Character& c) {
  app::BodyEllipsoid e;
  e.name = name, e.joint = joint, e.center = center, e.radii = radii;
  c.ellipsoids.push_back(e);
}

// A chest of 15 cm, an upper arm that hangs 20 cm beside its middle and a forearm of 25 cm below it, which bends across
// the chest and back again within two seconds from the first one on.
app::Character bender(double most_bend) {
  app::Character c;
  const std::pair<const char*, int> joints[] = {{"chest", -1}, {"LeftArm", 0}, {"LeftForeArm", 1}};
  for (const auto& [name, parent] : joints) {
    app::Joint joint;
    joint.name = name, joint.parent = parent;
    c.skeleton.joints.push_back(joint);
  }
  addPart("chest", 0, Vec3::Zero(), Vec3::Constant(0.15), c);
  addPart("left_upper_arm", kUpper, Vec3(0, -0.12, 0), Vec3(0.04, 0.15, 0.04), c);
  addPart("left_forearm", kFore, Vec3(0, -0.12, 0), Vec3(0.035, 0.15, 0.035), c);
  app::Clip clip;
  clip.frame_time = kFrameTime, clip.joint_count = 3;
  for (int f = 0; f < kFrames; ++f) {
    const double time = f * kFrameTime - 1, part = time > 0 && time < 2 ? std::sin(EIGEN_PI * time / 2) : 0;
    const Quaterniond raised(AngleAxisd(-0.35, Vec3::UnitX()));
    const Quaterniond bent(AngleAxisd(-most_bend * part, Vec3(0.3, 0, 1).normalized()));
    clip.rotations.insert(clip.rotations.end(), {Quaterniond::Identity(), raised, bent});
    clip.translations.insert(clip.translations.end(), {Vec3::Zero(), Vec3(0.20, 0.15, 0), Vec3(0, -0.25, 0)});
  }
  c.clips.push_back(clip);
  return c;
}

double turned(const app::Clip& a, const app::Clip& b, int frame, int joint) {
  const auto at = static_cast<std::size_t>(frame * a.joint_count + joint);
  return a.rotations[at].angularDistance(b.rotations[at]);
}

// m, how deep forearms and hands go into the trunk, at three places along each, ten times a second.
double depthInTrunk(const app::Character& c, const app::Clip& clip) {
  double deepest = 0;
  app::Pose pose;
  for (double time = 0; time <= clip.duration(); time += 0.1) {
    app::samplePose(c.skeleton, clip, time, pose);
    for (const app::BodyEllipsoid& limb : c.ellipsoids) {
      if (!limb.name.ends_with("_forearm") && !limb.name.ends_with("_hand")) continue;
      int axis = 0;
      limb.radii.maxCoeff(&axis);
      for (const app::BodyEllipsoid& trunk : c.ellipsoids) {
        if (trunk.name != "waist" && !trunk.name.ends_with("chest")) continue;
        for (const double share : {-0.5, 0.0, 0.5}) {
          const Vec3 place = limb.center + share * limb.radii[axis] * (limb.rotation * Vec3::Unit(axis));
          const Vec3 p = pose.world[trunk.joint].inverse() * (pose.world[limb.joint] * place);
          deepest = std::max(deepest, limb.radii.minCoeff() - app::ellipsoidGap(trunk, p));
        }
      }
    }
  }
  return deepest;
}

TEST(ArmClearance, HoldsAForearmOutsideTheChest) {
  const app::Character c = bender(1.7);
  app::Clip clip = c.clips.front();
  const double before = depthInTrunk(c, clip);
  ASSERT_GT(before, 0.03);
  EXPECT_FALSE(app::clearArms(c, clip).empty());
  EXPECT_LT(depthInTrunk(c, clip), 0.006);

  double fastest = 0, fastest_before = 0;
  for (int f = 0; f < kFrames; ++f) {
    // The shoulder alone turns, and only where the arm is about to touch.
    EXPECT_EQ(turned(clip, c.clips.front(), f, 0) + turned(clip, c.clips.front(), f, kFore), 0) << f;
    if (f * kFrameTime < 0.6 || f * kFrameTime > 3.4) {
      EXPECT_LT(turned(clip, c.clips.front(), f, kUpper), 0.003) << f;
    }
    if (f == 0) continue;
    const auto at = static_cast<std::size_t>(3 * f);
    fastest = std::max(fastest, clip.rotations[at + kUpper].angularDistance(clip.rotations[at - 3 + kUpper]));
    const auto& given = c.clips.front().rotations;
    fastest_before = std::max(fastest_before, given[at + kFore].angularDistance(given[at - 3 + kFore]));
  }
  EXPECT_GT(fastest, 0);
  EXPECT_LT(fastest, fastest_before);  // it moves no faster than the forearm that it makes way for
}

TEST(ArmClearance, LeavesClipsThatTouchNothingToTheBit) {
  const app::Character c = bender(0.3);
  app::Clip clip = c.clips.front();
  EXPECT_EQ(app::clearArms(c, clip), "");
  for (std::size_t i = 0; i < clip.rotations.size(); ++i)
    EXPECT_EQ(clip.rotations[i].coeffs(), c.clips.front().rotations[i].coeffs());
}

TEST(ArmClearance, LeavesLoosePartsAlone) {
  app::Character c = bender(1.7);
  c.skeleton.joints[kFore].parent = -1;
  app::Clip clip = c.clips.front();
  EXPECT_EQ(app::clearArms(c, clip), "");
  for (int f = 0; f < kFrames; ++f) EXPECT_EQ(turned(clip, c.clips.front(), f, kUpper), 0);
}

// Of every capture at hand: some lead a forearm 65 to 124 mm in.
TEST(ArmClearance, HoldsTheArmsOfCapturesOutsideTheTrunk) {
  const fs::path folder = fs::path(HAIRMESH_SOURCE_DIR) / ".." / "shared" / "mocap";
  if (!fs::exists(folder)) GTEST_SKIP() << folder << " is absent";
  int looked = 0, cleared = 0;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() != ".bvh") continue;
    const app::Character c = app::loadCharacter(entry.path().string());
    EXPECT_LT(depthInTrunk(c, c.clips.front()), 0.015) << entry.path();
    for (const std::string& note : c.notes) cleared += note.starts_with("arms: ");
    ++looked;
  }
  EXPECT_GT(looked, 4);
  EXPECT_GT(cleared, 2);
}

}  // namespace arm_clearance_test
