// The mirror image of a scene moves as the mirror image of the motion.
#include <gtest/gtest.h>

#include <array>
#include <ostream>

#include "tests/test_meshes.h"

namespace sim {

inline void PrintTo(Integrator integrator, std::ostream* out) {
  constexpr std::array kNames{"LinearizedEuler", "ImplicitEuler", "Bdf2"};
  *out << kNames.at(static_cast<std::size_t>(integrator));
}

}  // namespace sim

namespace symmetry_test {

using sim::Vec3;

Vec3 mirrored(const Vec3& p) {
  return {-p.x(), p.y(), p.z()};
}

sim::HairMeshShape mirrored(sim::HairMeshShape shape) {
  for (Vec3& p : shape.positions) p = mirrored(p);
  for (sim::RootFace& face : shape.root_faces)
    std::reverse(face.columns.begin(), face.columns.begin() + face.corner_count);
  return shape;
}

// Largest distance (m) between a motion and the mirror image of its mirror image within a second: combed hair, turned
// and tilted, in a side wind, falling onto a ball to one side.
double asymmetry(sim::SimParams params, bool contacts) {
  test::PatchOptions o;
  o.layers = 6, o.length = 0.2, o.mixed = true, o.uneven = true;
  const sim::HairMeshShape shape = test::combedShape(o);
  params.wind_x = 3;
  params.collide = contacts;
  test::Hair hair(shape, params);
  params.wind_x = -3;
  test::Hair image(mirrored(shape), params);
  if (contacts) {
    sim::Ellipsoid ball;
    ball.center = Vec3(0.08, -0.16, 0.02);
    ball.radii = Vec3(0.05, 0.06, 0.05);
    hair.bodies = {ball};
    ball.center = mirrored(ball.center);
    image.bodies = {ball};
  }
  const std::vector<Vec3> rest = hair.roots;
  double worst = 0;
  int most_contacts = 0;
  for (int n = 1; n <= 60; ++n) {
    const double t = n / 60.0;
    const Eigen::Matrix3d turn = (Eigen::AngleAxisd(0.4 * std::sin(7 * t), Vec3::UnitY()) *
                                  Eigen::AngleAxisd(0.5 * std::sin(5 * t), Vec3::UnitZ()))
                                     .toRotationMatrix();
    for (std::size_t c = 0; c < rest.size(); ++c) {
      hair.roots[c] = turn * rest[c];
      image.roots[c] = mirrored(hair.roots[c]);
    }
    most_contacts = std::max(most_contacts, hair.step(1.0 / 60).contacts);
    image.step(1.0 / 60);
    for (std::size_t i = 0; i < hair.state.positions.size(); ++i)
      worst = std::max(worst, (hair.state.positions[i] - mirrored(image.state.positions[i])).norm());
  }
  EXPECT_EQ(most_contacts > 0, contacts);
  return worst;
}

class Symmetry : public testing::TestWithParam<sim::Integrator> {};

TEST_P(Symmetry, MirrorImagesMoveAlike) {
  sim::SimParams params = test::tautHair();
  params.integrator = GetParam();
  EXPECT_LT(asymmetry(params, false), 1e-6) << "metres";
  EXPECT_LT(asymmetry(params, true), 1e-6) << "metres, with contacts";
}

INSTANTIATE_TEST_SUITE_P(Integrators, Symmetry,
                         testing::Values(sim::Integrator::kLinearizedEuler, sim::Integrator::kBdf2),
                         testing::PrintToStringParamName());

}  // namespace symmetry_test
