// Collision ellipsoids cover the skin that hair can reach, and nothing where hair may be.
#include "app/figure/skin_cover.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>

#include "app/figure/body_sdf.h"
#include "app/figure/character_build.h"
#include "app/figure/signed_grid.h"
#include "app/figure/skin_samples.h"
#include "app/scene/sim_to_render.h"

namespace skin_cover_test {

namespace fs = std::filesystem;
using app::Rigid;
using app::Vec3;

// A trunk with two humps of 3 cm in front, under a head: a joint and one fitted ellipsoid each.
double humps(const Vec3& d) {
  const auto hump = [&](double x) { return std::exp(-(d - Vec3(x, 0.2, 0.7).normalized()).squaredNorm() / 0.06); };
  return hump(0.5) + hump(-0.5);
}

double trunkRadius(const Vec3& d) {
  return 0.15 + 0.03 * humps(d);
}

double lowHumpsRadius(const Vec3& d) {
  return 0.15 + 0.012 * humps(d);
}

void addBall(int joint, const Vec3& center, double (*radius)(const Vec3&), app::Character& c) {
  constexpr std::uint32_t kRows = 40, kColumns = 60;
  const auto base = static_cast<std::uint32_t>(c.mesh.positions.size());
  const auto at = [&](double row, double column) {
    const double down = row * EIGEN_PI / kRows, around = column * 2 * EIGEN_PI / kColumns;
    const Vec3 d(std::sin(down) * std::sin(around), std::cos(down), std::sin(down) * std::cos(around));
    return Vec3(center + radius(d) * d);
  };
  for (std::uint32_t row = 0; row <= kRows; ++row) {
    for (std::uint32_t column = 0; column < kColumns; ++column) {
      const double r = std::clamp<double>(row, 0.01, kRows - 0.01), k = column;
      const Vec3 normal = (at(r + 0.01, k) - at(r - 0.01, k)).cross(at(r, k + 0.01) - at(r, k - 0.01)).normalized();
      c.mesh.positions.push_back(at(r, k).cast<float>());
      c.mesh.normals.push_back(normal.cast<float>());
      c.mesh.joints.push_back({static_cast<std::uint16_t>(joint), 0, 0, 0});
      c.mesh.weights.push_back({1, 0, 0, 0});
      const std::uint32_t a = base + row * kColumns + column, b = base + row * kColumns + (column + 1) % kColumns;
      if (row < kRows)
        c.mesh.triangles.insert(c.mesh.triangles.end(), {a, a + kColumns, b, b, a + kColumns, b + kColumns});
    }
  }
}

double headRadius(const Vec3&) {
  return 0.12;
}

double boxRadius(const Vec3& d) {
  return 0.12 / d.cwiseAbs().maxCoeff();
}

app::Character humpedFigure(double (*head_radius)(const Vec3&) = headRadius,
                            double (*trunk_radius)(const Vec3&) = trunkRadius) {
  app::Character c;
  const Vec3 trunk(0, 1.2, 0), head(0, 1.54, 0);
  for (const auto& [name, place] : {std::pair("chest", trunk), std::pair("head", head)}) {
    app::Joint joint;
    joint.name = name;
    joint.rest_local = joint.rest_world = Rigid(Eigen::Translation3d(place));
    c.skeleton.joints.push_back(joint);
  }
  c.head_joint = 1;
  c.scalp.head_height = 0.24;
  addBall(0, trunk, trunk_radius, c);
  addBall(1, head, head_radius, c);
  std::vector<app::BodyPart> parts(2);
  const std::vector<app::FitPoint> points = app::surfacePoints(c.mesh);
  for (std::size_t v = 0; v < points.size(); ++v) parts[c.mesh.joints[v][0]].points.push_back(points[v]);
  for (int j = 0; j < 2; ++j) parts[j].joint = j, parts[j].name = c.skeleton.joints[j].name;
  app::fitParts(parts, c);
  return c;
}

double gapAtRest(const app::Character& c, const Vec3& p) {
  double gap = 1e9;
  for (const app::BodyEllipsoid& e : c.ellipsoids)
    gap = std::min(gap, app::ellipsoidGap(e, c.skeleton.joints[e.joint].rest_world.inverse() * p));
  return gap;
}

// m, by which the skin of a joint sticks out of all ellipsoids at worst.
double sticksOut(const app::Character& c, int joint) {
  double out = 0;
  for (std::size_t v = 0; v < c.mesh.positions.size(); ++v) {
    if (c.mesh.joints[v][0] == joint) out = std::max(out, gapAtRest(c, c.mesh.positions[v].cast<double>()));
  }
  return out;
}

TEST(SkinCover, AddsEllipsoidsWhereSkinSticksOut) {
  app::Character c = humpedFigure();
  const double before = sticksOut(c, 0);
  ASSERT_GT(before, 0.010);
  const app::CoverReport report = app::coverSkin(c);
  EXPECT_GT(report.added, 0);
  EXPECT_EQ(c.ellipsoids.size(), 2u + static_cast<std::size_t>(report.added));
  EXPECT_NEAR(report.before, before, 0.002);
  EXPECT_LT(report.after, 0.003);
  EXPECT_LT(sticksOut(c, 0), 0.003);
}

// Where there are enough it goes on, to twice as many at most, while more than 3 mm stick out.
TEST(SkinCover, GoesOnWhileSkinSticksOut) {
  int beyond = 0, sufficed = 0;
  for (int enough = 1; enough <= 6; ++enough) {
    app::Character c = humpedFigure(headRadius, lowHumpsRadius);
    const app::CoverReport report = app::coverSkin(c, enough);
    EXPECT_LE(report.added, 2 * enough);
    EXPECT_TRUE(report.added == 2 * enough || report.after <= 0.003) << enough;
    beyond += report.added > enough;
    sufficed += report.added <= enough;
  }
  EXPECT_GT(beyond, 0);
  EXPECT_GT(sufficed, 0);
}

TEST(SkinCover, LeavesTheAirAndTheHeadFree) {
  app::Character c = humpedFigure();
  const app::Character plain = c;
  app::coverSkin(c);
  int head = 0, air = 0;
  for (std::size_t v = 0; v < c.mesh.positions.size(); ++v) {
    const Vec3 p = c.mesh.positions[v].cast<double>(), out = p + 0.016 * c.mesh.normals[v].cast<double>();
    if (c.mesh.joints[v][0] == 1) {
      ++head;
      ASSERT_GT(gapAtRest(c, p), std::min(gapAtRest(plain, p), 0.0) - 0.003);
    }
    if (gapAtRest(plain, out) < 0.006) continue;
    ++air;
    ASSERT_GT(gapAtRest(c, out), -0.002);
  }
  EXPECT_GT(head, 1000);
  EXPECT_GT(air, 1000);
}

TEST(SkinCover, IsTheSameEveryTimeAndAddsNoneWhereNoneIsAsked) {
  app::Character a = humpedFigure(), b = a, none = a;
  app::coverSkin(a);
  app::coverSkin(b);
  EXPECT_EQ(app::coverSkin(none, 0).added, 0);
  EXPECT_EQ(none.ellipsoids.size(), 2u);
  ASSERT_EQ(a.ellipsoids.size(), b.ellipsoids.size());
  for (std::size_t e = 0; e < a.ellipsoids.size(); ++e) {
    EXPECT_EQ(a.ellipsoids[e].center, b.ellipsoids[e].center);
    EXPECT_EQ(a.ellipsoids[e].radii, b.ellipsoids[e].radii);
  }
}

// Hair that flies past a face must not end in it; it stays clear of what hair is rooted in.
TEST(SkinCover, CoversTheMannequinsMouthAndChin) {
  const app::Character c = app::loadCharacter(HAIRMESH_SOURCE_DIR "/assets/clips/walk.bvh", "");
  const app::Rigid to_scalp = app::scalpToWorld(c, app::restPose(c.skeleton)).inverse();
  int looked = 0;
  for (const Eigen::Vector3f& at : c.mesh.positions) {
    const Vec3 p = at.cast<double>(), from = (to_scalp * p - c.scalp.center) / c.scalp.head_height;
    if (from.y() > -0.3 || from.y() < -0.55 || from.z() < 0.25) continue;
    ++looked;
    EXPECT_LT(gapAtRest(c, p), 0.004) << from.transpose();
  }
  EXPECT_GT(looked, 100);
}

// A head that is a box: signed distances of it in place of its ellipsoid, and the trunk covered as before.
TEST(SkinCover, ABoxIsSetApart) {
  app::Character c = humpedFigure(boxRadius);
  ASSERT_GT(sticksOut(c, 1), 0.03);
  const app::CoverReport report = app::coverSkin(c);
  EXPECT_EQ(report.unfit, "head");
  EXPECT_LT(report.after, 0.003);
  for (const app::BodyEllipsoid& e : c.ellipsoids) EXPECT_EQ(e.by_distances, e.joint == 1) << e.name;
  const std::vector<app::PartDistance> parts = app::unfitPartDistances(c);
  ASSERT_EQ(parts.size(), 1u);
  EXPECT_EQ(parts[0].joint, 1);
  for (const Vec3& d : {Vec3(1, 0.2, -0.3), Vec3(0.3, -0.9, 0.4), Vec3(0.1, -0.2, 1)}) {
    const Vec3 skin = boxRadius(d.normalized()) * d.normalized();
    EXPECT_NEAR(parts[0].grid.interpolate(skin), 0, 0.003) << d.transpose();
    EXPECT_LT(parts[0].grid.interpolate(0.8 * skin), -0.008) << d.transpose();
  }

  app::ShownSkin shown;
  app::showSkin(c, parts, app::restPose(c.skeleton), Vec3::Zero(), shown);
  EXPECT_EQ(shown.ellipsoids.size(), c.ellipsoids.size() - 1);
  EXPECT_EQ(shown.grids.size(), 1u);
}

// Parts that few ellipsoids do not fit are taken by distances, not filled with many small ones.
TEST(SkinCover, BoxesAreSetApartBeforeSmallEllipsoidsAreAdded) {
  const std::string model = "/usr/share/assimp/models/FBX/huesitos.fbx";
  if (!fs::exists(model)) GTEST_SKIP() << "assimp-testmodels is not installed";
  const app::Character c = app::loadCharacter(model, "");
  EXPECT_LT(c.ellipsoids.size(), 40u);
  EXPECT_GT(std::ranges::count_if(c.ellipsoids, &app::BodyEllipsoid::by_distances), 0);
}

// A box of a head moves as one, as its distances do; skin that another joint shares is left blended.
TEST(SkinCover, SkinOfABoxKeepsNoSmallWeightsOfOtherJoints) {
  app::Character c = humpedFigure(boxRadius);
  app::coverSkin(c);
  std::vector<std::size_t> head;
  for (std::size_t v = 0; v < c.mesh.joints.size(); ++v)
    if (c.mesh.joints[v][0] == 1) head.push_back(v);
  ASSERT_GT(head.size(), 20u);
  const std::array<float, 5> given{0.86f, 0.8f, 0.65f, 0.5f, 0.4f}, held{1, 1, 0.75f, 0.5f, 0.4f};
  for (std::size_t k = 0; k < given.size(); ++k) c.mesh.weights[head[k]] = {given[k], 1 - given[k], 0, 0};
  const std::vector<std::array<float, 4>> before = c.mesh.weights;
  ASSERT_EQ(app::unfitPartDistances(c).size(), 1u);
  for (std::size_t k = 0; k < given.size(); ++k) {
    EXPECT_NEAR(c.mesh.weights[head[k]][0], held[k], 1e-6) << k;
    EXPECT_NEAR(c.mesh.weights[head[k]][1], 1 - held[k], 1e-6) << k;
    c.mesh.weights[head[k]] = before[head[k]];
  }
  EXPECT_EQ(c.mesh.weights, before);
}

// Within pieces that lie in one another distances are to the surface of both together.
TEST(SignedGrid, PiecesAreOneSolid) {
  const auto grid = [](app::Pieces pieces) {
    app::Character c;
    addBall(
        0, Vec3(-0.05, 0, 0), [](const Vec3&) { return 0.1; }, c);
    addBall(
        0, Vec3(0.05, 0, 0), [](const Vec3&) { return 0.1; }, c);
    std::vector<app::Triangle> triangles;
    for (std::size_t t = 0; t + 2 < c.mesh.triangles.size(); t += 3) {
      app::Triangle& corners = triangles.emplace_back();
      for (std::size_t k = 0; k < 3; ++k) corners[k] = c.mesh.positions[c.mesh.triangles[t + k]].cast<double>();
    }
    app::SignedGrid filled = app::layOutGrid(Vec3(-0.2, -0.15, -0.15), Vec3(0.2, 0.15, 0.15), 0.005);
    app::fillGrid(triangles, 0.0125, pieces, filled);
    return filled;
  };
  const app::SignedGrid one = grid(app::Pieces::kOneSolid), all = grid(app::Pieces::kAll);
  const Vec3 middle(0.05, 0, 0), border(-0.148, 0, 0), off(0, 0.12, 0);
  EXPECT_NEAR(one.interpolate(middle), -0.086, 0.012);  // to the ring where both meet, or the far side
  EXPECT_NEAR(all.interpolate(middle), 0, 0.005);       // the other one's side runs through it
  EXPECT_NEAR(one.interpolate(border), -0.002, 0.001);
  EXPECT_NEAR(one.interpolate(off), all.interpolate(off), 1e-6);
}

// Hair is rooted on the head and lies on it; the neck below the nape's hairline bends, and is covered like the trunk.
TEST(SkinCover, TheNeckIsNotOfTheHead) {
  const app::Character c = app::loadCharacter(HAIRMESH_SOURCE_DIR "/assets/clips/walk.bvh", "");
  const app::PosedSkin skin = app::poseSkin(c, 3000, 1);
  const app::Rigid to_scalp = app::scalpToWorld(c, app::restPose(c.skeleton)).inverse();
  int neck = 0, head = 0;
  for (const app::SkinSample& sample : skin.samples) {
    const Vec3 from = (to_scalp * sample.rest - c.scalp.center) / c.scalp.head_height;
    const std::string& joint = c.skeleton.joints[static_cast<std::size_t>(sample.joint)].name;
    if (joint == "Neck" && from.y() < -0.35) {
      ++neck;
      EXPECT_FALSE(sample.of_head) << from.transpose();
    } else if (joint == "Head" && from.y() > -0.2 && from.z() < 0) {
      ++head;
      EXPECT_TRUE(sample.of_head) << from.transpose();
    }
  }
  EXPECT_GT(neck, 20);
  EXPECT_GT(head, 100);
}

// Strands that run through an ellipsoid are led to the head over a shoulder, but not up through the neck.
TEST(SkinEllipsoids, LeadToTheHeadWhereTheWayThereIsFree) {
  const app::Character c = app::loadCharacter(HAIRMESH_SOURCE_DIR "/assets/clips/walk.bvh", "");
  app::ShownSkin shown;
  app::showSkin(c, {}, app::restPose(c.skeleton), Vec3::Zero(), shown);
  const std::vector<render::SkinEllipsoid>& skin = shown.ellipsoids;
  ASSERT_EQ(skin.size(), c.ellipsoids.size() + c.nose.size());
  int shoulders = 0, necks = 0;
  for (std::size_t e = 0; e < c.ellipsoids.size(); ++e) {
    const double home = Eigen::Map<const Eigen::Vector3f>(skin[e].home.data()).norm();
    if (c.ellipsoids[e].name == "left_shoulder" || c.ellipsoids[e].name == "right_shoulder") {
      ++shoulders;
      EXPECT_GT(home, 2.5);
    } else if (c.ellipsoids[e].name == "neck") {
      ++necks;
      EXPECT_LT(home, 0.1);
    }
  }
  EXPECT_EQ(shoulders, 2);
  EXPECT_EQ(necks, 1);
}

// Between the moments that the ellipsoids were fitted at: the trunk's skin in front, where no other part ends.
TEST(SkinCover, CoversThePapersMannequinThroughItsDance) {
  const fs::path folder = fs::path(HAIRMESH_SOURCE_DIR) / ".." / "shared" / "arcsim";
  if (!fs::exists(folder / "dance.mot")) GTEST_SKIP() << folder << " is absent";
  const app::Character c = app::loadCharacter((folder / "dance.mot").string(), (folder / "female-objs").string());
  const int chest = 5;
  ASSERT_EQ(c.skeleton.joints[chest].name, "chest");
  int looked = 0;
  for (int frame = 100; frame < 2100; frame += 333) {
    app::Pose pose;
    app::samplePose(c.skeleton, c.clips.front(), frame * c.clips.front().frame_time, pose);
    for (std::size_t v = 0; v < c.mesh.positions.size(); ++v) {
      if (c.mesh.joints[v][0] != chest || c.mesh.positions[v].y() > 1.35f || c.mesh.positions[v].y() < 1.2f) continue;
      const Vec3 p =
          pose.world[chest] * c.skeleton.joints[chest].rest_world.inverse() * c.mesh.positions[v].cast<double>();
      double gap = 1e9;
      for (const app::BodyEllipsoid& e : c.ellipsoids)
        gap = std::min(gap, app::ellipsoidGap(e, pose.world[e.joint].inverse() * p));
      ASSERT_LT(gap, 0.004) << "frame " << frame;
      ++looked;
    }
  }
  EXPECT_GT(looked, 500);
}

}  // namespace skin_cover_test
