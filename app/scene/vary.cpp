#include "app/scene/vary.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <string_view>

namespace app {

namespace {

constexpr double kLightSpeed = 2.5;  // rad over the picture's height
constexpr double kHighest = 87 * std::numbers::pi / 180;

}  // namespace

void varyMaterial(double amount, std::uint64_t seed, sim::SimParams& params) {
  std::mt19937_64 draw(seed);
  for (const sim::ParamField& row : sim::paramFields()) {
    if (std::string_view(row.group) != "Material" || row.kind != sim::FieldKind::kReal) continue;
    // The library's distributions differ between libraries.
    const double share = amount * (static_cast<double>(draw() >> 11) * 0x1p-52 - 1);
    const double value = row.get(params);
    const double moved = row.logarithmic ? value * std::pow(10.0, share)
                                         : value + share * 0.5 * (row.maximum - row.minimum);
    row.set(params, std::clamp(moved, row.minimum, row.maximum));
  }
}

render::Float3 turnedLight(const render::Float3& to_light, double dx, double dy, double height) {
  const Vec3 way = Vec3(to_light[0], to_light[1], to_light[2]);
  const double length = std::max(1e-6, way.norm());
  const double heading = std::atan2(way.x(), way.z()) + kLightSpeed * dx / height;
  const double rise =
      std::clamp(std::asin(std::clamp(way.y() / length, -1.0, 1.0)) - kLightSpeed * dy / height, -kHighest, kHighest);
  const double flat = std::cos(rise);
  return {static_cast<float>(flat * std::sin(heading)), static_cast<float>(std::sin(rise)),
          static_cast<float>(flat * std::cos(heading))};
}

}  // namespace app
