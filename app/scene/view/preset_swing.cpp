#include "app/scene/view/preset_swing.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/step.h"

namespace app {

namespace {

constexpr double kTurn = std::numbers::pi / 3, kTurnTime = 0.3;  // rad, s
constexpr double kLongestStep = 1.0 / 60;                        // s

// rad that are left of the turn; it begins and ends gently.
double leftToTurn(double time) {
  const double share = std::clamp(time / kTurnTime, 0.0, 1.0);
  return 0.5 * kTurn * (1 + std::cos(std::numbers::pi * share));
}

Rigid turnedBack(double angle, const Vec3& about) {
  return Eigen::Translation3d(about) * Eigen::AngleAxisd(-angle, Vec3::UnitY()) * Eigen::Translation3d(-about);
}

}  // namespace

std::vector<Vec3> swungHair(const Swing& swing) {
  const int steps = static_cast<int>(std::ceil(kTurnTime / std::min(kLongestStep, swing.params.time_step)));
  const double step = kTurnTime / steps;
  const Vec3 about = swing.head.translation();
  sim::StepContext context(swing.mesh);
  sim::HairState hair = sim::restState(swing.mesh, turnedBack(kTurn, about) * swing.head);
  std::vector<Vec3> roots(static_cast<std::size_t>(swing.mesh.columnCount()));
  std::vector<sim::Ellipsoid> body = swing.body;
  for (int k = 1; k <= steps; ++k) {
    const double left = leftToTurn(k * step);
    const Vec3 speed = Vec3::UnitY() * ((leftToTurn((k - 1) * step) - left) / step);
    const Rigid turned = turnedBack(left, about), head = turned * swing.head;
    for (std::size_t c = 0; c < roots.size(); ++c)
      roots[c] = head * swing.mesh.shape.positions[static_cast<std::size_t>(swing.mesh.shape.column_first[c])];
    for (std::size_t i = 0; i < body.size(); ++i) {
      body[i].center = turned * swing.body[i].center;
      body[i].rotation = turned.linear() * swing.body[i].rotation;
      body[i].angular_velocity = speed;
      body[i].velocity = speed.cross(body[i].center - about);
    }
    sim::StepInput input;
    input.roots = roots;
    input.ellipsoids = body;
    input.time = k * step;
    sim::advance(swing.mesh, swing.params, input, step, context, hair);
  }
  return hair.positions;
}

}  // namespace app
