// A parameter means the same at every resolution and time step: see docs/consistency.md.
#include "tests/bench/consistency.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <numbers>

#include "sim/forces/model.h"
#include "tests/bench/material_points.h"
#include "tests/bench/preset_params.h"
#include "tests/bench/slide.h"
#include "tests/test_meshes.h"

namespace consistency_test {

using bench::TipPaths;
using sim::Vec3;

constexpr double kLength = 0.4;  // m

// The same block of hair in f times finer cells, hanging, its head shaken about the vertical and tilted.
TipPaths shakenTips(int f, double rate, std::span<const Vec3> points) {
  test::PatchOptions o;
  o.nx = o.nz = f, o.layers = 3 * f + 1;
  o.spacing = 0.04 / f, o.length = kLength;
  sim::SimParams params = test::tautHair();
  params.bend = 0.05, params.shear = 500;  // soft enough to swing
  params.collide = false;
  params.solver = sim::Solver::kDefault;
  test::Hair hair(test::patchShape(o), params);
  const std::vector<Vec3> rest_roots = hair.roots;
  std::vector<bench::MaterialPoint> followed;
  for (const Vec3& p : points) followed.push_back(bench::materialPoint(hair.mesh, p));
  TipPaths paths;
  const int steps_a_sample = static_cast<int>(std::lround(rate / 30));
  for (int n = 1; n <= static_cast<int>(rate); ++n) {
    const double t = n / rate, angle = 0.5 * std::sin(6 * t) * std::min(1.0, 3 * t);
    const Eigen::Matrix3d turn =
        (Eigen::AngleAxisd(angle, Vec3::UnitY()) * Eigen::AngleAxisd(0.6 * angle, Vec3::UnitX())).toRotationMatrix();
    for (std::size_t c = 0; c < rest_roots.size(); ++c) hair.roots[c] = turn * rest_roots[c];
    hair.step(1 / rate);
    if (n % steps_a_sample != 0) continue;
    auto& sample = paths.emplace_back();
    for (std::size_t k = 0; k < points.size(); ++k)
      sample.push_back(turn.transpose() * followed[k].at(hair.state.positions) - points[k]);
  }
  return paths;
}

std::vector<Vec3> tipsOfBlock() {
  return {{0, -kLength, 0}, {0.04, -kLength, 0}, {0, -kLength, 0.04}, {0.04, -kLength, 0.04}, {0.02, -kLength, 0.02}};
}

TEST(Consistency, ResolutionsFollowTheSameMotionTheNearerTheFiner) {
  const auto points = tipsOfBlock();
  const TipPaths coarse = shakenTips(1, 60, points), medium = shakenTips(2, 60, points),
                 fine = shakenTips(4, 60, points);
  const double motion = bench::pathSize(fine, kLength);
  const double far = bench::pathDifference(coarse, fine, kLength), near = bench::pathDifference(medium, fine, kLength);
  std::printf("motion %.4f of the hair's length; coarse to fine %.4f, medium to fine %.4f\n", motion, far, near);
  EXPECT_GT(motion, 0.05) << "too little motion to compare";
  EXPECT_LT(far, 0.15 * motion);
  EXPECT_LT(near, 0.6 * far);
}

TEST(Consistency, TimeStepsFollowTheSameMotionTheNearerTheSmaller) {
  const auto points = tipsOfBlock();
  const TipPaths limit = shakenTips(1, 1920, points);
  const double motion = bench::pathSize(limit, kLength);
  double before = 0;
  for (const double rate : {30.0, 60.0, 120.0, 240.0}) {
    const double now = bench::pathDifference(shakenTips(1, rate, points), limit, kLength);
    std::printf("1/%.0f s: %.4f of the hair's length, of a motion of %.4f\n", rate, now, motion);
    if (before > 0) {
      EXPECT_LT(now, 0.75 * before);
    } else {
      EXPECT_LT(now, 0.85 * motion);
    }
    before = now;
  }
}

// Where the law of the prisms' section begins and ends.
TEST(Consistency, WidePrismsResistAChangeOfVolumeInInverseProportionToTheirSection) {
  for (const double spacing : {0.008, 0.02, 0.04}) {
    test::PatchOptions o;
    o.spacing = spacing;
    const sim::HairMesh mesh = sim::buildHairMesh(test::patchShape(o));
    const sim::SimParams params;
    EXPECT_NEAR(sim::volumeModulus(mesh, params) / params.volume, std::min(1.0, 1.5e-4 / (spacing * spacing)), 1e-6);
    sim::SimParams soft;
    soft.volume *= 1e-3;
    EXPECT_EQ(sim::volumeModulus(mesh, soft), soft.volume) << "what hardly carries itself is not made softer still";
  }
}

// A lock that hardly bends back slides where gravity along the slope exceeds friction: at atan(friction).
TEST(SlideAngle, OfALimpLockIsThatOfItsFriction) {
  sim::SimParams params = bench::presetParams("natural");
  params.bend = 0.01, params.shear = 20, params.stretch_across = 100;
  for (const double friction : {0.15, 0.3, 0.6}) {
    params.friction = friction;
    const double angle = bench::measureSlideAngle(params), law = std::atan(friction);
    std::printf("friction %.2f: %.1f degrees, by the law %.1f\n", friction, angle * 180 / std::numbers::pi,
                law * 180 / std::numbers::pi);
    EXPECT_NEAR(angle, law, 0.1 * law + 0.01) << friction;
  }
}

}  // namespace consistency_test
