#include "tests/bench/swing.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <string_view>

#include "app/files/errors.h"
#include "sim/mesh/hair_mesh.h"
#include "sim/step.h"
#include "tests/analytic_head.h"
#include "tests/bench/preset_params.h"
#include "tests/bench/slide.h"

namespace bench {
namespace {

using sim::Vec3;

constexpr double kNape = -0.05;                                 // m: hair hangs free below
constexpr double kTurn = std::numbers::pi / 3, kTurning = 0.3;  // rad, s
constexpr double kStill = std::numbers::pi / 90;                // rad

// Hair on the analytic head, which may turn about the vertical.
struct Stand {
  sim::HairMesh mesh;
  sim::SimParams params;
  sim::StepContext context;
  sim::HairState state;
  std::vector<Vec3> roots;
  std::vector<sim::Ellipsoid> rest, body;
  std::vector<int> tips;  // of the columns that hang behind
  double time = 0;

  Stand(app::Style style, app::Resolution resolution, const sim::SimParams& with)
      : mesh(sim::buildHairMesh(app::makeStyle(style, resolution, tests::analyticScalp(), tests::bodyDistance))),
        params(with),
        context(mesh),
        state(sim::restState(mesh, Eigen::Isometry3d::Identity())),
        roots(static_cast<std::size_t>(mesh.columnCount())) {
    const auto add = [&](const Vec3& center, const Vec3& radii) {
      sim::Ellipsoid e;
      e.center = center;
      e.radii = radii;
      rest.push_back(e);
    };
    add({0, 0.022, -0.012}, {0.076, 0.094, 0.098});  // the solids of tests/analytic_head.h
    add({0, -0.055, 0.035}, {0.052, 0.062, 0.058});
    add({0, -0.13, -0.035}, {0.055, 0.10, 0.055});
    add({0, -0.38, -0.02}, {0.165, 0.20, 0.095});
    add({0, -0.62, -0.03}, {0.13, 0.25, 0.09});
    for (int c = 0; c < mesh.columnCount(); ++c) {
      const Vec3& tip = mesh.shape.positions[mesh.shape.column_first[c + 1] - 1];
      if (tip.z() < -0.06 && std::abs(tip.x()) < 0.08) tips.push_back(mesh.shape.column_first[c + 1] - 1);
    }
  }

  // The head has turned by `angle` (rad) at the end of a step and turns by `rate` (rad/s); the shoulders stay.
  void step(double dt, double angle, double rate) {
    const Eigen::AngleAxisd turn(angle, Vec3::UnitY());
    for (int c = 0; c < mesh.columnCount(); ++c) roots[c] = turn * mesh.shape.positions[mesh.shape.column_first[c]];
    body = rest;
    for (std::size_t i = 0; i < 2; ++i) {
      body[i].center = turn * rest[i].center;
      body[i].rotation = Eigen::Quaterniond(turn);
      body[i].angular_velocity = Vec3(0, rate, 0);
      body[i].velocity = Vec3(0, rate, 0).cross(body[i].center);
    }
    time += dt;
    sim::advance(mesh, params, {roots, body, time}, dt, context, state);
  }

  double meanTipX() const {
    double sum = 0;
    for (const int v : tips) sum += state.positions[v].x();
    return sum / static_cast<double>(tips.size());
  }

  // rad about the vertical that the tips stand at, in the mean, from their places at rest.
  double meanTipAngle() const {
    double sum = 0;
    for (const int v : tips) {
      const Vec3 &was = mesh.shape.positions[v], &is = state.positions[v];
      sum += std::remainder(std::atan2(is.x(), is.z()) - std::atan2(was.x(), was.z()), 2 * std::numbers::pi);
    }
    return sum / static_cast<double>(tips.size());
  }
};

struct Extreme {
  double time, value;
};

std::vector<Extreme> extremesOf(const std::vector<double>& values, double dt) {
  std::vector<Extreme> extremes;
  for (std::size_t i = 1; i + 1 < values.size(); ++i) {
    const double a = values[i - 1], b = values[i], c = values[i + 1];
    if ((b - a) * (c - b) > 0 || b == a) continue;
    const double shift = 0.5 * (a - c) / (a - 2 * b + c);  // of the parabola through the three
    extremes.push_back({(static_cast<double>(i) + shift) * dt, b - 0.25 * (a - c) * shift});
  }
  return extremes;
}

double freeLength(const Stand& stand) {
  double sum = 0;
  for (const int v : stand.tips) sum += kNape - stand.mesh.shape.positions[v].y();
  return sum / static_cast<double>(stand.tips.size());
}

}  // namespace

Swing measureSwing(app::Style style, app::Resolution resolution, const sim::SimParams& params) {
  Stand stand(style, resolution, params);
  const double dt = params.time_step, length = freeLength(stand);
  for (int i = 0; i < 60; ++i) stand.step(dt, 0, 0);
  const double rest = stand.meanTipX();
  for (Vec3& p : stand.state.positions) p.x() += 0.2 * std::max(0.0, kNape - p.y());
  for (Vec3& v : stand.state.velocities) v.setZero();
  std::vector<double> aside{stand.meanTipX() - rest};
  for (int i = 0; i < std::lround(3 / dt); ++i) {
    stand.step(dt, 0, 0);
    aside.push_back(stand.meanTipX() - rest);
  }
  Swing swing;
  swing.length = length;
  const std::vector<Extreme> extremes = extremesOf(aside, dt);
  if (extremes.size() < 2) return swing;
  // From release, an extreme itself, to the second extreme is one period.
  const double chain = 1.2024 * std::sqrt(params.gravity / length);
  swing.frequency = 2 * std::numbers::pi / extremes[1].time / chain;
  const double decrement = std::log(std::abs(extremes[0].value / extremes[1].value));
  swing.damping = decrement / std::hypot(std::numbers::pi, decrement);
  return swing;
}

FollowThrough measureFollowThrough(app::Style style, app::Resolution resolution, const sim::SimParams& params) {
  Stand stand(style, resolution, params);
  const double dt = params.time_step;
  for (int i = 0; i < 60; ++i) stand.step(dt, 0, 0);
  FollowThrough result;
  const int turning = static_cast<int>(std::lround(kTurning / dt));
  for (int i = 1; i <= turning; ++i) {
    const double t = std::min(i * dt / kTurning, 1.0);
    stand.step(dt, kTurn * t * t * (3 - 2 * t), kTurn * 6 * t * (1 - t) / kTurning);
  }
  result.lag = kTurn - stand.meanTipAngle();
  std::vector<double> beyond;
  for (int i = 0; i < std::lround(4 / dt); ++i) {
    stand.step(dt, kTurn, 0);
    beyond.push_back(stand.meanTipAngle());
  }
  const double end = beyond.back();
  for (std::size_t i = 0; i < beyond.size(); ++i) {
    result.overshoot = std::max(result.overshoot, beyond[i] - end);
    if (std::abs(beyond[i] - end) > kStill) result.settling = static_cast<double>(i + 1) * dt;
  }
  return result;
}

bool runSwing(const SwingOptions& options) {
  bool hold = true;
  std::printf(
      "| preset | style | free length, m | frequency over a chain's | damping ratio | lag, deg | overshoot, deg | "
      "settled after, s | friction | slides from, deg |\n|---|---|---|---|---|---|---|---|---|---|\n");
  for (const char* preset : {"", "natural", "soft", "fine", "thick", "wet", "sprayed"}) {
    sim::SimParams params = *preset ? presetParams(preset) : sim::SimParams{};
    for (const auto& [name, value] : options.sets) {
      const std::string fault = sim::setParam(params, name, value).fault;
      if (!fault.empty()) throw app::InputError("", "--set " + name, fault, "");
    }
    constexpr double kDegrees = 180 / std::numbers::pi;
    const double slides = kDegrees * measureSlideAngle(params);
    for (const app::Style style : {app::Style::kShoulder, app::Style::kLong}) {
      const Swing swing = measureSwing(style, app::Resolution::kMedium, params);
      const FollowThrough follow = measureFollowThrough(style, app::Resolution::kMedium, params);
      std::printf("| %s | %s | %.2f | %.2f | %.2f | %.0f | %.0f | %.1f | %.2f | %.0f |\n", *preset ? preset : "default",
                  std::string(app::styleName(style)).c_str(), swing.length, swing.frequency, swing.damping,
                  kDegrees * follow.lag, kDegrees * follow.overshoot, follow.settling, params.friction, slides);
      const bool as_hair = swing.frequency > 1 && swing.frequency < 1.6 && swing.damping > 0.1 && swing.damping < 0.25;
      if (preset == std::string_view("natural") && style == app::Style::kLong && !as_hair) hold = false;
    }
  }
  return hold;
}

}  // namespace bench
