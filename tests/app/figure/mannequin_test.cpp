// Laws of the grown mannequin: closed and well wound, symmetric on symmetric skeletons, sanely skinned, facing forward,
// covered by its ellipsoids; and of the parts it is made of.
#include "app/figure/mannequin.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <map>

#include "app/figure/character_build.h"
#include "app/figure/mannequin_figure.h"
#include "app/figure/mannequin_mesh.h"
#include "app/files/errors.h"
#include "app/files/text_file.h"

namespace mannequin_test {

using app::Rigid;
using app::Vec3;

const std::filesystem::path kShared = std::filesystem::path(HAIRMESH_SOURCE_DIR) / ".." / "shared";
const std::filesystem::path kClips = std::filesystem::path(HAIRMESH_SOURCE_DIR) / "assets" / "clips";

std::vector<std::string> bvhFiles() {
  std::vector<std::string> files;
  for (const auto& folder : {kShared / "mocap", kClips}) {
    if (!std::filesystem::is_directory(folder)) continue;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
      if (entry.path().extension() == ".bvh") files.push_back(entry.path().string());
  }
  std::sort(files.begin(), files.end());
  return files;
}

// Each file's once.
const app::Mannequin& grow(const std::string& file) {
  static std::map<std::string, app::Mannequin> grown;
  const auto found = grown.find(file);
  if (found != grown.end()) return found->second;
  return grown.emplace(file, app::growMannequin(app::readBvh(app::readText(file), file), file)).first->second;
}

// One BVH joint line group.
struct Bone {
  std::string name;
  Vec3 offset;
  std::vector<Bone> children;
  Vec3 end = Vec3::Zero();
};

void write(const Bone& bone, bool root, std::string& text, int& joints) {
  const auto number = [](const Vec3& v) {
    return std::to_string(v.x()) + " " + std::to_string(v.y()) + " " + std::to_string(v.z());
  };
  ++joints;
  text += (root ? "ROOT " : "JOINT ") + bone.name + "\n{\nOFFSET " + number(bone.offset) + "\n";
  text += root ? "CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation\n"
               : "CHANNELS 3 Zrotation Xrotation Yrotation\n";
  for (const Bone& child : bone.children) write(child, false, text, joints);
  if (bone.children.empty()) text += "End Site\n{\nOFFSET " + number(bone.end) + "\n}\n";
  text += "}\n";
}

std::string bvhText(const Bone& root, int frames = 2) {
  std::string text = "HIERARCHY\n";
  int joints = 0;
  write(root, true, text, joints);
  text += "MOTION\nFrames: " + std::to_string(frames) + "\nFrame Time: 0.0166667\n";
  for (int f = 0; f < frames; ++f) {
    text += "0 95 0";
    for (int c = 0; c < 3 * joints; ++c) text += " 0";
    text += "\n";
  }
  return text;
}

Bone arm(double side) {
  const std::string s = side > 0 ? "Left" : "Right";
  return {s + "Arm",
          {side * 17, 46, -1},
          {{s + "ForeArm", {side * 28, 0, 0}, {{s + "Hand", {side * 24, 0, 0}, {}, {side * 17, 0, 0}}}, {}}},
          {}};
}

Bone leg(double side) {
  const std::string s = side > 0 ? "Left" : "Right";
  return {
      s + "UpLeg", {side * 9, -3, 0}, {{s + "Leg", {0, -42, 0}, {{s + "Foot", {0, -41, 0}, {}, {0, -7, 13}}}, {}}}, {}};
}

Bone symmetricFigure() {
  Bone head{"Head", {0, 9, 1}, {}, {0, 17, 0}};
  Bone neck{"Neck", {0, 51, -1}, {head}, {}};
  return {"Hips", {0, 0, 0}, {neck, arm(1), arm(-1), leg(1), leg(-1)}, {}};
}

app::Mannequin growText(const Bone& root) {
  return app::growMannequin(app::readBvh(bvhText(root), "figure.bvh"), "figure.bvh");
}

// Edges by their number of uses in each direction.
void expectClosedAndWound(const app::SkinnedMesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> directed;
  for (std::size_t t = 0; t < mesh.triangles.size(); t += 3)
    for (int k = 0; k < 3; ++k) ++directed[{mesh.triangles[t + k], mesh.triangles[t + (k + 1) % 3]}];
  std::size_t faults = 0;
  for (const auto& [edge, count] : directed) {
    const auto other = directed.find({edge.second, edge.first});
    if (count != 1 || other == directed.end() || other->second != 1) ++faults;
  }
  EXPECT_EQ(faults, 0u) << "edges that are not shared by exactly two triangles of one winding";
}

double signedVolume(const app::SkinnedMesh& mesh) {
  double volume = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); t += 3) {
    const Vec3 a = mesh.positions[mesh.triangles[t]].cast<double>();
    volume += a.dot(mesh.positions[mesh.triangles[t + 1]].cast<double>().cross(
                  mesh.positions[mesh.triangles[t + 2]].cast<double>())) /
              6;
  }
  return volume;
}

class EveryClip : public testing::TestWithParam<std::string> {};

TEST_P(EveryClip, GrowsAClosedOutwardBodyWithSaneWeights) {
  const app::Mannequin& m = grow(GetParam());
  expectClosedAndWound(m.mesh);
  const double height = m.field.figure.height;
  EXPECT_GT(height, 1.35);
  EXPECT_LT(height, 2.05);
  // A body of this build holds about 12 litres a metre cubed of height.
  const double volume = signedVolume(m.mesh) / (height * height * height);
  EXPECT_GT(volume, 0.006);
  EXPECT_LT(volume, 0.020);
  EXPECT_GE(m.mesh.triangles.size() / 3, 20000u);
  EXPECT_LE(m.mesh.triangles.size() / 3, 70000u);
  std::size_t inward = 0;
  for (std::size_t v = 0; v < m.mesh.positions.size(); ++v) {
    ASSERT_TRUE(m.mesh.positions[v].allFinite());
    ASSERT_NEAR(m.mesh.normals[v].norm(), 1, 1e-4);
    EXPECT_GE(m.mesh.positions[v].y(), -0.02 * height);
    EXPECT_LE(m.mesh.positions[v].y(), 1.02 * height);
    float sum = 0;
    for (int k = 0; k < 4; ++k) {
      ASSERT_GE(m.mesh.weights[v][k], 0);
      ASSERT_LT(m.mesh.joints[v][k], m.skeleton.joints.size());
      sum += m.mesh.weights[v][k];
    }
    ASSERT_NEAR(sum, 1, 1e-5);
  }
  for (std::size_t t = 0; t < m.mesh.triangles.size(); t += 3) {
    const auto corner = [&](int k) { return m.mesh.positions[m.mesh.triangles[t + k]]; };
    const Eigen::Vector3f n = (corner(1) - corner(0)).cross(corner(2) - corner(0));
    if (n.dot(m.mesh.normals[m.mesh.triangles[t]]) < 0) ++inward;
  }
  EXPECT_LT(inward, m.mesh.triangles.size() / 3 / 200) << "triangles that face against their normals";
}

TEST_P(EveryClip, VerticesLieOnTheField) {
  const app::Mannequin& m = grow(GetParam());
  std::size_t off = 0;
  for (const auto& p : m.mesh.positions)
    if (std::abs(m.field.value(p.cast<double>())) > 5e-4) ++off;
  EXPECT_LT(off, m.mesh.positions.size() / 100);
}

TEST_P(EveryClip, HeadFrameIsRightHandedUprightAndFacesTheToes) {
  const app::Mannequin& m = grow(GetParam());
  EXPECT_NEAR(m.head_frame.linear().determinant(), 1, 1e-9);
  const Rigid rest = m.skeleton.joints[m.roles.head].rest_world * m.head_frame;
  EXPECT_GT(rest.linear().col(1).y(), 0.999);
  Vec3 toes = Vec3::Zero();
  for (const auto& l : m.field.figure.legs) toes += l.toe - l.ankle;
  toes.y() = 0;
  EXPECT_GT(rest.linear().col(2).dot(toes.normalized()), 0.98);
  EXPECT_GT(m.field.figure.arms[0].shoulder.x(), m.field.figure.arms[1].shoulder.x()) << "left is +x";
}

// Against the file itself, where it faces is told by its own toes in its own first frame.
TEST_P(EveryClip, ClipStaysUpTheRightWayAndFacesItsToesWhileStanding) {
  const std::string file = GetParam();
  const app::BvhMotion motion = app::readBvh(app::readText(file), file);
  const app::Mannequin& m = grow(file);
  app::Pose pose;
  app::samplePose(m.skeleton, motion.clip, 0, pose);
  const Rigid head = pose.world[m.roles.head] * m.head_frame;
  EXPECT_GT(head.linear().col(1).y(), 0.6) << "upright at the first frame";
  Vec3 toes = Vec3::Zero();
  for (const auto& l : m.roles.legs) {
    const Rigid& foot = pose.world[l.foot];
    const Vec3 rest_foot = m.skeleton.joints[l.foot].rest_world.translation();
    const Vec3 toe = foot * (m.skeleton.joints[l.foot].rest_world.inverse() * Vec3(rest_foot + Vec3(0, 0, 0.1)));
    toes += toe - foot.translation();
  }
  toes.y() = 0;
  Vec3 ahead = head.linear().col(2);
  ahead.y() = 0;
  EXPECT_GT(ahead.normalized().dot(toes.normalized()), 0.3);
}

TEST_P(EveryClip, SkullIsRigid) {
  const app::Mannequin& m = grow(GetParam());
  std::size_t skull = 0;
  for (std::size_t v = 0; v < m.mesh.positions.size(); ++v) {
    const Vec3 q = m.field.toHead(m.mesh.positions[v].cast<double>());
    if (q.y() < 0.45 || q.cwiseAbs().maxCoeff() > 1.1) continue;
    ++skull;
    EXPECT_EQ(m.mesh.joints[v][0], m.roles.head);
    EXPECT_GT(m.mesh.weights[v][0], 0.99f);
  }
  EXPECT_GT(skull, 1000u);
}

TEST_P(EveryClip, TheGarmentCoversTrunkAndThighsAndLeavesFaceAndHandsBare) {
  const app::Mannequin& m = grow(GetParam());
  const app::Figure& f = m.field.figure;
  ASSERT_EQ(m.mesh.cloth.size(), m.mesh.positions.size());
  // The garment at the vertex nearest to a place.
  const auto at = [&](const Vec3& place) {
    std::size_t best = 0;
    const auto away = [&](std::size_t v) { return (m.mesh.positions[v].cast<double>() - place).norm(); };
    for (std::size_t v = 1; v < m.mesh.positions.size(); ++v)
      if (away(v) < away(best)) best = v;
    return m.mesh.cloth[best];
  };
  const double chest = 0.6 * f.shoulder_level + 0.4 * f.pelvis.y();
  EXPECT_LT(at(Vec3(f.pelvis.x(), chest, f.pelvis.z() + 0.2)), -0.01) << "chest";
  EXPECT_LT(at(Vec3(f.pelvis.x(), chest, f.pelvis.z() - 0.2)), -0.01) << "back";
  EXPECT_GT(at(m.field.head_origin + m.field.head_scale * Vec3(0, 0.4, 0.45)), 0.02) << "face";
  for (const app::Figure::Arm& arm : f.arms) {
    if (arm.present) {
      EXPECT_GT(at(arm.wrist), 0.01) << "hand";
    }
  }
  for (const app::Figure::Leg& leg : f.legs) {
    if (leg.present) {
      EXPECT_LT(at(0.5 * (leg.hip + leg.knee)), -0.01) << "thigh";
    }
  }
}

TEST_P(EveryClip, LimbsDoNotWeldToTheTrunkOrToEachOther) {
  const app::Mannequin& m = grow(GetParam());
  const auto weightOf = [&](std::size_t v, int joint) {
    double w = 0;
    for (int k = 0; k < 4; ++k)
      if (m.mesh.joints[v][k] == joint) w += m.mesh.weights[v][k];
    return w;
  };
  for (std::size_t v = 0; v < m.mesh.positions.size(); ++v) {
    EXPECT_FALSE(weightOf(v, m.roles.legs[0].lower) > 0.01 && weightOf(v, m.roles.legs[1].lower) > 0.01);
    EXPECT_FALSE(weightOf(v, m.roles.arms[0].fore) > 0.01 && weightOf(v, m.roles.spine.front()) > 0.01);
    EXPECT_FALSE(weightOf(v, m.roles.arms[1].fore) > 0.01 && weightOf(v, m.roles.legs[1].upper) > 0.01);
  }
}

INSTANTIATE_TEST_SUITE_P(Mannequin, EveryClip, testing::ValuesIn(bvhFiles()), [](const auto& clip) {
  std::string name = std::filesystem::path(clip.param).stem().string();
  std::replace_if(
      name.begin(), name.end(), [](unsigned char c) { return !std::isalnum(c); }, '_');
  return name;
});

TEST(Mannequin, IsMirrorSymmetricOnAMirrorSymmetricSkeleton) {
  const app::Mannequin m = growText(symmetricFigure());
  double worst = 0;
  for (const auto& p : m.mesh.positions) {
    const Vec3 mirrored(-p.x(), p.y(), p.z());
    worst = std::max(worst, std::abs(m.field.value(mirrored)));
  }
  EXPECT_LT(worst, 1e-3) << "the mirror image of the skin should lie on the skin";
  Vec3 low = Vec3::Constant(1e9), high = -low;
  for (const auto& p : m.mesh.positions) {
    low = low.cwiseMin(p.cast<double>());
    high = high.cwiseMax(p.cast<double>());
  }
  EXPECT_NEAR(low.x(), -high.x(), 1e-3);
}

// A rest pose taken from a motion leans, twists and shrugs.
TEST(Mannequin, AFigureTakenFromADanceStandsStraightAndMirrored) {
  const std::string file = (kClips / "dance.bvh").string();
  app::BvhMotion motion = app::readBvh(app::readText(file), file);
  std::vector<app::Joint>& joints = motion.skeleton.joints;
  const std::map<std::string, Eigen::AngleAxisd> bends{{"Hips", {0.3, Vec3(0, 0.6, 0.8)}},
                                                       {"Spine1", {0.4, Vec3(0.6, 0.8, 0)}},
                                                       {"Chest", {0.5, Vec3(0, 1, 0)}},
                                                       {"LeftShoulder", {0.4, Vec3(0, 0, 1)}}};
  std::size_t bent = 0;
  for (app::Joint& joint : joints) {
    if (const auto bend = bends.find(joint.name); bend != bends.end()) joint.rest_local.rotate(bend->second), ++bent;
    joint.rest_world = joint.parent < 0 ? joint.rest_local
                                        : joints[static_cast<std::size_t>(joint.parent)].rest_world * joint.rest_local;
  }
  ASSERT_EQ(bent, bends.size());
  const app::StoodSkeleton stood = app::standSkeleton(motion, file);
  const auto& [left, right] = stood.figure.arms;
  const Vec3 mirror(-1, 1, 1);
  EXPECT_LT((left.shoulder - right.shoulder.cwiseProduct(mirror)).norm(), 0.005);
  EXPECT_LT((left.wrist - right.wrist.cwiseProduct(mirror)).norm(), 0.005);
  EXPECT_LT((stood.figure.legs[0].hip - stood.figure.legs[1].hip.cwiseProduct(mirror)).norm(), 0.005);
  EXPECT_LT(std::abs(stood.figure.skull_base.x()), 0.01);
  EXPECT_GT(left.shoulder.x(), 0.14);
}

TEST(Mannequin, SameTextGrowsTheSameBytes) {
  const app::Mannequin a = growText(symmetricFigure()), b = growText(symmetricFigure());
  ASSERT_EQ(a.mesh.positions.size(), b.mesh.positions.size());
  EXPECT_TRUE(a.mesh.positions == b.mesh.positions);
  EXPECT_TRUE(a.mesh.weights == b.mesh.weights);
}

TEST(Mannequin, OddSkeletonsStillGrowSomethingClosed) {
  Bone no_arms = symmetricFigure();
  no_arms.children.erase(no_arms.children.begin() + 1, no_arms.children.begin() + 3);
  Bone no_legs = symmetricFigure();
  no_legs.children.resize(3);
  Bone one_arm = symmetricFigure();
  one_arm.children.erase(one_arm.children.begin() + 1);
  Bone tail = symmetricFigure();
  tail.children.push_back({"Tail", {0, 0, -10}, {{"Tail1", {0, -10, -30}, {}, {0, -10, -30}}}, {}});
  for (const Bone& figure : {no_arms, no_legs, one_arm, tail}) {
    const app::Mannequin m = growText(figure);
    expectClosedAndWound(m.mesh);
    EXPECT_GT(signedVolume(m.mesh), 0.01);
  }
  EXPECT_EQ(growText(tail).field.appendages.size(), 1u);
}

TEST(Mannequin, NamesAreNotNeededToFindTheHead) {
  Bone figure = symmetricFigure();
  int number = 0;
  const auto rename = [&](auto&& self, Bone& bone) -> void {
    bone.name = "joint" + std::to_string(number++);
    for (Bone& child : bone.children) self(self, child);
  };
  rename(rename, figure);
  const app::Mannequin m = growText(figure);
  EXPECT_EQ(m.skeleton.joints[m.roles.head].name, "joint2");
  EXPECT_TRUE(m.field.figure.arms[0].present && m.field.figure.arms[1].present);
  EXPECT_TRUE(m.field.figure.legs[0].present && m.field.figure.legs[1].present);
}

TEST(Mannequin, SkeletonWithoutAHeadIsRefusedWithAMend) {
  const Bone stick{"Root", {0, 0, 0}, {{"Down", {0, -100, 0}, {}, {0, -70, 0}}}, {}};
  try {
    growText(stick);
    FAIL() << "a hanging stick has no head";
  } catch (const app::InputError& e) {
    EXPECT_NE(std::string(e.what()).find("figure.bvh"), std::string::npos);
    EXPECT_NE(std::string(e.what()).find("Head"), std::string::npos);
  }
}

TEST(MeshSurface, SphereIsClosedRoundAndFacesOutwards) {
  app::MeshGrid grid;
  grid.holds = {{Vec3::Zero(), 0.2}};
  grid.fine_from = 0.1;
  grid.coarse_from = -0.1;
  const app::Surface s = app::meshSurface([](const Vec3& p) { return p.norm() - 0.15; }, grid);
  app::SkinnedMesh mesh;
  for (const Vec3& p : s.positions) {
    EXPECT_NEAR(p.norm(), 0.15, 2e-5);
    mesh.positions.push_back(p.cast<float>());
  }
  mesh.triangles = s.triangles;
  expectClosedAndWound(mesh);
  EXPECT_NEAR(signedVolume(mesh), 4.0 / 3 * EIGEN_PI * 0.15 * 0.15 * 0.15, 2e-4);
}

TEST(MeshSurface, TouchingSheetsStayManifold) {
  // Two balls that touch in a point, a thin gap and a checkerboard of tiny balls: the cases where sheets share cells.
  app::MeshGrid grid;
  grid.holds = {{Vec3::Zero(), 0.2}};
  const auto balls = [](const Vec3& p) {
    const double a = (p - Vec3(0.08, 0, 0)).norm() - 0.08, b = (p + Vec3(0.08, 0, 0)).norm() - 0.0795;
    const double c = 0.004 - 0.012 * std::cos(90 * p.x()) * std::cos(90 * p.y()) * std::cos(90 * p.z());
    return std::min({a, b, std::max(c, p.norm() - 0.17)});
  };
  const app::Surface s = app::meshSurface(balls, grid);
  app::SkinnedMesh mesh;
  for (const Vec3& p : s.positions) mesh.positions.push_back(p.cast<float>());
  mesh.triangles = s.triangles;
  expectClosedAndWound(mesh);
}

}  // namespace mannequin_test
