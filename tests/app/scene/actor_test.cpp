// What the simulator is handed of a figure's motion, against forward kinematics worked out here from the clip's
// numbers.
#include "app/scene/actor.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <string>

#include "app/files/data_path.h"
#include "app/scene/sim_to_render.h"
#include "app/scene/view/debug_views.h"
#include "tests/run_program.h"

namespace actor_test {

using app::Rigid;
using app::Vec3;

constexpr int kFrames = 60;
constexpr double kFrame = 1.0 / 60;            // s
constexpr double kDegree = M_PI / 180;         // rad
constexpr double kCentimetre = 0.01;           // m
const Vec3 kSpine(0, 40, 0), kHead(0, 20, 0);  // cm, offsets from the joint above

// The clip's numbers at a frame: centimetres and degrees.
struct Angles {
  Vec3 hips;
  double turn;            // of the hips about y
  double bend;            // of the spine about z
  double nod, yaw, tilt;  // of the head about x, then y, then z
};
Angles anglesAt(int frame) {
  const double t = frame / double(kFrames);
  return {Vec3(40 * t, 95, 60 * t + 10 * t * t),
          25 * t,
          8 * std::sin(5 * t),
          20 * std::sin(7 * t),
          30 * std::sin(6 * t),
          9 * std::sin(8 * t)};
}

Eigen::AngleAxisd about(const Vec3& axis, double degrees) {
  return Eigen::AngleAxisd(degrees * kDegree, axis);
}

// Head joint to world: joints turn about their own axes in the order of their channels.
Rigid headAt(int frame) {
  const Angles a = anglesAt(frame);
  const Vec3 x = Vec3::UnitX(), y = Vec3::UnitY(), z = Vec3::UnitZ();
  return Rigid(Eigen::Translation3d(kCentimetre * a.hips)) * about(y, a.turn) *
         Eigen::Translation3d(kCentimetre * kSpine) * about(z, a.bend) * Eigen::Translation3d(kCentimetre * kHead) *
         about(x, a.nod) * about(y, a.yaw) * about(z, a.tilt);
}

std::string clipText() {
  std::string text =
      "HIERARCHY\nROOT Hips {\nOFFSET 0 95 0\nCHANNELS 6 Xposition Yposition Zposition Yrotation Xrotation Zrotation\n"
      "JOINT Spine {\nOFFSET 0 40 0\nCHANNELS 3 Xrotation Yrotation Zrotation\nJOINT Head {\nOFFSET 0 20 0\n"
      "CHANNELS 3 Xrotation Yrotation Zrotation\nEnd Site {\nOFFSET 0 20 0\n}\n}\n}\n"
      "JOINT LeftLeg {\nOFFSET 10 -5 0\nCHANNELS 3 Xrotation Yrotation Zrotation\nEnd Site {\nOFFSET 0 -90 0\n}\n}\n"
      "JOINT RightLeg {\nOFFSET -10 -5 0\nCHANNELS 3 Xrotation Yrotation Zrotation\nEnd Site {\nOFFSET 0 -90 0\n}\n}\n"
      "}\nMOTION\nFrames: 60\nFrame Time: 0.0166666667\n";
  for (int f = 0; f < kFrames; ++f) {
    const Angles a = anglesAt(f);
    char line[240];
    std::snprintf(line, sizeof line, "%.6f %.6f %.6f %.6f 0 0  0 0 %.6f  %.6f %.6f %.6f  0 0 0  0 0 0\n", a.hips.x(),
                  a.hips.y(), a.hips.z(), a.turn, a.bend, a.nod, a.yaw, a.tilt);
    text += line;
  }
  return text;
}

app::Actor actorOf(const Vec3& position, double heading, app::AssetCache& asset_cache) {
  const std::string file = test::freshFolder("actor_clip") + "/nod.bvh";
  std::ofstream(file) << clipText();
  app::CharacterSpec spec;
  spec.motion = file;
  spec.position = position;
  spec.heading = heading;
  spec.loop = app::LoopKind::kNone;  // the clip's own numbers
  spec.style = app::Style::kShort;
  spec.resolution = app::Resolution::kLow;
  return app::makeActor(spec, {}, asset_cache);
}

double farthest(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  double most = a.size() == b.size() ? 0 : INFINITY;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) most = std::max(most, (a[i] - b[i]).norm());
  return most;
}

std::vector<Vec3> moved(const Rigid& by, const std::vector<Vec3>& points) {
  std::vector<Vec3> out;
  for (const Vec3& p : points) out.push_back(by * p);
  return out;
}

std::vector<Vec3> rootsOfHair(const app::Actor& actor) {
  std::vector<Vec3> roots;
  const sim::HairMesh& mesh = actor.haircut->mesh;
  for (int c = 0; c < mesh.columnCount(); ++c) roots.push_back(actor.hair.positions[mesh.shape.column_first[c]]);
  return roots;
}

// m, that rounding the clip's numbers to a millionth of a degree and of a centimetre may come to.
constexpr double kRounding = 1e-6;

TEST(Actor, RootsAndHeadAreWhereTheClipHasThemAtTheStepsEnd) {
  const Vec3 position(2, 0, -1);
  const double heading = 0.7;
  app::AssetCache asset_cache;
  app::Actor actor = actorOf(position, heading, asset_cache);
  const Rigid place = Eigen::Translation3d(position) * Eigen::AngleAxisd(heading, Vec3::UnitY());
  // What is fixed to the head, as it stood before the first step.
  const Rigid first = place * headAt(0);
  const std::vector<Vec3> roots = actor.roots;
  std::size_t head = 0;
  while (actor.body->character.ellipsoids[head].joint != actor.body->character.head_joint) ++head;
  const Vec3 middle = actor.ellipsoids[head].center;
  ASSERT_GT(roots.size(), 10u);
  double travelled = 0;
  for (int frame = 1; frame <= 40; ++frame) {
    app::stepActor({}, kFrame, frame * kFrame, actor);
    const Rigid by = place * headAt(frame) * first.inverse(), before = place * headAt(frame - 1) * first.inverse();
    EXPECT_LT(farthest(actor.roots, moved(by, roots)), kRounding) << "frame " << frame;
    EXPECT_LT(farthest(rootsOfHair(actor), moved(by, roots)), kRounding) << "frame " << frame;
    // And the body that the hair meets: where it is, and how it came there.
    const sim::Ellipsoid& ball = actor.ellipsoids[head];
    EXPECT_LT((ball.center - by * middle).norm(), kRounding) << "frame " << frame;
    EXPECT_LT((sim::carriedAlong(ball, before * middle, kFrame) - by * middle).norm(), kRounding) << "frame " << frame;
    const double way = (by * roots[0] - before * roots[0]).norm();
    EXPECT_GT(way, 100 * kRounding) << "the step before is elsewhere";
    travelled += way;
  }
  EXPECT_GT(travelled, 0.3);
}

TEST(Actor, RootsOfTheCoarseMeshAreThoseOfTheHead) {
  app::AssetCache asset_cache;
  app::Actor actor = actorOf(Vec3::Zero(), 0, asset_cache);
  const app::HaircutPair* pair = app::coarsePair(actor, app::Resolution::kMinimal, asset_cache);
  ASSERT_NE(pair, nullptr);
  app::enterCoarse(*pair, actor);
  const std::vector<Vec3> roots = actor.coarse.roots, fine = actor.roots;
  for (int frame = 1; frame <= 10; ++frame) {
    app::stepActor({}, kFrame, frame * kFrame, actor);
    const Rigid by = headAt(frame) * headAt(0).inverse();
    EXPECT_LT(farthest(actor.coarse.roots, moved(by, roots)), kRounding) << "frame " << frame;
    EXPECT_LT(farthest(rootsOfHair(actor), moved(by, fine)), kRounding) << "frame " << frame;
  }
}

// A joint that moves alone is a new pose, whichever it is.
TEST(JointMatrices, TellAMoveOfAnyJoint) {
  app::Skeleton skeleton;
  app::Pose pose;
  for (int j = 0; j < 4; ++j) {
    skeleton.joints.push_back({"joint", j - 1, Rigid::Identity(), Rigid(Eigen::Translation3d(0, j, 0))});
    pose.world.push_back(skeleton.joints.back().rest_world);
  }
  std::vector<render::Mat4> matrices;
  EXPECT_TRUE(app::jointMatrices(skeleton, pose, Vec3::Zero(), matrices));
  EXPECT_FALSE(app::jointMatrices(skeleton, pose, Vec3::Zero(), matrices));
  for (Rigid& joint : pose.world) {
    joint.translation().x() += 0.1;
    EXPECT_TRUE(app::jointMatrices(skeleton, pose, Vec3::Zero(), matrices));
    EXPECT_FALSE(app::jointMatrices(skeleton, pose, Vec3::Zero(), matrices));
  }
}

// As the view's help says: red where the hair sticks.
TEST(DebugViews, AContactThatSticksIsRedAndOneThatSlidesIsNot) {
  app::AssetCache cache;
  app::CharacterSpec spec;
  spec.motion = app::dataPath("assets/clips/walk.bvh");
  app::Actor actor = app::makeActor(spec, {}, cache);
  app::showActor(1, Vec3::Zero(), actor);
  for (const bool sticks : {false, true}) {
    actor.hair.contacts = {{.vertex = 5, .sticks = sticks}};
    app::DebugGeometry geometry;
    app::addDebugViews({.contacts = true}, actor, geometry);
    ASSERT_EQ(geometry.points.size(), 1u);
    const auto& color = geometry.points[0].color;
    EXPECT_EQ(color[0] > color[1] && color[0] > color[2], sticks);
  }
}

}  // namespace actor_test
