#include "tests/bench/slide.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "sim/mesh/hair_mesh.h"
#include "sim/step.h"
#include "tests/test_meshes.h"

namespace bench {
namespace {

using sim::Vec3;

constexpr double kLong = 0.3, kThick = 0.008;  // m
constexpr double kSlope = 50;                  // m, radius of what stands for a plane
constexpr double kDown = 0.02, kWithin = 1;    // m, s
constexpr double kSteepest = 80 * std::numbers::pi / 180;
constexpr int kHalvings = 8;  // of the angle: to 0.3 degrees

// m that the tip has gone down the slope.
double slidOn(double slope, const sim::SimParams& params) {
  test::PatchOptions lock;
  lock.nx = 2, lock.nz = 1, lock.layers = 10, lock.spacing = kThick, lock.length = kLong;
  const sim::HairMesh mesh = sim::buildHairMesh(test::patchShape(lock));
  // Down the slope, off it, and level across it, where the lock goes.
  const Vec3 down(std::cos(slope), -std::sin(slope), 0), off(std::sin(slope), std::cos(slope), 0);
  Eigen::Isometry3d lying = Eigen::Isometry3d::Identity();
  lying.linear().col(0) = down;
  lying.linear().col(1) = down.cross(off).normalized() * -1;
  lying.linear().col(2) = lying.linear().col(0).cross(lying.linear().col(1));
  const double side = lying.linear().col(2).dot(off) > 0 ? 0 : kThick;
  lying.translation() = (params.contact_offset + side) * off;

  sim::Ellipsoid plane;
  plane.center = -kSlope * off;
  plane.radii = Vec3::Constant(kSlope);
  sim::StepContext context(mesh);
  sim::HairState state = sim::restState(mesh, lying);
  const std::vector<Vec3> roots = test::rootsOf(mesh, state.positions);
  const std::vector<sim::Ellipsoid> body{plane};
  const std::size_t tip = state.positions.size() - 1;
  const Vec3 from = state.positions[tip];
  for (double time = params.time_step; time <= kWithin; time += params.time_step)
    sim::advance(mesh, params, {roots, body, time}, params.time_step, context, state);
  return down.dot(state.positions[tip] - from);
}

}  // namespace

double measureSlideAngle(const sim::SimParams& params) {
  double stays = 0, slides = kSteepest;
  for (int k = 0; k < kHalvings; ++k) {
    const double slope = 0.5 * (stays + slides);
    (slidOn(slope, params) < kDown ? stays : slides) = slope;
  }
  return stays;
}

}  // namespace bench
