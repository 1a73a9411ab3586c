// Rounds of a clip as the hair and the camera see them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "app/files/data_path.h"
#include "app/scene/demo.h"
#include "app/scene/sim_to_render.h"
#include "tests/run_program.h"

namespace loop_test {

using app::Ask;
using app::Demo;
using app::LoopKind;
using app::Vec3;
namespace fs = std::filesystem;

constexpr double kFrame = 1.0 / 60;

app::CharacterSpec characterOf(const std::string& motion) {
  app::CharacterSpec spec;
  spec.motion = fs::exists(motion) ? motion : app::dataPath("assets/clips/" + motion);
  spec.style = app::Style::kShort;
  spec.resolution = app::Resolution::kLow;
  return spec;
}

Demo open(const app::CharacterSpec& spec, double speed = 1, const std::string& framing = "bust") {
  app::Scene scene;
  scene.characters.push_back(spec);
  scene.playback.settle = 0;
  scene.playback.speed = speed;
  scene.camera.framing = framing;
  return app::openScene(std::move(scene), 16.0 / 9);
}

// Ten seconds on two legs that a turn and a stride end elsewhere: 40 frames that rise, stride and turn.
std::string stridingBvh(double shift_cm = 0, int popped = -1) {
  std::string text =
      "HIERARCHY\nROOT Hips {\nOFFSET 0 95 0\nCHANNELS 6 Xposition Yposition Zposition Yrotation Xrotation Zrotation\n"
      "JOINT Spine {\nOFFSET 0 40 0\nCHANNELS 3 Xrotation Yrotation Zrotation\nJOINT Head {\nOFFSET 0 20 0\n"
      "CHANNELS 3 Xrotation Yrotation Zrotation\nEnd Site {\nOFFSET 0 20 0\n}\n}\n}\n"
      "JOINT LeftLeg {\nOFFSET 10 -5 0\nCHANNELS 3 Xrotation Yrotation Zrotation\nJOINT LeftFoot {\nOFFSET 0 -85 0\n"
      "CHANNELS 3 Xrotation Yrotation Zrotation\nEnd Site {\nOFFSET 0 -5 12\n}\n}\n}\n"
      "JOINT RightLeg {\nOFFSET -10 -5 0\nCHANNELS 3 Xrotation Yrotation Zrotation\nJOINT RightFoot {\nOFFSET 0 -85 0\n"
      "CHANNELS 3 Xrotation Yrotation Zrotation\nEnd Site {\nOFFSET 0 -5 12\n}\n}\n}\n}\n"
      "MOTION\nFrames: 60\nFrame Time: 0.0333333\n";
  for (int f = 0; f < 60; ++f) {
    const double t = f / 59.0, late = t < 0.5 ? 0 : std::pow(t - 0.5, 2) * 4;
    const double pop = f == popped ? 200 : 0;
    char line[200];
    std::snprintf(line, sizeof line, "%.4f 95 %.4f %.3f 0 0  %.3f 0 0  0 %.3f 0  %.3f 0 0 0 0 0  %.3f 0 0 0 0 0\n",
                  shift_cm + pop + 30 * late, 150 * late, 70 * late, 10 * std::sin(6 * t), 30 * std::sin(9 * t),
                  20 * std::sin(12 * t), -20 * std::sin(12 * t));
    text += line;
  }
  return text;
}

std::string writeClip(const std::string& name, const std::string& text) {
  const std::string file = test::freshFolder("loop_clips") + "/" + name;
  std::ofstream(file) << text;
  return file;
}

// The hair as the head sees it.
std::vector<Vec3> seenFromHead(const Demo& demo) {
  const app::Actor& actor = demo.actors[0];
  const app::Rigid world_to_head = app::scalpToWorld(actor.body->character, actor.pose).inverse();
  std::vector<Vec3> seen;
  for (const Vec3& p : actor.hair.positions) seen.push_back(world_to_head * p);
  return seen;
}

double farthest(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, (a[i] - b[i]).norm());
  return most;
}

Vec3 headOf(const Demo& demo) {
  const app::Actor& actor = demo.actors[0];
  return app::scalpToWorld(actor.body->character, actor.pose) * actor.body->character.scalp.center;
}

TEST(Rounds, GoingOnTheHeadNeverJumpsAndInPlaceTheHairSeesTheSame) {
  app::CharacterSpec spec = characterOf(writeClip("stride.bvh", stridingBvh()));
  spec.loop = LoopKind::kGoOn;
  Demo going = open(spec);
  spec.loop = LoopKind::kInPlace;
  Demo staying = open(spec);
  ASSERT_TRUE(staying.actors[0].playback.loop.cuts());
  ASSERT_FALSE(going.actors[0].playback.loop.cuts());
  double jump = 0, cut = 0, difference = 0;
  Vec3 before = headOf(going), stayed = headOf(staying);
  for (int frame = 0; frame < 300; ++frame) {  // two seams and a half round
    app::advanceFrame(going, kFrame, {});
    app::advanceFrame(staying, kFrame, {});
    jump = std::max(jump, (headOf(going) - before).norm());
    cut = std::max(cut, (headOf(staying) - stayed).norm());
    before = headOf(going), stayed = headOf(staying);
    difference = std::max(difference, farthest(seenFromHead(going), seenFromHead(staying)));
    EXPECT_FALSE(staying.actors[0].last_report.carried) << "the step itself saw no jump";
  }
  EXPECT_LT(jump, 0.15);
  EXPECT_GT(cut, 1) << "there was a seam";
  // The same steps in another direction, with a preconditioner made anew: contacts stick or slide by the last bit.
  EXPECT_LT(difference, 0.02) << "m";
  EXPECT_GT(Vec3(headOf(going).x(), 0, headOf(going).z()).norm(), 2);
}

TEST(Rounds, AScrubCarriesHairAndCameraAlong) {
  app::CharacterSpec spec = characterOf(writeClip("scrub.bvh", stridingBvh()));
  spec.loop = LoopKind::kGoOn;
  Demo demo = open(spec);
  for (int frame = 0; frame < 130; ++frame) app::advanceFrame(demo, kFrame, {});
  const app::GroundPlace place = demo.actors[0].playback.place;
  EXPECT_GT(std::hypot(place.x, place.z), 1) << "in the second round";
  const std::vector<Vec3> seen = seenFromHead(demo);
  const Vec3 head = headOf(demo), anchor = demo.camera.anchor;
  demo.requests.push_back({Ask::kCarryAlong, "", "", 1.9});
  app::advanceFrame(demo, 0, {});
  EXPECT_LT(farthest(seen, seenFromHead(demo)), 1e-9);
  EXPECT_GT((headOf(demo) - head).norm(), 0.5);
  EXPECT_LT((demo.camera.anchor - anchor - (headOf(demo) - head)).norm(), 0.1);
  EXPECT_EQ(demo.actors[0].playback.place.x, place.x) << "within the present round";
}

// Where the head is in the picture, in halves of it.
Eigen::Vector2d projectedHead(const Demo& demo) {
  const app::Camera& camera = demo.camera;
  const app::Actor& actor = demo.actors[0];
  const Vec3 head = app::scalpToWorld(actor.body->character, actor.shown_pose) * actor.body->character.scalp.center;
  const Vec3 back = app::viewBack(camera), right = Vec3::UnitY().cross(back).normalized(), up = back.cross(right);
  const Vec3 seen = head - camera.anchor - camera.target;
  const double half = std::tan(0.5 * camera.fov) * (camera.distance - seen.dot(back));
  return {seen.dot(right) / (half * demo.aspect), seen.dot(up) / half};
}

std::vector<std::string> motionsAtHand() {
  std::vector<std::string> motions{"walk.bvh", "jump_spin.bvh", "head_shake.bvh"};
  const fs::path captures = fs::path(HAIRMESH_SOURCE_DIR) / ".." / "shared" / "mocap";
  if (!fs::exists(captures)) return motions;
  const std::size_t own = motions.size();
  for (const auto& entry : fs::directory_iterator(captures)) {
    if (entry.path().extension() == ".bvh") motions.push_back(entry.path().string());
  }
  EXPECT_GT(motions.size(), own) << "no clips in " << captures;
  return motions;
}

TEST(CameraFollows, TheHeadStaysInTheMiddleHalfAtAnySpeed) {
  for (const std::string& motion : motionsAtHand()) {
    Demo demo = open(characterOf(motion));
    demo.scene.sim.collide = false;
    for (const LoopKind kind : {LoopKind::kGoOn, LoopKind::kInPlace, LoopKind::kNone}) {
      for (const double speed : {1.0, 4.0, 20.0}) {
        SCOPED_TRACE(motion + " " + std::string(app::loopName(kind)) + " at " + std::to_string(speed));
        // From two seconds before the seam, or all of the clip, to a second after it.
        const double lead = std::min(2.0, demo.actors[0].playedClip().duration() / speed);
        demo.actors[0].spec.clip_offset = demo.actors[0].playedClip().duration() - lead * speed;
        demo.requests.push_back({Ask::kLoop, std::string(app::loopName(kind)), ""});
        demo.requests.push_back({Ask::kSpeed, "", "", speed});
        demo.requests.push_back({Ask::kRestart, "", ""});
        for (int frame = 0; frame < 60 * (lead + 1); ++frame) {
          app::advanceFrame(demo, kFrame, {});
          const Eigen::Vector2d head = projectedHead(demo);
          ASSERT_LT(head.cwiseAbs().maxCoeff(), 0.5) << "frame " << frame << ": " << head.transpose();
        }
      }
    }
  }
}

// Corners of what is drawn, in halves of the picture.
Eigen::AlignedBox2d drawnBox(const Demo& demo) {
  const app::Camera& camera = demo.camera;
  const app::Actor& actor = demo.actors[0];
  const Vec3 back = app::viewBack(camera), right = Vec3::UnitY().cross(back).normalized(), up = back.cross(right);
  Eigen::AlignedBox2d box;
  const app::SkinnedMesh& mesh = actor.body->character.mesh;
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    Vec3 p = Vec3::Zero();
    for (std::size_t k = 0; k < 4; ++k) {
      const std::size_t j = mesh.joints[v][k];
      p += mesh.weights[v][k] * (actor.pose.world[j] * (actor.body->character.skeleton.joints[j].rest_world.inverse() *
                                                        mesh.positions[v].cast<double>()));
    }
    const Vec3 seen = p - camera.anchor - camera.target;
    const double half = std::tan(0.5 * camera.fov) * (camera.distance - seen.dot(back));
    box.extend(Eigen::Vector2d(seen.dot(right) / (half * demo.aspect), seen.dot(up) / half));
  }
  return box;
}

TEST(CameraFrames, FiguresOfAnyShapeFillThePicture) {
  std::vector<std::string> motions{"walk.bvh"};
  const fs::path robot = fs::path(HAIRMESH_SOURCE_DIR) / ".." / "shared" / "characters" / "robot.glb";
  if (fs::exists(robot)) motions.push_back(robot.string());
  for (const std::string& motion : motions) {
    const Demo demo = open(characterOf(motion), 1, "figure");
    const Eigen::AlignedBox2d box = drawnBox(demo);
    EXPECT_LE(box.min().cwiseAbs().maxCoeff(), 1) << motion;
    EXPECT_LE(box.max().cwiseAbs().maxCoeff(), 1) << motion;
    EXPECT_GT(box.sizes().y() / 2, 0.7) << motion << ": of the height";
    EXPECT_LT(std::abs(box.center().y()), 0.15) << motion;
  }
}

TEST(CameraFrames, AMotionLoadedWhilePausedIsFramedAtOnce) {
  app::CharacterSpec spec = characterOf("walk.bvh");
  Demo demo = open(spec, 1, "figure");
  demo.camera.yaw += 0.5;
  const double yaw = demo.camera.yaw;
  const std::string stride = writeClip("far.bvh", stridingBvh(500));
  demo.requests = {{Ask::kPause, "", "", 1}, {Ask::kMotionFile, "", stride}};
  app::advanceFrame(demo, 0, {});
  EXPECT_FALSE(demo.message_is_fault) << demo.message;
  EXPECT_LT((demo.camera.anchor - headOf(demo)).norm(), 1e-9);
  EXPECT_EQ(demo.camera.yaw, yaw) << "a person's orbit stays";
  const Eigen::AlignedBox2d box = drawnBox(demo);
  EXPECT_LE(box.min().cwiseAbs().maxCoeff(), 1);
  EXPECT_GT(box.sizes().y() / 2, 0.7);
}

TEST(BadInput, APopOfTwoMetresInTheRootLeavesTheHairAsItIs) {
  Demo plain = open(characterOf(writeClip("plain.bvh", stridingBvh())));
  Demo popped = open(characterOf(writeClip("popped.bvh", stridingBvh(0, 20))));
  double most = 0;
  for (int frame = 0; frame < 100; ++frame) {
    for (Demo* demo : {&plain, &popped}) app::advanceFrame(*demo, kFrame, {});
    most = std::max(most, farthest(seenFromHead(plain), seenFromHead(popped)));
    ASSERT_LT(projectedHead(popped).cwiseAbs().maxCoeff(), 0.5);
  }
  EXPECT_LT(most, 0.01);
  const std::vector<std::string>& notes = popped.actors[0].body->character.notes;
  EXPECT_TRUE(std::ranges::any_of(notes, [](const std::string& note) { return note.starts_with("pops: 1 "); }));
}

TEST(BadInput, ClipsOfAFrameOrTwoAndWithAFarEndKeepTheHairUpright) {
  const std::string whole = stridingBvh();
  const std::size_t rows = whole.find("Frame Time");
  const auto of = [&](std::vector<int> frames) {
    std::string text = whole.substr(0, whole.find("Frames: 60"));
    text += "Frames: " + std::to_string(frames.size()) + "\nFrame Time: 0.0333333\n";
    for (const int f : frames) {
      std::size_t line = whole.find('\n', rows) + 1;
      for (int k = 0; k < f; ++k) line = whole.find('\n', line) + 1;
      text += whole.substr(line, whole.find('\n', line) + 1 - line);
    }
    return text;
  };
  std::vector<int> far_end;
  for (int f = 0; f < 30; ++f) far_end.push_back(f);
  far_end.push_back(59);
  for (const auto& frames : {std::vector<int>{0}, std::vector<int>{0, 59}, far_end}) {
    SCOPED_TRACE(frames.size());
    Demo demo = open(characterOf(writeClip("few.bvh", of(frames))));
    for (int frame = 0; frame < 120; ++frame) {
      app::advanceFrame(demo, kFrame, {});
      ASSERT_LT(projectedHead(demo).cwiseAbs().maxCoeff(), 0.5) << frame;
      ASSERT_EQ(demo.actors[0].last_report.recoveries, 0);
      ASSERT_EQ(demo.actors[0].last_report.guided, 0) << frame;
    }
    // What is seen from the head hangs about where it did.
    const sim::HairState rest = sim::restState(demo.actors[0].haircut->mesh, app::Rigid::Identity());
    EXPECT_LT(farthest(seenFromHead(demo), rest.positions), 0.15);
  }
}

TEST(FarAway, TheHairIsTheSameWithinRounding) {
  constexpr int kEarly = 20;  // frames
  // Captured 100 m away, stood 100 m away, and at home.
  app::CharacterSpec spec = characterOf(writeClip("near.bvh", stridingBvh()));
  Demo near = open(spec);
  spec.position = Vec3(100, 0, -70);
  Demo stood = open(spec);
  Demo captured = open(characterOf(writeClip("away.bvh", stridingBvh(10000))));
  double most = 0, early = 0;
  for (int frame = 0; frame < 180; ++frame) {
    for (Demo* demo : {&near, &stood, &captured}) app::advanceFrame(*demo, kFrame, {});
    most = std::max({most, farthest(seenFromHead(near), seenFromHead(stood)),
                     farthest(seenFromHead(near), seenFromHead(captured))});
    if (frame < kEarly) early = most;
  }
  EXPECT_LT(early, 1e-6) << "m, while contacts stick and slide alike";
  EXPECT_LT(most, 2e-2) << "m, over a round and a half: by then contacts slip or stick by the last bit";
}

TEST(FarAway, ThePictureIsTheSameToAHundredthOfAMillimetre) {
  app::CharacterSpec spec = characterOf("walk.bvh");
  Demo near = open(spec);
  spec.position = Vec3(20000, 0, -70000);
  Demo far = open(spec);
  for (int frame = 0; frame < 20; ++frame) {
    for (Demo* demo : {&near, &far}) app::advanceFrame(*demo, kFrame, {});
  }
  const render::FrameInput here = app::frameInput(near, 320, 240), there = app::frameInput(far, 320, 240);
  double most = 0;
  const auto compare = [&](std::span<const float> a, std::span<const float> b) {
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
      const std::size_t k = i % 3;
      most = std::max(most, std::abs(double(a[i]) - here.camera.eye[k] - (double(b[i]) - there.camera.eye[k])));
    }
  };
  compare(here.hairs[0].positions, there.hairs[0].positions);
  compare(here.camera.target, there.camera.target);
  for (std::size_t j = 0; j < here.bodies[0].joint_matrices.size(); ++j) {
    compare(std::span(here.bodies[0].joint_matrices[j]).subspan(12, 3),
            std::span(there.bodies[0].joint_matrices[j]).subspan(12, 3));
  }
  EXPECT_LT(most, 1e-5) << "m";
}

}  // namespace loop_test
