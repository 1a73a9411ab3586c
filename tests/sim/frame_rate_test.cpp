// The same clip at any frame rate: roots and colliders are posed for every step, so that the hair ends in the same
// place, and damping is per second, so that the step's length changes the motion but little.
#include <gtest/gtest.h>

#include <cmath>

#include "app/files/data_path.h"
#include "app/scene/demo.h"
#include "tests/sim_probes.h"
#include "tests/test_meshes.h"

namespace frame_rate_test {

// Frames of 24 to 144 a second pass through the same steps: not near one another, the same.
constexpr double kStatedDistance = 1e-9;  // m

app::Demo dancingDemo(double time_step = 1.0 / 60) {
  app::Scene scene;
  app::CharacterSpec spec;
  spec.motion = app::dataPath("assets/clips/dance.bvh");
  spec.style = app::Style::kLong;
  spec.resolution = app::Resolution::kLow;
  scene.characters.push_back(spec);
  scene.sim.time_step = time_step;
  scene.playback.settle = 0.2;
  scene.playback.speed = 2;
  return app::openScene(std::move(scene), 1.5);
}

// Frames drawn by `frameSeconds` until `seconds` have passed.
template <class FrameSeconds>
std::vector<sim::Vec3> play(app::Demo demo, double seconds, FrameSeconds&& frameSeconds) {
  double time = 0;
  while (time < seconds - 1e-9) {
    const double frame = std::min(frameSeconds(), seconds - time);
    app::advanceFrame(demo, frame, {});
    time += frame;
  }
  EXPECT_EQ(demo.clock.lost, 0);
  EXPECT_EQ(demo.stats.recoveries, 0);
  return demo.actors[0].hair.positions;
}

TEST(FrameRate, TheSameClipEndsInTheSamePlaceAtEveryRate) {
  const std::vector<sim::Vec3> reference = play(dancingDemo(), 1, [] { return 1.0 / 60; });
  for (const double fps : {24.0, 30.0, 144.0}) {
    const std::vector<sim::Vec3> end = play(dancingDemo(), 1, [&] { return 1 / fps; });
    EXPECT_LE(test::largestDistance(end, reference), kStatedDistance) << fps;
  }
  test::Random random(5);
  const std::vector<sim::Vec3> uneven = play(dancingDemo(), 1, [&] { return random(0.001, 0.12); });
  EXPECT_LE(test::largestDistance(uneven, reference), kStatedDistance);
}

// A swing in still air loses the same share of its energy per second at every step length.
TEST(FrameRate, DampingIsPerSecondNotPerStep) {
  std::vector<double> left;
  for (const double step : {1.0 / 480, 1.0 / 240, 1.0 / 120}) {
    sim::SimParams params = test::tautHair();
    params.integrator = sim::Integrator::kBdf2;  // whose own damping is small at these steps
    params.air_drag = 3, params.damping = 0.005;
    test::PatchOptions o;
    o.layers = 6;
    test::Hair hair(test::combedShape(o), params);
    for (int i = 0; i < hair.mesh.vertexCount(); ++i)
      hair.state.velocities[i] = sim::Vec3(2 * (hair.roots[0].y() - hair.state.positions[i].y()), 0, 0);
    sim::StepContext probe(hair.mesh);
    const double rest =
        test::mechanicalEnergy(hair.mesh, params, probe, sim::restState(hair.mesh, Eigen::Isometry3d::Identity()));
    const double start = test::mechanicalEnergy(hair.mesh, params, probe, hair.state) - rest;
    for (int n = 0; n < std::lround(0.25 / step); ++n) hair.step(step);
    left.push_back((test::mechanicalEnergy(hair.mesh, params, probe, hair.state) - rest) / start);
  }
  std::printf("energy left after a quarter of a second: %.4f %.4f %.4f\n", left[0], left[1], left[2]);
  EXPECT_GT(left[0], 0);
  EXPECT_LT(left[0], 0.6);
  EXPECT_NEAR(left[1], left[0], 0.05 * left[0] + 0.002);
  EXPECT_NEAR(left[2], left[0], 0.15 * left[0] + 0.004);
}

}  // namespace frame_rate_test
