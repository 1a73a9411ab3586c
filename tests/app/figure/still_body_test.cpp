// A body without a skeleton is a figure: its axis, unit, neck and facing are told by its outline.
#include "app/figure/still_body.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "app/figure/attachment.h"
#include "app/figure/character.h"
#include "app/files/data_path.h"
#include "app/files/errors.h"
#include "app/files/file_kind.h"

namespace {

struct Shape {
  std::vector<Eigen::Vector3f> positions;
  std::vector<std::uint32_t> triangles;

  void addEllipsoid(const Eigen::Vector3f& center, const Eigen::Vector3f& radii) {
    constexpr std::uint32_t kRings = 16, kSides = 24;
    const auto base = static_cast<std::uint32_t>(positions.size());
    for (std::uint32_t i = 0; i <= kRings; ++i) {
      for (std::uint32_t j = 0; j < kSides; ++j) {
        const double t = EIGEN_PI * i / kRings, p = 2 * EIGEN_PI * j / kSides;
        const Eigen::Vector3d unit(std::sin(t) * std::cos(p), std::cos(t), std::sin(t) * std::sin(p));
        positions.push_back(center + radii.cwiseProduct(unit.cast<float>()));
      }
    }
    for (std::uint32_t i = 0; i < kRings; ++i) {
      for (std::uint32_t j = 0; j < kSides; ++j) {
        const std::uint32_t a = base + i * kSides + j, b = base + i * kSides + (j + 1) % kSides;
        for (const std::uint32_t v : {a, b, a + kSides, b, b + kSides, a + kSides}) triangles.push_back(v);
      }
    }
  }
};

// `turn` of a shape that faces +z with y up, in metres, and its faces wound inwards where asked.
std::string writeObj(const std::string& name, const Shape& shape, const Eigen::Matrix3f& turn, bool inwards) {
  const std::string file = (std::filesystem::path(::testing::TempDir()) / name).string();
  std::ofstream out(file);
  for (const Eigen::Vector3f& p : shape.positions) out << "v " << (turn * p).transpose() << '\n';
  for (std::size_t t = 0; t < shape.triangles.size(); t += 3) {
    const std::uint32_t a = shape.triangles[t] + 1, b = shape.triangles[t + 1] + 1, c = shape.triangles[t + 2] + 1;
    out << "f " << a << ' ' << (inwards ? b : c) << ' ' << (inwards ? c : b) << '\n';
  }
  return file;
}

double volumeOf(const app::SkinnedMesh& mesh) {
  double six_volumes = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); t += 3) {
    const auto at = [&](std::size_t k) { return mesh.positions[mesh.triangles[t + k]].cast<double>(); };
    six_volumes += at(0).dot(at(1).cross(at(2)));
  }
  return six_volumes / 6;
}

std::string whyNoFigure(const std::string& file) {
  try {
    app::loadCharacter(file);
  } catch (const app::InputError& fault) {
    return fault.what();
  }
  return "";
}

Shape standingBody() {
  Shape body;
  body.addEllipsoid({0, 1.57f, 0.02f}, {0.075f, 0.115f, 0.095f});  // skull
  body.addEllipsoid({0, 1.47f, 0.06f}, {0.04f, 0.04f, 0.05f});     // chin
  body.addEllipsoid({0, 1.42f, -0.02f}, {0.055f, 0.1f, 0.055f});   // neck
  body.addEllipsoid({0, 1.15f, 0}, {0.2f, 0.26f, 0.12f});
  for (const float side : {-1.0f, 1.0f}) {
    body.addEllipsoid({side * 0.1f, 0.5f, 0}, {0.085f, 0.5f, 0.09f});
    body.addEllipsoid({side * 0.35f, 1.33f, 0}, {0.3f, 0.05f, 0.05f});
  }
  return body;
}

Eigen::Vector3d forwardOf(const app::Character& figure) {
  return (figure.skeleton.joints[figure.head_joint].rest_world * figure.head_frame).linear().col(2);
}

TEST(StillBody, StandsUprightInMetresAndFacesWhereItsFileHasIt) {
  Eigen::Matrix3f z_up, aside;
  z_up << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  aside = Eigen::AngleAxisf(0.5f, Eigen::Vector3f::UnitY()).toRotationMatrix();
  struct Case {
    Eigen::Matrix3f turn;
    bool inwards;
    Eigen::Vector3d forward;
  };
  const std::vector<Case> cases{{Eigen::Matrix3f::Identity(), false, {0, 0, 1}},
                                {100 * z_up, true, {0, 0, 1}},
                                {39.37f * aside, false, {std::sin(0.5), 0, std::cos(0.5)}}};
  for (const Case& c : cases) {
    Shape shape = standingBody();
    shape.positions.insert(shape.positions.end(), {{-3, 0, -3}, {3, 0, -3}, {0, 0, 3}});  // a floor
    const auto last = static_cast<std::uint32_t>(shape.positions.size());
    shape.triangles.insert(shape.triangles.end(), {last - 3, last - 2, last - 1});
    const std::string file = writeObj("head_of_clay.obj", shape, c.turn, c.inwards);
    EXPECT_EQ(app::fileKind(file), app::FileKind::kMotion);
    const app::Character body = app::loadCharacter(file);
    EXPECT_EQ(body.skeleton.joints[body.head_joint].name, "head");
    EXPECT_NEAR(body.skeleton.joints[body.head_joint].rest_world.translation().y(), 1.45, 0.05);
    EXPECT_NEAR(body.scalp.head_height, 0.25, 0.04);
    EXPECT_GT(forwardOf(body).dot(c.forward), 0.99);
    EXPECT_GT(volumeOf(body.mesh), 0);
    float crown = 0;
    for (const Eigen::Vector3f& p : body.mesh.positions) crown = std::max(crown, p.y());
    EXPECT_NEAR(crown, 1.685f, 0.01f);
  }
}

TEST(StillBody, ABodyAboutTheOriginStandsOnTheGround) {
  Shape body = standingBody();
  for (Eigen::Vector3f& p : body.positions) p -= Eigen::Vector3f(2, 1, 0);
  const app::Character figure = app::loadCharacter(writeObj("pelvis.obj", body, Eigen::Matrix3f::Identity(), false));
  const Eigen::Vector3d head = figure.skeleton.joints[1].rest_world.translation();
  EXPECT_NEAR(head.y(), 1.45, 0.05);
  EXPECT_NEAR(head.x(), -2, 0.01);
}

TEST(StillBody, WhatIsToldCountsInPlaceOfTheOutline) {
  app::ToldBody told;
  EXPECT_EQ(app::readToldBody("unit=cm, up=z face=-x", told), "");
  EXPECT_EQ(app::writeToldBody(told), "unit=cm up=z face=-x");
  EXPECT_EQ(app::readToldBody("face=+z", told), "");
  EXPECT_EQ(app::writeToldBody(told), "face=z");
  EXPECT_EQ(app::readToldBody("", told), "");
  EXPECT_EQ(app::writeToldBody(told), "");
  for (const char* wrong : {"unit=league", "up=x", "face=y", "size=2", "cm"})
    EXPECT_NE(app::readToldBody(wrong, told).find("write unit=m, cm"), std::string::npos) << wrong;
  Eigen::Matrix3f z_up;
  z_up << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  const std::string doll = writeObj("doll.obj", standingBody(), 0.5f * z_up, false);
  EXPECT_NEAR(app::loadCharacter(doll).scalp.head_height, 0.25, 0.04) << "grown to a head of usual size";
  const app::Character small = app::loadCharacter(doll, "", "unit=m up=z face=-x");
  EXPECT_TRUE(small.is_still);
  EXPECT_NEAR(small.scalp.head_height, 0.125, 0.02);
  EXPECT_GT(forwardOf(small).dot(Eigen::Vector3d(-1, 0, 0)), 0.999);
  EXPECT_THROW(app::loadCharacter(doll, "", "up=y"), app::InputError);
  const std::string walk = app::findFile("walk.bvh", "", "clips");
  EXPECT_THROW(app::loadCharacter(walk, "", "unit=m"), app::InputError);
  EXPECT_FALSE(app::loadCharacter(walk).is_still);
}

TEST(StillBody, ABustIsOneAndTheHatOfItsSceneStaysWhereItIs) {
  Shape bust;
  bust.addEllipsoid({0, 1.57f, 0.02f}, {0.075f, 0.115f, 0.095f});
  bust.addEllipsoid({0, 1.47f, 0.06f}, {0.04f, 0.04f, 0.05f});
  bust.addEllipsoid({0, 1.42f, -0.02f}, {0.055f, 0.1f, 0.055f});
  bust.addEllipsoid({0, 1.25f, 0}, {0.2f, 0.1f, 0.12f});
  Shape peak;
  peak.addEllipsoid({0, 1.66f, 0.16f}, {0.07f, 0.03f, 0.05f});  // ahead of the forehead
  const Eigen::Matrix3f back = Eigen::AngleAxisf(static_cast<float>(EIGEN_PI), Eigen::Vector3f::UnitY()).matrix();
  const app::Character figure = app::loadCharacter(writeObj("bust.obj", bust, 39.37f * back, false));
  EXPECT_NEAR(figure.scalp.head_height, 0.25, 0.04);
  EXPECT_LT(forwardOf(figure).z(), -0.99);
  app::AttachmentSpec spec;
  spec.file = writeObj("peak.obj", peak, back, false);
  spec.joint = "head";
  const app::Attachment worn = app::loadAttachment(spec, figure);
  Eigen::AlignedBox3f box;
  for (const Eigen::Vector3f& p : worn.positions) box.extend(p);
  const Eigen::Vector3d at = figure.skeleton.joints[1].rest_world * box.center().cast<double>();
  EXPECT_LT((at - Eigen::Vector3d(0, 1.66, -0.16)).norm(), 0.1) << at.transpose() << worn.note;
}

TEST(StillBody, WhatHasNoNeckIsRefusedAndHairIsToldApart) {
  Shape ball, triangle;
  ball.addEllipsoid({0, 1, 0}, {0.3f, 0.3f, 0.3f});
  triangle.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  triangle.triangles = {0, 1, 2};
  for (const Shape& shape : {ball, triangle}) {
    const std::string file = writeObj("neckless.obj", shape, Eigen::Matrix3f::Identity(), false);
    EXPECT_NE(whyNoFigure(file).find("no neck under a head"), std::string::npos) << whyNoFigure(file);
  }
  for (const auto& worn : std::filesystem::directory_iterator(app::dataPath("assets/attachments"))) {
    if (worn.path().extension() != ".obj") continue;
    EXPECT_EQ(app::fileKind(worn.path().string()), app::FileKind::kAttachment) << worn.path();
  }
  const std::string hat = whyNoFigure(app::dataPath("assets/attachments/beanie.obj"));
  EXPECT_NE(hat.find("a hat to --attach"), std::string::npos) << hat;
  const std::string hair = whyNoFigure(app::dataPath("assets/hair/bob_example.obj"));
  EXPECT_NE(hair.find("is a hair mesh, no figure; give it to --hair"), std::string::npos) << hair;
}

TEST(StillBody, AModelledBodyIsFoundWithAHeadThatStylesFit) {
  const std::filesystem::path file =
      std::filesystem::path(HAIRMESH_SOURCE_DIR) / "../shared/characters/mh_female_body.obj";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is absent";
  EXPECT_EQ(app::fileKind(file.string()), app::FileKind::kMotion);
  const app::Character body = app::loadCharacter(file.string());
  EXPECT_NEAR(body.scalp.head_height, 0.22, 0.03);
  EXPECT_GT(forwardOf(body).z(), 0.999);
}

}  // namespace
