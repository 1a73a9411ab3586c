#include "render/light/shadow_grid.h"

#include <algorithm>
#include <cmath>

namespace render {

using Eigen::Vector3f;
using shared::kShadowGrid;

void fillShadowGrid(std::span<const shared::vec4> balls, const Vector3f& to_light, shared::ShadowGridBlock& grid) {
  for (shared::ivec4& cell : grid.shadow_grid) cell = {};
  const Vector3f aside = std::abs(to_light.x()) < 0.7f ? Vector3f::UnitX() : Vector3f::UnitZ();
  const Vector3f right = aside.cross(to_light).normalized(), up = to_light.cross(right);
  const auto middle = [&](const shared::vec4& ball, const Vector3f& axis) {
    return axis.dot(Vector3f(ball[0], ball[1], ball[2]));
  };
  // Rounding on the GPU is of another order: a little wider than the balls.
  const auto radius = [](const shared::vec4& ball) { return 1.001f * ball[3] + 1e-3f; };
  const auto fit = [&](const Vector3f& axis) -> shared::vec4 {
    float low = 0, high = 0;
    for (const shared::vec4& ball : balls) {
      const bool first = &ball == &balls.front();
      const float at = middle(ball, axis), reach = radius(ball);
      low = first ? at - reach : std::min(low, at - reach);
      high = first ? at + reach : std::max(high, at + reach);
    }
    const float cells = static_cast<float>(kShadowGrid) / std::max(high - low, 1e-3f);
    return {axis.x() * cells, axis.y() * cells, axis.z() * cells, -low * cells};
  };
  grid.shadow_grid_x = fit(right);
  grid.shadow_grid_y = fit(up);
  const auto range = [&](const shared::vec4& axis, const shared::vec4& ball) -> std::array<int, 2> {
    const Vector3f along(axis[0], axis[1], axis[2]);
    const float at = middle(ball, along) + axis[3], reach = radius(ball) * along.norm();
    const auto cell = [](float x) { return std::clamp(static_cast<int>(std::floor(x)), 0, kShadowGrid - 1); };
    return {cell(at - reach), cell(at + reach)};
  };
  for (std::size_t map = 0; map < balls.size(); ++map) {
    const std::array<int, 2> x = range(grid.shadow_grid_x, balls[map]), y = range(grid.shadow_grid_y, balls[map]);
    const auto bit = static_cast<int>(1u << (map % 32));
    for (int j = y[0]; j <= y[1]; ++j) {
      for (int i = x[0]; i <= x[1]; ++i)
        grid.shadow_grid[static_cast<std::size_t>(j * kShadowGrid + i)][map / 32] |= bit;
    }
  }
}

}  // namespace render
