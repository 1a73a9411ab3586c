// The readers of motion: BVH as it is found in the wild, and ARCSim's .mot.
#include "app/motion/motion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <random>
#include <sstream>

#include "app/files/errors.h"
#include "app/files/text_file.h"

namespace motion_test {

using app::BvhMotion;
using app::InputError;
using app::Pose;
using app::Vec3;
namespace fs = std::filesystem;

const fs::path kSource = HAIRMESH_SOURCE_DIR;
const fs::path kShared = kSource / ".." / "shared";

BvhMotion load(const fs::path& file) {
  return app::readBvh(app::readText(file.string()), file.string());
}

Pose poseOf(const BvhMotion& motion, double time) {
  Pose pose;
  app::samplePose(motion.skeleton, motion.clip, time, pose);
  return pose;
}

// Height between the outermost joints and end sites of a pose.
double heightOf(const BvhMotion& motion, const Pose& pose) {
  double low = HUGE_VAL, high = -HUGE_VAL;
  for (std::size_t j = 0; j < pose.world.size(); ++j) {
    for (const Vec3& p : {Vec3(Vec3::Zero()), motion.end_sites[j]}) {
      const double y = (pose.world[j] * p).y();
      low = std::min(low, y), high = std::max(high, y);
    }
  }
  return high - low;
}

// A figure of 170 units: hips at 95, a head 60 above with an end site of 15, a foot 95 below. `rows` are motion lines.
std::string figure(const std::string& channels, const std::vector<std::string>& rows, double scale = 1) {
  const auto number = [&](double value) { return std::to_string(value * scale); };
  std::ostringstream text;
  text << "HIERARCHY\nROOT Hips\n{\n OFFSET 0 " << number(95) << " 0\n CHANNELS 6 Xposition Yposition Zposition "
       << channels << "\n JOINT Head\n {\n  OFFSET 0 " << number(60) << " 0\n  CHANNELS 3 " << channels
       << "\n  End Site\n  {\n   OFFSET 0 " << number(15) << " 0\n  }\n }\n JOINT Foot\n {\n  OFFSET 0 " << number(-95)
       << " 0\n  CHANNELS 3 " << channels << "\n  End Site\n  {\n   OFFSET 0 0 " << number(15) << "\n  }\n }\n}\n"
       << "MOTION\nFrames: " << rows.size() << "\nFrame Time: 0.02\n";
  for (const std::string& row : rows) text << row << "\n";
  return text.str();
}
const std::string kStill = "0 95 0 0 0 0 0 0 0 0 0 0";
const std::string kZxy = "Zrotation Xrotation Yrotation";

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size())) {
    text.replace(at, from.size(), to);
  }
  return text;
}

std::string faultOf(const std::string& text) {
  try {
    app::readBvh(text, "clip.bvh");
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(Bvh, MotionCaptureClipsAreReadWhole) {
  if (!fs::exists(kShared / "mocap")) GTEST_SKIP() << "no ../shared/mocap beside the checkout";
  struct Expected {
    const char* file;
    std::size_t joints;
    int frames;
  };
  // salsa17 opens with a T pose that is no part of the motion: 360 of its 361 frames remain.
  for (const Expected& expected :
       {Expected{"cmu_02_01_walk.bvh", 31, 172}, Expected{"cmu_02_03_run.bvh", 31, 87},
        Expected{"cmu_02_04_jump.bvh", 31, 242}, Expected{"cmu_salsa17_spins_clean.bvh", 43, 360},
        Expected{"deepmimic_backflip.bvh", 15, 106}, Expected{"deepmimic_cartwheel.bvh", 15, 163}}) {
    SCOPED_TRACE(expected.file);
    const BvhMotion motion = load(kShared / "mocap" / expected.file);
    EXPECT_EQ(motion.skeleton.joints.size(), expected.joints);
    EXPECT_EQ(motion.clip.frameCount(), expected.frames);
    EXPECT_NEAR(motion.clip.frame_time, 1.0 / 60, 1e-6);
    const double height = heightOf(motion, app::restPose(motion.skeleton));
    EXPECT_GT(height, 1.3);
    EXPECT_LT(height, 2.1);
    EXPECT_NE(motion.notes.at(0).find("cm"), std::string::npos) << motion.notes[0];
    for (int f = 0; f < motion.clip.frameCount(); ++f) {
      for (const app::Rigid& joint : poseOf(motion, f * motion.clip.frame_time).world) {
        ASSERT_TRUE(joint.matrix().allFinite());
        ASSERT_GT(joint.translation().y(), -0.15) << "frame " << f;  // the ground is y = 0 in all of them
        ASSERT_LT(joint.translation().y(), 3.0);
      }
    }
  }
}

TEST(Bvh, DebianTestModelsAreRead) {
  const fs::path folder = "/usr/share/assimp/models/BVH";
  if (!fs::exists(folder)) GTEST_SKIP() << "package assimp-testmodels is not installed";
  const BvhMotion walk = load(folder / "01_01.bvh"), boxing = load(folder / "Boxing_Toes.bvh");
  EXPECT_EQ(walk.clip.frameCount(), 2751);  // 2,752 with the T pose before them
  EXPECT_NEAR(1 / walk.clip.frame_time, 120, 0.01);
  EXPECT_NEAR(heightOf(walk, app::restPose(walk.skeleton)), 1.47, 0.03) << "the CMU unit, an inch over 0.45";
  EXPECT_EQ(boxing.clip.frameCount(), 3069);  // the file holds one row more
  EXPECT_NEAR(1 / boxing.clip.frame_time, 100, 0.01);
  EXPECT_NEAR(heightOf(boxing, app::restPose(boxing.skeleton)), 1.73, 0.03);
  EXPECT_EQ(load(folder / "01_03.bvh").clip.frameCount(), 4510);
}

TEST(Bvh, RightAnglesPutTheHeadWhereTheyShould) {
  struct Case {
    const char* angles;  // Z X Y of the hips
    Vec3 head;           // m, from the hips
  };
  for (const Case& c : {Case{"90 0 0", {-0.6, 0, 0}}, Case{"0 90 0", {0, 0, 0.6}}, Case{"0 0 90", {0, 0.6, 0}},
                        Case{"90 90 0", {0, 0, 0.6}}, Case{"0 90 90", {0, 0, 0.6}}, Case{"90 0 90", {-0.6, 0, 0}}}) {
    const std::string row = std::string("10 20 30 ") + c.angles + " 0 0 0 0 0 0";
    const BvhMotion motion = app::readBvh(figure(kZxy, {kStill, row, kStill, kStill, kStill}), "clip");
    const Pose pose = poseOf(motion, 0.02);
    EXPECT_LT((pose.world[0].translation() - Vec3(0.1, 0.2, 0.3)).norm(), 1e-12) << c.angles;
    EXPECT_LT((pose.world[1].translation() - Vec3(0.1, 0.2, 0.3) - c.head).norm(), 1e-12) << c.angles;
  }
}

TEST(Bvh, EveryChannelOrderMatchesTheMatrixProduct) {
  std::string order = "XYZ";
  const double angle[3] = {33, -71, 128};  // degrees about x, y, z
  do {
    std::string channels, row = "0 95 0";
    Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
    for (const char axis : order) {
      channels += std::string(1, axis) + "rotation ";
      row.append(" ").append(std::to_string(angle[axis - 'X']));
      turn = turn * Eigen::AngleAxisd(angle[axis - 'X'] * M_PI / 180, Vec3::Unit(axis - 'X')).toRotationMatrix();
    }
    row += row.substr(6) + " 0 0 0";
    const BvhMotion motion = app::readBvh(figure(channels, {kStill, row, kStill, kStill, kStill}), "clip");
    const Pose pose = poseOf(motion, 0.02);
    EXPECT_LT((pose.world[0].linear() - turn).norm(), 1e-6) << order;
    EXPECT_LT((pose.world[1].linear() - turn * turn).norm(), 1e-6) << order;
    EXPECT_LT((pose.world[1].translation() - Vec3(0, 0.95, 0) - turn * Vec3(0, 0.6, 0)).norm(), 1e-6) << order;
  } while (std::next_permutation(order.begin(), order.end()));
}

TEST(Bvh, PositionChannelsReplaceOffsetsUnlessTheyAreZeroThroughout) {
  const std::string six = "CHANNELS 6 Xposition Yposition Zposition " + kZxy;
  const std::string text = replaced(figure(kZxy, {}), "Frames: 0", "Frames: 2");
  const std::string all_six = replaced(text, "CHANNELS 3 " + kZxy, six);
  const auto headAt = [&](const std::string& head) {
    const std::string row = "0 95 0 0 0 0 " + head + " 0 0 0 0 -95 0 0 0 0\n";
    const BvhMotion motion = app::readBvh(all_six + row + row, "clip");
    return Vec3(poseOf(motion, 0).world[1].translation());
  };
  EXPECT_LT((headAt("1 70 2") - Vec3(0.01, 1.65, 0.02)).norm(), 1e-12);
  EXPECT_LT((headAt("0 0 0") - Vec3(0, 1.55, 0)).norm(), 1e-12);
  // Only one axis given: the others keep their offset.
  const std::string one =
      replaced(text, "CHANNELS 3 " + kZxy, "CHANNELS 1 Xposition") + "0 95 0 0 0 0 5 0\n0 95 0 0 0 0 5 0";
  EXPECT_LT((poseOf(app::readBvh(one, "clip"), 0).world[1].translation() - Vec3(0.05, 1.55, 0)).norm(), 1e-12);
}

TEST(Bvh, WaysOfWritingMakeNoDifference) {
  const std::string turned = "1 94 2 10 20 30 4 5 6 7 8 9";
  const std::string text = figure(kZxy, {kStill, turned, kStill});
  const BvhMotion plain = app::readBvh(text, "clip");
  const std::vector<std::string> variants = {
      replaced(text, "\n", "\r\n"),
      replaced(text, "\n", "\r"),
      replaced(text, " ", "\t"),
      replaced(text, "End Site", "end site"),
      replaced(text, "End Site\n  {", "END SITE {"),
      replaced(text, "Head", "Head and neck (skull)"),
      replaced(text, "\n{", " {"),
      replaced(text, "Frames: ", "Frames:"),
      replaced(text, "Frame Time: ", "Frame Time :"),
      replaced(text, "HIERARCHY", "hierarchy"),
      replaced(text, "Xrotation", "XROTATION"),
      replaced(text, "\n", "\n\n"),
      replaced(text, "{", "{\t\t"),
      replaced(text, "0.02", "+2e-2"),
      "\xEF\xBB\xBF" + text,
      text.substr(0, text.size() - 1),
      text + " \n\n\t",
  };
  for (const std::string& variant : variants) {
    SCOPED_TRACE(variant);
    const BvhMotion motion = app::readBvh(variant, "clip");
    ASSERT_EQ(motion.clip.rotations.size(), plain.clip.rotations.size());
    EXPECT_DOUBLE_EQ(motion.clip.frame_time, 0.02);
    EXPECT_TRUE(motion.has_end_site[1]);
    for (std::size_t i = 0; i < plain.clip.rotations.size(); ++i) {
      EXPECT_EQ(motion.clip.rotations[i].coeffs(), plain.clip.rotations[i].coeffs());
      EXPECT_EQ(motion.clip.translations[i], plain.clip.translations[i]);
    }
  }
  EXPECT_EQ(app::readBvh(variants[5], "clip").skeleton.joints[1].name, "Head and neck (skull)");
}

TEST(Bvh, AnyUnitGivesAPersonsHeight) {
  struct Case {
    double units_per_metre;
    const char* said;
  };
  for (const Case& c : {Case{1, "unit: m "}, Case{1000, "mm"}, Case{100, "cm"}, Case{1 / 0.0254, "inch"},
                        Case{0.45 / 0.0254, "CMU"}, Case{7, "unknown"}, Case{4e5, "unknown"}, Case{1e-4, "unknown"}}) {
    SCOPED_TRACE(c.said);
    const double scale = c.units_per_metre / 100;
    const std::string row = "0 " + std::to_string(95 * scale) + " 0 0 0 0 0 0 0 0 0 0";
    const BvhMotion motion = app::readBvh(figure(kZxy, {row, row}, scale), "clip");
    EXPECT_NEAR(heightOf(motion, app::restPose(motion.skeleton)), 1.7, 0.02);
    EXPECT_NEAR(heightOf(motion, poseOf(motion, 0)), 1.7, 0.02);
    EXPECT_NE(motion.notes.at(0).find(c.said), std::string::npos) << motion.notes[0];
  }
}

// The same figure written z up: (x, y, z) becomes (x, -z, y), turns about y become turns about z.
const char* const kZUpFigure =
    "HIERARCHY\nROOT Hips {\nOFFSET 0 0 95\nCHANNELS 6 Xposition Yposition Zposition Yrotation Zrotation Xrotation\n"
    "JOINT Head {\nOFFSET 0 0 60\nCHANNELS 3 Yrotation Zrotation Xrotation\nEnd Site {\nOFFSET 0 0 15\n}\n}\n"
    "JOINT Foot {\nOFFSET 0 0 -95\nCHANNELS 3 Yrotation Zrotation Xrotation\nEnd Site {\nOFFSET 0 -15 0\n}\n}\n}\n"
    "MOTION\nFrames: 2\nFrame Time: 0.02\n";

TEST(Bvh, ZUpBecomesYUp) {
  const BvhMotion y_up = app::readBvh(
      figure("Zrotation Yrotation Xrotation", {"1 94 2 10 20 30 4 5 6 7 8 9", "2 94 1 11 21 31 4 5 6 7 8 9"}), "clip");
  const BvhMotion z_up = app::readBvh(
      kZUpFigure + std::string("1 -2 94 -10 20 30 -4 5 6 -7 8 9\n2 -1 94 -11 21 31 -4 5 6 -7 8 9\n"), "clip");
  for (const double time : {0.0, 0.02}) {
    const Pose a = poseOf(y_up, time), b = poseOf(z_up, time);
    for (std::size_t j = 0; j < 3; ++j) EXPECT_TRUE(a.world[j].isApprox(b.world[j], 1e-9)) << j;
  }
  for (std::size_t j = 0; j < 3; ++j) {
    EXPECT_TRUE(y_up.skeleton.joints[j].rest_world.isApprox(z_up.skeleton.joints[j].rest_world, 1e-9));
    EXPECT_LT((y_up.end_sites[j] - z_up.end_sites[j]).norm(), 1e-9);
  }
  // Rest pose y up, motion z up (the root's channels turn it): the rest pose stands, and so does the motion.
  const std::string mixed =
      figure("Xrotation Yrotation Zrotation", {"0 0 95 90 0 0 0 0 0 0 0 0", "0 0 95 90 0 0 0 0 0 0 0 0"});
  const BvhMotion motion = app::readBvh(mixed, "clip");
  EXPECT_NEAR(app::restPose(motion.skeleton).world[1].translation().y(), 1.55, 1e-9);
  EXPECT_LT((poseOf(motion, 0).world[1].translation() - Vec3(0, 1.55, 0)).norm(), 1e-9);
}

TEST(Bvh, AFigureLyingDownIsNotTakenForZUp) {
  const std::string row = "0 15 40 90 0 0 0 0 0 0 0 0";
  const BvhMotion motion = app::readBvh(figure("Xrotation Yrotation Zrotation", {row, row, row}), "clip");
  EXPECT_NEAR(poseOf(motion, 0).world[1].translation().y(), 0.15, 1e-9);
}

TEST(Bvh, OffsetsThatDoNotStandTakeAFrameAsRestPose) {
  // Bones along x in the file, turned upright by the root's rotation about z.
  std::string text = figure(kZxy, {"0 95 0 90 0 0 0 0 0 0 0 0", "0 95 0 90 0 0 0 5 0 0 0 0"});
  text = replaced(replaced(text, "OFFSET 0 60.000000 0", "OFFSET 60 0 0"), "OFFSET 0 -95.000000 0", "OFFSET -95 0 0");
  text = replaced(text, "OFFSET 0 15.000000 0", "OFFSET 15 0 0");
  const BvhMotion motion = app::readBvh(text, "clip");
  const Pose rest = app::restPose(motion.skeleton), first = poseOf(motion, 0);
  EXPECT_NEAR(heightOf(motion, rest), 1.7, 1e-6);
  for (std::size_t j = 0; j < 3; ++j) {
    EXPECT_TRUE(rest.world[j].linear().isIdentity(1e-9));
    EXPECT_LT((rest.world[j].translation() - first.world[j].translation()).norm(), 1e-9);
  }
}

TEST(Bvh, ARestPoseBeforeTheMotionIsLeftOut) {
  std::vector<std::string> rows = {"0 95 0 0 80 0 0 0 0 0 0 0"};
  for (int f = 0; f < 8; ++f) rows.push_back("0 95 0 0 " + std::to_string(2 * f) + " 0 0 0 0 0 0 0");
  const BvhMotion apart = app::readBvh(figure(kZxy, rows), "clip");
  EXPECT_EQ(apart.clip.frameCount(), 8);
  EXPECT_TRUE(poseOf(apart, 0).world[0].linear().isIdentity(1e-9));
  rows.erase(rows.begin());
  EXPECT_EQ(app::readBvh(figure(kZxy, rows), "clip").clip.frameCount(), 8) << "an even motion keeps its first frame";
}

TEST(Bvh, ARestPoseThatSwingsIntoTheMotionIsLeftOutWithTheSwing) {
  std::vector<std::string> rows;
  for (const double turn : {80.0, 30.0, 12.0, 5.0})
    rows.push_back("0 95 0 0 " + std::to_string(turn) + " 0 0 0 0 0 0 0");
  for (int f = 0; f < 36; ++f) rows.push_back("0 95 0 0 " + std::to_string(2 * f) + " 0 0 0 0 0 0 0");
  const BvhMotion motion = app::readBvh(replaced(figure(kZxy, rows), "Frame Time: 0.02", "Frame Time: 0.01"), "clip");
  EXPECT_EQ(motion.clip.frameCount(), 30) << "of 40 frames, without a tenth of a second";
}

TEST(Bvh, TheSameFrameTwiceIsAStillClip) {
  const BvhMotion motion = app::readBvh(figure(kZxy, {kStill, kStill}), "clip");
  EXPECT_EQ(motion.clip.frameCount(), 2);
  EXPECT_GT(motion.clip.duration(), 0);
  EXPECT_TRUE(poseOf(motion, 0).world[1].isApprox(poseOf(motion, 5).world[1], 0));
}

TEST(Bvh, ASingleFrameIsAStillClip) {
  const BvhMotion motion = app::readBvh(figure(kZxy, {kStill}), "clip");
  EXPECT_EQ(motion.clip.frameCount(), 1);
  EXPECT_GT(motion.clip.duration(), 0);
  EXPECT_THROW(app::readBvh(figure(kZxy, {}), "clip"), app::InputError);
}

// What is put in place of what, and the line that the message must name.
struct BvhFault {
  std::string from, to;
  int line;
};
const std::vector<BvhFault> kBvhFaults = {
    {"HIERARCHY", "MESH", 1},
    {"ROOT Hips", "Hips", 2},
    {"OFFSET 0 60.000000 0", "OFFSET 0 nan 0", 8},
    {"OFFSET 0 60.000000 0", "OFFSET 0 -inf 0", 8},
    {"OFFSET 0 60.000000 0", "OFFSET 0 1e30 0", 8},
    {"OFFSET 0 60.000000 0", "OFFSET 0 1e999 0", 8},
    {"OFFSET 0 60.000000 0", "OFFSET 0 60", 9},
    {"OFFSET 0 60.000000 0", "OFFSET 0 6,0 0", 8},
    {"OFFSET 0 60.000000 0", "OFFSET 0 0x10 0", 8},
    {"CHANNELS 6", "CHANNELS 7", 5},
    {"CHANNELS 6", "CHANNELS -1", 5},
    {"CHANNELS 6", "CHANNELS 5", 5},
    {"CHANNELS 6", "CHANNELS 99999999999999999999", 5},
    {"Xposition", "Wposition", 5},
    {"JOINT Head", "BONE Head", 6},
    {"   OFFSET 0 15.000000 0", "   SIZE 15", 12},
    {"}\nMOTION", "}\n}\nMOTION", 25},
    {"}\nMOTION", "\nMOTION", 25},
    {"}\nMOTION", "}\nROOT Second\n{\n}\nMOTION", 25},
    {"Frames: 2", "Frames: 0", 26},
    {"Frames: 2", "Frames: -3", 26},
    {"Frames: 2", "Frames: 2.5", 26},
    {"Frames: 2", "Frames: 3", 30},
    {"Frames: 2", "Frames: 9999999", 26},
    {"Frames: 2", "Frames: 999999999999999999999999", 26},
    {"Frames: 2", "2", 26},
    {"Frame Time: 0.02", "Frame Time: 0", 27},
    {"Frame Time: 0.02", "Frame Time: -0.02", 27},
    {"Frame Time: 0.02", "Frame Time: 1e-30", 27},
    {"Frame Time: 0.02", "Frame Time: nan", 27},
    {"Frame Time: 0.02", "Frame Time: soon", 27},
    {"Frame Time: 0.02", "0.02", 27},
    {kStill + "\n" + kStill, kStill + "\n0 95 0", 29},
    {kStill + "\n" + kStill, kStill + " 1\n" + kStill, 28},
    {kStill + "\n" + kStill, kStill + "\n0 95 0 0 0 0 0 0 x 0 0 0", 29},
    {kStill + "\n" + kStill, kStill + "\n0 95 0 0 0 0 0 0 1e30 0 0 0", 29},
    {kStill + "\n" + kStill, kStill + "\n0 1e9 0 0 0 0 0 0 0 0 0 0", 29},
    {kStill + "\n" + kStill, kStill + "\n" + kStill + "\n" + kStill + "\n" + kStill, 31},
    {kStill + "\n" + kStill, kStill + "\n" + kStill + "\nthe end", 30},
};

TEST(Bvh, EveryFaultNamesItsLine) {
  const std::string good = figure(kZxy, {kStill, kStill});
  ASSERT_EQ(faultOf(good), "");
  for (const BvhFault& c : kBvhFaults) {
    const std::string text = replaced(good, c.from, c.to);
    ASSERT_NE(text, good) << c.from;
    const std::string wanted = "clip.bvh: line " + std::to_string(c.line) + ": ", said = faultOf(text);
    EXPECT_EQ(said.substr(0, wanted.size()), wanted) << c.from << " -> " << c.to << "\n  says: " << said;
    EXPECT_NE(said.find("; "), std::string::npos) << "no mend: " << said;
  }
  for (const std::string text :
       {"", " \n\n", "HIERARCHY", "\x89PNG\r\n", "HIERARCHY ROOT a { } MOTION Frames: 1 Frame Time: 1"}) {
    EXPECT_NE(faultOf(text), "") << text;
  }
  const std::string flat = replaced(replaced(replaced(good, "60.000000", "0"), "95.000000", "0"), "15.000000", "0");
  EXPECT_NE(faultOf(replaced(flat, "95", "0")).find("no height"), std::string::npos);
}

TEST(Bvh, EveryTruncationIsRefused) {
  const std::string text = figure(kZxy, {kStill, "1 95 0 0 5 0 0 0 0 0 0 10"});
  // The last number may lose digits and the newline after it; anything shorter is a fault.
  for (std::size_t length = 0; length + 2 < text.size(); ++length) {
    EXPECT_NE(faultOf(text.substr(0, length)), "") << "first " << length << " characters";
  }
}

TEST(Bvh, DamagedTextIsReadFiniteOrRefused) {
  std::mt19937 random(7);
  const std::string text = figure(kZxy, {kStill, "1 95 0 10 5 3 20 0 0 30 0 10", kStill, kStill});
  for (int round = 0; round < 4000; ++round) {
    std::string damaged = text;
    for (int k = 0; k < 3; ++k) {
      const std::size_t at = random() % damaged.size();
      if (random() % 3 == 0) {
        damaged.erase(at, random() % 9);
      } else {
        damaged[at] = "0123456789-+.eE{} \nXx\0\xFF"[random() % 23];
      }
    }
    try {
      const BvhMotion motion = app::readBvh(damaged, "clip");
      for (const app::Rigid& joint : poseOf(motion, 0.02).world) ASSERT_TRUE(joint.matrix().allFinite()) << damaged;
    } catch (const InputError&) {
    }
  }
}

TEST(Bvh, NestingIsDeepButBounded) {
  const auto nested = [](int joints) {
    std::string text = "HIERARCHY\nROOT j {\nOFFSET 0 0 0\nCHANNELS 3 Zrotation Xrotation Yrotation\n";
    for (int j = 1; j < joints; ++j) text += "JOINT j {\nOFFSET 0 0.01 0\n";
    text +=
        std::string(static_cast<std::size_t>(joints), '}') + "\nMOTION\nFrames: 2\nFrame Time: 0.01\n0 0 0\n0 0 0\n";
    return text;
  };
  EXPECT_EQ(app::readBvh(nested(4096), "deep").skeleton.joints.size(), 4096U);
  EXPECT_NE(faultOf(nested(4097)).find("4096 joints"), std::string::npos);
  EXPECT_NE(faultOf(nested(200000)).find("4096 joints"), std::string::npos);
}

TEST(Text, WhatIsNoFileIsRefused) {
  EXPECT_THROW(app::readText("/no/such/file.bvh"), InputError);
  EXPECT_THROW(app::readText(kSource.string()), InputError);
  EXPECT_THROW(app::readText("/dev/zero"), InputError);
  EXPECT_THROW(app::readText(""), InputError);
  EXPECT_THROW(app::readText((kSource / "CMakeLists.txt").string(), 10), InputError);
  EXPECT_EQ(app::readText((kSource / "CMakeLists.txt").string()).size(), fs::file_size(kSource / "CMakeLists.txt"));
}

TEST(Mot, ThePapersDanceIsReadWhole) {
  const fs::path file = kShared / "arcsim" / "dance.mot";
  if (!fs::exists(file)) GTEST_SKIP() << "no ../shared/arcsim beside the checkout";
  const app::RigidMotion motion = app::readMot(app::readText(file.string()), "dance.mot");
  EXPECT_EQ(motion.frame_count, 2111);
  EXPECT_EQ(motion.body_count, 16);
  EXPECT_DOUBLE_EQ(motion.frame_time, 1.0 / 30);
  ASSERT_EQ(motion.bodies.size(), 2111U * 16);
  // First row of the file: 'body[0] position' 0.0995214 0.0152536 1.56005, z up.
  EXPECT_LT((motion.bodies[0].translation() - Vec3(0.0995214, 1.56005, -0.0152536)).norm(), 1e-12);
  for (std::size_t i = 0; i < motion.bodies.size(); ++i) {
    const app::Rigid& body = motion.bodies[i];
    ASSERT_LT((body.linear() * body.linear().transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-9);
    ASSERT_GT(body.translation().y(), -0.1);
    ASSERT_LT(body.translation().y(), 2.2);
    if (i < 16) continue;
    // 30 frames a second, limbs below 50 rad/s: no jump in orientation.
    ASSERT_LT(Eigen::AngleAxisd(body.linear() * motion.bodies[i - 16].linear().transpose()).angle(), 50.0 / 30);
  }
}

TEST(Mot, EveryFaultNamesItsLine) {
  const std::string good = "NumFrames: 2\nbody[0] position\n0 0 1\n0 0 1.1\nbody[0] orientation\n1 0 0 0\n-2 0 0 0\n";
  const app::RigidMotion motion = app::readMot(good, "m");
  EXPECT_EQ(motion.body_count, 1);
  EXPECT_TRUE(motion.bodies[0].linear().isApprox(motion.bodies[1].linear(), 1e-12)) << "q and -2q are one rotation";
  EXPECT_LT((motion.bodies[1].translation() - Vec3(0, 1.1, 0)).norm(), 1e-12);
  EXPECT_LT((motion.bodies[0].linear() * Vec3::UnitZ() - Vec3::UnitY()).norm(), 1e-12) << "the file's up is y";

  struct Case {
    std::string from, to;
    int line;
  };
  for (const Case& c : std::vector<Case>{{"NumFrames: 2", "Frames: 2", 1},
                                         {"NumFrames: 2", "NumFrames: 0", 1},
                                         {"NumFrames: 2", "NumFrames: 1", 1},
                                         {"NumFrames: 2", "NumFrames: 3", 5},
                                         {"NumFrames: 2", "NumFrames: 5000000", 1},
                                         {"body[0] position", "body[-1] position", 2},
                                         {"body[0] position", "body[99999999999] position", 2},
                                         {"body[0] position", "body[4097] position", 2},
                                         {"body[0] position", "body[0] place", 2},
                                         {"body[0] orientation", "body[0] position", 5},
                                         {"body[0] orientation", "body[1] orientation", 8},
                                         {"0 0 1.1", "0 0", 4},
                                         {"0 0 1.1", "0 0 1 1", 4},
                                         {"0 0 1.1", "0 0 nan", 4},
                                         {"0 0 1.1", "0 0 1e30", 4},
                                         {"1 0 0 0", "0 0 0 0", 6},
                                         {"-2 0 0 0\n", "", 7}}) {
    const std::string text = replaced(good, c.from, c.to), wanted = "m: line " + std::to_string(c.line) + ": ";
    std::string said;
    try {
      app::readMot(text, "m");
    } catch (const InputError& error) {
      said = error.what();
    }
    EXPECT_EQ(said.substr(0, wanted.size()), wanted) << c.from << " -> " << c.to << "\n  says: " << said;
  }
  for (const char* text : {"", "NumFrames: 3", "\xFF\xFE", "NumFrames: 1\n"})
    EXPECT_THROW(app::readMot(text, "m"), InputError);
}

}  // namespace motion_test
