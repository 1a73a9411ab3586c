// Laws of loaded characters: imported models, ARCSim's mannequin, ellipsoids, scalp, distance to the body, bad input.
#include "app/figure/character.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <random>

#include "app/figure/character_build.h"
#include "app/files/data_path.h"
#include "app/files/errors.h"
#include "app/files/text_file.h"
#include "app/motion/motion.h"

namespace character_test {

namespace fs = std::filesystem;
using app::Rigid;
using app::Vec3;

const fs::path kShared = fs::path(HAIRMESH_SOURCE_DIR) / ".." / "shared";
const fs::path kModels = "/usr/share/assimp/models";

void expectFinite(const app::Pose& pose) {
  for (const Rigid& w : pose.world) {
    ASSERT_TRUE(w.matrix().allFinite());
    ASSERT_NEAR(w.linear().determinant(), 1, 1e-6);
  }
}

void expectInputError(const std::string& file, const std::string& parts, const std::vector<std::string>& words) {
  try {
    app::loadCharacter(file, parts);
    ADD_FAILURE() << file << " should be refused";
  } catch (const app::InputError& e) {
    for (const std::string& word : words)
      EXPECT_NE(std::string(e.what()).find(word), std::string::npos) << e.what() << " should say " << word;
  }
}

std::string scratch(const std::string& name, const std::string& content) {
  fs::create_directories(HAIRMESH_TEST_OUT);
  const fs::path file = fs::path(HAIRMESH_TEST_OUT) / name;
  std::ofstream(file, std::ios::binary) << content;
  return file.string();
}

double bruteDistance(const app::Character& c, const Vec3& p) {
  const Rigid to_scalp = (c.skeleton.joints[c.head_joint].rest_world * c.head_frame).inverse();
  double best = 1e9;
  for (std::size_t t = 0; t < c.mesh.triangles.size(); t += 3) {
    std::array<Vec3, 3> v;
    for (int k = 0; k < 3; ++k) v[k] = to_scalp * c.mesh.positions[c.mesh.triangles[t + k]].cast<double>();
    // Nearest point of the plane if inside, else of the edges: independent of the implementation under test.
    const Vec3 n = (v[1] - v[0]).cross(v[2] - v[0]).normalized();
    const Vec3 foot = p - n.dot(p - v[0]) * n;
    bool inside = true;
    for (int k = 0; k < 3; ++k) {
      const Vec3 a = v[k], b = v[(k + 1) % 3];
      inside = inside && (b - a).cross(foot - a).dot(n) >= 0;
      const double s = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
      best = std::min(best, (p - a - s * (b - a)).norm());
    }
    if (inside) best = std::min(best, (p - foot).norm());
  }
  return best;
}

class OwnMannequin : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    character = new app::Character(app::loadCharacter(app::dataPath("assets/clips/walk.bvh")));
  }
  static void TearDownTestSuite() {
    delete character;
    character = nullptr;
  }
  static app::Character* character;
};
app::Character* OwnMannequin::character = nullptr;

TEST_F(OwnMannequin, EllipsoidsLieCloseToTheSkin) {
  // Vertices against the union of all ellipsoids, above the hips: what hair can touch.
  const app::Character& c = *character;
  const auto& skeleton = c.skeleton;
  double sum = 0, worst = 0, deepest = 0;
  std::size_t count = 0;
  const Rigid to_scalp = (skeleton.joints[c.head_joint].rest_world * c.head_frame).inverse();
  for (const auto& position : c.mesh.positions) {
    const Vec3 p = position.cast<double>(), s = to_scalp * p - c.scalp.center;
    const double height = c.scalp.head_height;
    if (s.y() < -2.6 * height) continue;  // below the waist
    const bool ear_or_nose = s.y() < 0.02 * height && s.y() > -0.5 * height;
    if (ear_or_nose && (std::abs(s.x()) > 0.29 * height || s.z() > 0.38 * height)) continue;
    double gap = 1e9;
    for (const auto& e : c.ellipsoids)
      gap = std::min(gap, app::ellipsoidGap(e, skeleton.joints[e.joint].rest_world.inverse() * p));
    sum += gap;
    worst = std::max(worst, gap);
    deepest = std::min(deepest, gap);
    ++count;
  }
  EXPECT_NEAR(sum / count, 0, 0.006) << "mean signed gap";
  EXPECT_LT(worst, 0.025) << "skin outside every ellipsoid";
  EXPECT_GT(deepest, -0.045) << "ellipsoid outside the skin";
}

TEST_F(OwnMannequin, HeadEllipsoidFitsTheScalp) {
  const app::Character& c = *character;
  const auto head =
      std::find_if(c.ellipsoids.begin(), c.ellipsoids.end(), [](const auto& e) { return e.name == "head"; });
  ASSERT_NE(head, c.ellipsoids.end());
  double worst = 0;
  for (int row = 0; row < c.scalp.rows / 2; ++row) {
    for (int column = 0; column < c.scalp.columns; ++column) {
      const double polar = row * EIGEN_PI / (c.scalp.rows - 1), azimuth = column * 2 * EIGEN_PI / c.scalp.columns;
      const Vec3 d(std::sin(polar) * std::sin(azimuth), std::cos(polar), std::sin(polar) * std::cos(azimuth));
      const Vec3 p = c.scalp.center + d * c.scalp.radius[row * c.scalp.columns + column];
      worst = std::max(worst, std::abs(app::ellipsoidGap(*head, c.head_frame * p)));
    }
  }
  EXPECT_LT(worst, 0.008);
}

TEST_F(OwnMannequin, ScalpIsSmoothAndMirrored) {
  const app::Scalp& s = character->scalp;
  ASSERT_EQ(s.rows, 65);
  ASSERT_EQ(s.columns, 128);
  ASSERT_EQ(s.radius.size(), static_cast<std::size_t>(s.rows * s.columns));
  const auto at = [&](int r, int c) { return s.radius[r * s.columns + (c % s.columns + s.columns) % s.columns]; };
  for (int r = 0; r < s.rows; ++r) {
    for (int c = 0; c < s.columns; ++c) {
      ASSERT_GT(at(r, c), 0.2 * s.head_height);
      ASSERT_LT(at(r, c), 1.2 * s.head_height);
      // Cranium, ears included: no step between neighbours and no difference between the sides.
      const bool face = std::abs((c + s.columns / 2) % s.columns - s.columns / 2) < s.columns / 8;
      if (r > (face ? 0.45 : 0.58) * s.rows) continue;
      EXPECT_LT(std::abs(at(r, c) - at(r, c + 1)), 0.016 * s.head_height) << "row " << r << " column " << c;
      EXPECT_NEAR(at(r, c), at(r, -c), 0.02 * s.head_height) << "row " << r << " column " << c;
    }
  }
}

TEST_F(OwnMannequin, DistanceAgreesWithBruteForceNearTheSkin) {
  const app::Character& c = *character;
  const app::BodyDistance distance = app::restBodyDistance(c);
  const Rigid to_scalp = (c.skeleton.joints[c.head_joint].rest_world * c.head_frame).inverse();
  std::mt19937 random(7);
  std::uniform_real_distribution<double> shift(-0.012, 0.012);
  int checked = 0;
  for (int k = 0; k < 4000 && checked < 150; ++k) {
    const std::size_t v = random() % c.mesh.positions.size();
    const double off = shift(random);
    const Vec3 skin = to_scalp * c.mesh.positions[v].cast<double>();
    const Vec3 p = skin + off * (to_scalp.linear() * c.mesh.normals[v].cast<double>());
    if (p.y() < -0.6 || std::abs(p.x()) > 0.3) continue;
    ++checked;
    const double brute = bruteDistance(c, p);
    EXPECT_NEAR(std::abs(distance(p)), brute, 0.0025);
    if (brute > 0.003) {
      EXPECT_EQ(distance(p) < 0, off < 0);
    }
  }
  EXPECT_EQ(checked, 150);
  EXPECT_LT(distance(c.scalp.center), -0.5 * 0.3 * c.scalp.head_height);
  EXPECT_NEAR(distance(Vec3(2, 0, 0)), bruteDistance(c, Vec3(2, 0, 0)), 0.5);
}

TEST_F(OwnMannequin, PosedEllipsoidsMoveWithTheirJoints) {
  const app::Character& c = *character;
  const app::Pose rest = app::restPose(c.skeleton);
  app::Pose moved = rest;
  const Eigen::AngleAxisd turn(0.02, Vec3(1, 2, 3).normalized());
  for (Rigid& w : moved.world) w = Eigen::Translation3d(0.01, 0, 0.02) * turn * w;
  std::vector<sim::Ellipsoid> e, before;
  app::poseEllipsoids(c, rest, rest, 0, before);
  app::poseEllipsoids(c, moved, rest, 0.01, e);
  ASSERT_EQ(e.size(), c.ellipsoids.size());
  for (std::size_t i = 0; i < e.size(); ++i) {
    EXPECT_LT((e[i].center - (turn * before[i].center + Vec3(0.01, 0, 0.02))).norm(), 1e-9);
    EXPECT_LT((e[i].velocity * 0.01 - (e[i].center - before[i].center)).norm(), 1e-9);
    EXPECT_LT((e[i].angular_velocity - turn.axis() * turn.angle() / 0.01).norm(), 1e-6);
    EXPECT_EQ(before[i].velocity, Vec3::Zero());
  }
}

TEST_F(OwnMannequin, NamesThePartsThatHairMeets) {
  for (const char* name : {"head", "neck", "chest", "left_upper_arm", "right_upper_arm", "left_shoulder"})
    EXPECT_TRUE(std::any_of(character->ellipsoids.begin(), character->ellipsoids.end(), [&](const auto& e) {
      return e.name == name;
    })) << name;
}

TEST(EllipsoidFit, RecoversAnEllipsoidFromItsSurface) {
  app::BodyEllipsoid truth;
  truth.center = Vec3(0.1, -0.2, 0.3);
  truth.rotation = Eigen::AngleAxisd(0.7, Vec3(1, 1, 0).normalized());
  truth.radii = Vec3(0.05, 0.16, 0.08);
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  std::vector<app::FitPoint> points;
  for (int k = 0; k < 400; ++k) {
    const Vec3 u = Vec3(normal(random), normal(random), normal(random)).normalized();
    points.push_back({truth.center + truth.rotation * u.cwiseProduct(truth.radii), 1});
  }
  const app::BodyEllipsoid fitted = app::fitEllipsoid(points, app::principalEllipsoid(points), 10);
  const app::FitReport report = app::reportFit(points, fitted);
  EXPECT_LT(report.max_gap, 1e-4);
  EXPECT_NEAR(fitted.radii.prod(), truth.radii.prod(), 1e-3 * truth.radii.prod());
  // A tenth of outliers 3 cm away does not drag it off.
  for (std::size_t k = 0; k < points.size(); k += 10) points[k].position += Vec3(0, 0, 0.03);
  const app::BodyEllipsoid robust = app::fitEllipsoid(points, app::principalEllipsoid(points), 10);
  EXPECT_LT((robust.center - truth.center).norm(), 0.003);
}

TEST(Import, RobotComesWithItsJointsClipsAndScale) {
  const fs::path file = kShared / "characters/robot.glb";
  if (!fs::exists(file)) GTEST_SKIP() << file << " is absent";
  const app::Character c = app::loadCharacter(file.string());
  std::size_t bones = 0;  // among them: nodes of the mesh objects are joints as well
  std::vector<bool> used(c.skeleton.joints.size(), false);
  for (std::size_t v = 0; v < c.mesh.positions.size(); ++v) {
    float sum = 0;
    for (int k = 0; k < 4; ++k) {
      used[c.mesh.joints[v][k]] = used[c.mesh.joints[v][k]] || c.mesh.weights[v][k] > 0;
      sum += c.mesh.weights[v][k];
    }
    ASSERT_NEAR(sum, 1, 1e-5);
  }
  for (const app::Joint& joint : c.skeleton.joints) {
    for (const char* bone : {"Bone", "Body", "Hips", "Abdomen", "Torso", "Neck"})
      bones += joint.name == bone && joint.parent >= 0;
  }
  EXPECT_GE(bones, 6u);
  EXPECT_GE(c.skeleton.joints.size(), 43u);
  EXPECT_EQ(c.clips.size(), 14u);
  EXPECT_EQ(c.skeleton.joints[c.head_joint].name, "Head");
  EXPECT_TRUE(used[c.head_joint]) << "the bone called Head, not the mesh object of the same name";
  float low = 1e9f, high = -1e9f;
  for (const auto& p : c.mesh.positions) {
    low = std::min(low, p.y());
    high = std::max(high, p.y());
  }
  EXPECT_NEAR(high - low, 1.70, 0.01);
  for (const app::Clip& clip : c.clips) {
    EXPECT_GT(clip.frameCount(), 1);
    app::Pose pose;
    for (int k = 0; k <= 10; ++k) {
      app::samplePose(c.skeleton, clip, clip.duration() * k / 10, pose);
      expectFinite(pose);
    }
  }
  // Facing +z: the eyes are the foremost part of the head.
  EXPECT_GT((c.skeleton.joints[c.head_joint].rest_world * c.head_frame).linear().col(2).z(), 0.99);
}

TEST(Import, BrokenModelsAreRefusedNotCrashedOn) {
  if (!fs::is_directory(kModels)) GTEST_SKIP() << "assimp-testmodels is not installed";
  int refused = 0;
  for (const char* folder :
       {"glTF2/IndexOutOfRange", "glTF2/MissingBin", "glTF2/RecursiveNodes", "glTF2/SchemaFailures",
        "glTF2/TestNoRootNode", "glTF2/BoxWithInfinites-glTF-Binary", "glTF2/wrongTypes", "glTF2/issue_3269",
        "glTF2/IncorrectVertexArrays", "glTF/IncorrectVertexArrays"}) {
    if (!fs::is_directory(kModels / folder)) continue;
    for (const auto& entry : fs::directory_iterator(kModels / folder)) {
      const std::string ending = entry.path().extension().string();
      if (ending != ".gltf" && ending != ".glb") continue;
      expectInputError(entry.path().string(), "", {entry.path().filename().string(), "; "});
      ++refused;
    }
  }
  EXPECT_GE(refused, 10);
}

TEST(Import, TruncatedAtAnyLengthIsRefused) {
  const fs::path file = kShared / "characters/robot.glb";
  if (!fs::exists(file)) GTEST_SKIP() << file << " is absent";
  const std::string whole = app::readText(file.string());
  for (const std::size_t length :
       {std::size_t{5}, std::size_t{19}, std::size_t{2000}, whole.size() / 3, whole.size() - 7})
    expectInputError(scratch("cut.glb", whole.substr(0, length)), "", {"cut.glb"});
}

TEST(Import, AMotionNamedAsAModelIsReadAsAMotion) {
  const std::string walk = app::readText(app::dataPath("assets/clips/walk.bvh"));
  EXPECT_EQ(app::loadCharacter(scratch("walk.glb", walk)).clips.size(), 1u);
}

TEST(BadInput, EveryKindNamesFileFaultAndMend) {
  expectInputError("no_such_file.glb", "", {"no_such_file.glb"});
  expectInputError("no_such_file.bvh", "", {"no_such_file.bvh"});
  expectInputError(scratch("empty.glb", ""), "", {"empty.glb"});
  expectInputError(scratch("noise.gltf", "{\"asset\": "), "", {"noise.gltf"});
  expectInputError(scratch("notes.txt", "hello, world, this is no motion"), "", {"notes.txt", ".bvh"});
  expectInputError(scratch("cut.bvh", "HIERARCHY\nROOT Hips\n{\n"), "", {"cut.bvh", "line"});
}

// By the number that the vertex has in the file, though equal vertices are joined as it is read.
TEST(BadInput, AVertexAtNoFinitePlaceIsNamed) {
  const float triangles[6][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0}, {1, 0, 0}, {NAN, 0.25f, 1}};
  const std::string bytes(reinterpret_cast<const char*>(triangles), sizeof triangles);
  scratch("nan.bin", bytes);
  const std::string gltf =
      R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
          "meshes": [{"name": "Body", "primitives": [{"attributes": {"POSITION": 0}}]}],
          "accessors": [{"bufferView": 0, "componentType": 5126, "count": 6, "type": "VEC3"}],
          "bufferViews": [{"buffer": 0, "byteLength": 72}], "buffers": [{"uri": "nan.bin", "byteLength": 72}]})";
  expectInputError(scratch("nan.gltf", gltf), "", {"mesh 'Body', vertex 5", "finite"});
  const std::string obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv nan 0.25 1\nf 1 2 3\nf 1 2 4\n";
  expectInputError(scratch("nan.obj", obj), "", {"vertex at (nan, 0.25, 1)", "finite"});
}

TEST(RigidParts, MissingOrBrokenPartsAreNamed) {
  const std::string mot =
      scratch("one.mot", "NumFrames: 2\nbody[0] position\n0 0 1\n0 0 1\nbody[0] orientation\n1 0 0 0\n1 0 0 0\n");
  expectInputError(mot, "", {"one.mot", "--parts"});
  const fs::path folder = fs::path(HAIRMESH_TEST_OUT) / "parts";
  fs::create_directories(folder);
  fs::remove(folder / "body0000.obj");
  expectInputError(mot, folder.string(), {"body0000.obj"});
  const auto part = [&](const std::string& text) { std::ofstream(folder / "body0000.obj") << text; };
  part("v 0 0 0\nv 1 0 0\nv 0 nan 0\nf 1 2 3\n");
  expectInputError(mot, folder.string(), {"body0000.obj", "line 3"});
  part("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 7\n");
  expectInputError(mot, folder.string(), {"body0000.obj", "line 4"});
  part("v 0 0 0\n");
  expectInputError(mot, folder.string(), {"body0000.obj", "faces"});
}

TEST(RigidParts, PapersMannequinDancesForThreeHundredFrames) {
  const fs::path folder = kShared / "arcsim";
  if (!fs::exists(folder / "dance.mot")) GTEST_SKIP() << folder << " is absent";
  const app::Character c = app::loadCharacter((folder / "dance.mot").string(), (folder / "female-objs").string());
  ASSERT_EQ(c.skeleton.joints.size(), 16u);
  ASSERT_GE(c.ellipsoids.size(), 16u);  // one a part, and those that cover what sticks out
  EXPECT_EQ(c.head_joint, 0);
  const app::Clip& clip = c.clips.front();
  EXPECT_EQ(clip.frameCount(), 2111);
  // The mesh's extent of every part, in the part's frame: its ellipsoid has to stay on it.
  std::vector<Vec3> low(16, Vec3::Constant(1e9)), high(16, Vec3::Constant(-1e9));
  for (std::size_t v = 0; v < c.mesh.positions.size(); ++v) {
    const int j = c.mesh.joints[v][0];
    const Vec3 p = c.skeleton.joints[j].rest_world.inverse() * c.mesh.positions[v].cast<double>();
    low[j] = low[j].cwiseMin(p);
    high[j] = high[j].cwiseMax(p);
  }
  app::Pose pose, before;
  std::vector<sim::Ellipsoid> e;
  double travelled = 0;
  for (int f = 0; f < 300; ++f) {
    app::samplePose(c.skeleton, clip, f * clip.frame_time, pose);
    expectFinite(pose);
    app::poseEllipsoids(c, pose, before, f ? clip.frame_time : 0, e);
    for (int b = 0; b < 16; ++b) {
      ASSERT_TRUE(e[b].center.allFinite() && e[b].velocity.allFinite() && e[b].angular_velocity.allFinite());
      ASSERT_LT((e[b].center - pose.world[b] * Vec3(0.5 * (low[b] + high[b]))).norm(), 0.06);
      travelled += e[b].velocity.norm() * clip.frame_time;
    }
    before = pose;
  }
  EXPECT_GT(travelled, 1.0);
  // It stands upright and its face looks the way its feet point.
  const Rigid head = app::scalpToWorld(c, app::restPose(c.skeleton));
  EXPECT_GT(head.linear().col(1).y(), 0.9);
  EXPECT_GT(head.linear().col(2).z(), 0.9);
  EXPECT_NEAR(head.linear().determinant(), 1, 1e-9);
  EXPECT_GT(c.scalp.head_height, 0.17);
  EXPECT_LT(c.scalp.head_height, 0.26);
}

}  // namespace character_test
