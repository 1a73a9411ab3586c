#include "app/scene/braid/bun.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "app/figure/smoothstep.h"
#include "app/styles/style_tie.h"

namespace app {
namespace {

using Eigen::Vector3d;

constexpr double kPitch = 7;                      // m a turn of the strands, in radii of the rope
constexpr double kCoilStep = 0.007;               // m
constexpr double kApart = 0.5, kThick = 0.62;     // of the rope's radius: a strand's middle off the rope's, its radius
constexpr double kEnd = 0.7;                      // the rope's radius where its end begins, over that at the ring
constexpr double kTucked = 0.03, kPointed = 0.3;  // m of the end that thins, and to what
constexpr double kComesIn = 0.03;                 // m from the ring, after which hair lies in the rope
constexpr double kPlaitLies = 0.38;               // of a plait's width: the radius of the rope that it lies as

// In radii of the rope.
constexpr double kSpacing = 1.7;  // of two turns side by side
constexpr double kFirst = 0.9;    // radius of the first turn and of the way up to it
constexpr double kOnScalp = 0.7;  // height of the last turn

// Half an ellipsoid, its middle on the ring's axis; m.
struct Dome {
  double across, high, foot;  // half axes; of its rim over the ring

  CoilStep at(double polar, double turn) const {
    const Vector3d ray(std::sin(polar) * std::cos(turn), std::sin(polar) * std::sin(turn), std::cos(polar));
    return {{across * ray.x(), across * ray.y(), foot + high * ray.z()},
            {ray.x() / across, ray.y() / across, ray.z() / high}};
  }
};

// Its rim lies on the scalp or, about a ring that is farther off, no lower than half a ball's.
Dome domeOf(const BraidTie& tie, double rope, double across) {
  const double side = std::min(across, 0.9 * tie.head);
  const double scalp = -tie.over_scalp - (tie.head - std::sqrt(tie.head * tie.head - side * side));
  const double foot = std::max(kOnScalp * rope + scalp, -across);
  return {across, kFirst * rope - foot, foot};
}

// From the ring straight up, over, and around the dome to its rim: x, y across the ring, z along its axis.
std::vector<CoilStep> wayOver(const Dome& dome, double rope) {
  constexpr int kParts = 60;  // of a turn
  constexpr double kTurn = 2 * std::numbers::pi / kParts;
  const double first = kFirst * rope;
  double polar = std::asin(std::min(1.0, first / dome.across));
  const Vector3d begin = dome.at(polar, 0).at;
  std::vector<CoilStep> way;
  for (int k = 0; 4 * k < kParts; ++k) {
    const double turn = k * kTurn;
    const Vector3d off(0, -std::cos(turn), std::sin(turn));
    way.push_back({begin + first * (off - Vector3d::UnitZ()), off});
  }
  for (int k = 0; polar < std::numbers::pi / 2; ++k) {
    way.push_back(dome.at(polar, k * kTurn));
    const double rate = std::hypot(dome.across * std::cos(polar), dome.high * std::sin(polar));
    polar += kSpacing * rope / rate / kParts;
  }
  return way;
}

double lengthOf(const std::vector<CoilStep>& way) {
  double length = 0;
  for (std::size_t k = 1; k < way.size(); ++k) length += (way[k].at - way[k - 1].at).norm();
  return length;
}

}  // namespace

bool layRope(double radius, Braid& braid) {
  braid.steps.clear();
  const double rope = ropeRadius(radius);
  braid.width = 2 * rope;
  if (!(braid.length >= shortestBun(radius))) return false;
  const auto count = static_cast<int>(std::ceil(braid.length / kCoilStep));
  for (int k = 0; k <= count; ++k) {
    const double share = static_cast<double>(k) / count, at = share * braid.length;
    const double end = smoothstep(0, 1, (at - braid.length + kTucked) / kTucked);
    const double now = rope * (1 - (1 - kEnd) * share) * (1 - (1 - kPointed) * end);
    const double phase = 2 * std::numbers::pi * at / (kPitch * rope);
    BraidStep step;
    step.share = static_cast<float>(share);
    step.hold = static_cast<float>(smoothstep(0, 1, at / kComesIn));
    step.phase = static_cast<float>(phase);
    for (int j = 0; j < kBraidStrands; ++j) {
      // As the faces are dealt out: strand 0 begins at 300 degrees, the next at 60.
      const double turn = phase + 2 * std::numbers::pi * (j / 3.0 - 1 / 6.0);
      step.middle[static_cast<std::size_t>(j)] =
          kApart * now * Eigen::Vector2d(std::cos(turn), std::sin(turn)).cast<float>();
    }
    step.half = Eigen::Vector2d(kThick * now, kThick * now).cast<float>();
    step.twist = Eigen::Vector2d(std::cos(phase), std::sin(phase)).cast<float>();
    braid.steps.push_back(step);
  }
  return true;
}

void layBun(const BraidTie& tie, Braid& braid) {
  const double rope = (tie.braided ? kPlaitLies : 0.5) * braid.width;
  double least = kFirst * rope, most = 0.5;  // m: half the dome's width, by bisection
  for (int k = 0; k < 40; ++k) {
    const double across = 0.5 * (least + most);
    (lengthOf(wayOver(domeOf(tie, rope, across), rope)) < braid.length ? least : most) = across;
  }
  const std::vector<CoilStep> way = wayOver(domeOf(tie, rope, least), rope);
  const double scale = lengthOf(way) / braid.length;
  Eigen::Matrix3d frame;
  frame << (braid.mirrored ? -1 : 1) * braid.across, braid.axis.cross(braid.across), braid.axis;
  std::size_t part = 0;
  double passed = 0;
  for (const BraidStep& step : braid.steps) {
    const double at = scale * static_cast<double>(step.share) * braid.length;
    const auto side = [&] { return Vector3d(way[part + 1].at - way[part].at); };
    for (; part + 2 < way.size() && passed + side().norm() < at; ++part) passed += side().norm();
    const double share = std::min(1.0, (at - passed) / side().norm());
    braid.coil.push_back({tie.at + frame * (way[part].at + share * side()), frame * way[part].out});
  }
}

}  // namespace app
