#include "app/styles/ring_way.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace app {

Vec3 sourceOf(const Vec3& end, int side) {
  constexpr double kBare = 0.5;        // rad about the face's middle, a margin to the hairline left out
  constexpr double kOtherSide = 0.35;  // x of a direction that hair of the other side is far from
  const Vec3 face = Vec3(0, -0.47, 0.88).normalized();  // its middle
  const Vec3 opposite = -end;
  const auto off = [&](const Vec3& direction) { return std::acos(std::clamp(direction.dot(face), -1.0, 1.0)); };
  const bool bare = off(opposite) <= kBare || (side != 0 && -side * opposite.x() >= kOtherSide);
  if (bare || off(end) < 2 * kBare) return opposite;
  const Vec3 along = (opposite - opposite.dot(face) * face).normalized();
  return std::cos(kBare) * face + std::sin(kBare) * along;
}

RingWay::RingWay(const Vec3& from, const Vec3& to, const Vec3& source) : first_(from) {
  const Vec3 across = (from - to).cross(source - to);
  if (across.norm() < 1e-9) return;
  const Vec3 n = across.normalized();
  middle_ = n.dot(to) * n;
  first_ = from - middle_;
  beside_ = n.cross(first_);
  const auto turnTo = [&](const Vec3& p) {
    const double turn = std::atan2((p - middle_).dot(beside_), (p - middle_).dot(first_));
    return turn < 0 ? turn + 2 * std::numbers::pi : turn;
  };
  angle_ = turnTo(to);
  if (turnTo(source) < angle_) angle_ -= 2 * std::numbers::pi;
}

Vec3 RingWay::at(double share) const {
  return (middle_ + std::cos(share * angle_) * first_ + std::sin(share * angle_) * beside_).normalized();
}

double RingWay::length() const {
  return std::abs(angle_) * first_.norm();
}

bool RingWay::great() const {
  return middle_.norm() < 1e-3;
}

}  // namespace app
