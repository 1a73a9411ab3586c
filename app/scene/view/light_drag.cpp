#include "app/scene/view/light_drag.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace app {

namespace {

constexpr double kLightSpeed = 2.5;  // rad over the picture's height
constexpr double kHighest = 87 * std::numbers::pi / 180;

}  // namespace

render::Float3 turnedLight(const render::Float3& to_light, double dx, double dy, double height) {
  const Eigen::Vector3d way(to_light[0], to_light[1], to_light[2]);
  const double length = std::max(1e-6, way.norm());
  const double heading = std::atan2(way.x(), way.z()) + kLightSpeed * dx / height;
  const double rise =
      std::clamp(std::asin(std::clamp(way.y() / length, -1.0, 1.0)) - kLightSpeed * dy / height, -kHighest, kHighest);
  const double flat = std::cos(rise);
  return {static_cast<float>(flat * std::sin(heading)), static_cast<float>(std::sin(rise)),
          static_cast<float>(flat * std::cos(heading))};
}

}  // namespace app
