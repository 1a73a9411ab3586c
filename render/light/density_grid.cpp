#include "render/light/density_grid.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace render {
namespace {

using Eigen::Vector3f;
using Eigen::Vector3i;

constexpr float kCell = 0.012f;  // m
constexpr int kMaxNodes = 64;

}  // namespace

void DensityGrid::place(const Bounds& bounds) {
  cell_ = kCell;
  while ((bounds.high - bounds.low).maxCoeff() > static_cast<float>(kMaxNodes - 3) * cell_) cell_ *= 2;
  low_ = (bounds.low / cell_).array().floor().cast<int>() - 1;
  nodes_ = ((bounds.high / cell_).array().floor().cast<int>() + 3).matrix() - low_;
  density_.assign(static_cast<std::size_t>(nodes_.prod()), 0.0f);
}

void DensityGrid::add(const Vector3f& at, float extinction) {
  const Vector3f place = at / cell_ - low_.cast<float>();
  const Vector3i base = place.array().floor().cast<int>().max(0).min(nodes_.array() - 2);
  const Vector3f f = (place - base.cast<float>()).cwiseMax(0.0f).cwiseMin(1.0f);
  const float amount = extinction / (cell_ * cell_ * cell_);
  for (int corner = 0; corner < 4; ++corner) {
    const int dx = corner & 1, dy = corner >> 1;
    const float share = amount * (dx != 0 ? f.x() : 1 - f.x()) * (dy != 0 ? f.y() : 1 - f.y());
    float* node =
        &density_[static_cast<std::size_t>(((base.x() + dx) * nodes_.y() + base.y() + dy) * nodes_.z() + base.z())];
    node[0] += share * (1 - f.z());
    node[1] += share * f.z();
  }
}

float DensityGrid::sample(std::span<const float> values, const Vector3f& at) const {
  const Vector3f place = at / cell_ - low_.cast<float>();
  const Vector3i base = place.array().floor().cast<int>();
  if ((base.array() < 0).any() || (base.array() > nodes_.array() - 2).any()) return 0;
  const Vector3f f = place - base.cast<float>();
  float sum = 0;
  for (int corner = 0; corner < 4; ++corner) {
    const int dx = corner & 1, dy = corner >> 1;
    const float* node =
        &values[static_cast<std::size_t>(((base.x() + dx) * nodes_.y() + base.y() + dy) * nodes_.z() + base.z())];
    sum += (dx != 0 ? f.x() : 1 - f.x()) * (dy != 0 ? f.y() : 1 - f.y()) * ((1 - f.z()) * node[0] + f.z() * node[1]);
  }
  return sum;
}

// From the side that the direction points to, every plane of nodes across its longest axis takes what the plane before
// holds where the ray from a node crosses it, and half of its own and half of that plane's density on the way.
void DensityGrid::sweep(const Vector3f& direction, std::vector<float>& depth) {
  int axis = 0;
  direction.cwiseAbs().maxCoeff(&axis);
  const int across = axis == 0 ? 1 : 0, along = axis == 2 ? 1 : 2;
  const Vector3i strides(nodes_.y() * nodes_.z(), nodes_.z(), 1);
  const Vector3f step = direction / std::abs(direction[axis]);
  const float half = 0.5f * cell_ * step.norm();
  const int j_step = static_cast<int>(std::floor(step[across])), k_step = static_cast<int>(std::floor(step[along]));
  const float fj = step[across] - static_cast<float>(j_step), fk = step[along] - static_cast<float>(k_step);
  const int rows = nodes_[across], columns = nodes_[along], pitch = columns + 3;
  depth.resize(density_.size());
  plane_.assign(static_cast<std::size_t>((rows + 3) * pitch), 0.0f);
  before_ = plane_;
  const bool upwards = direction[axis] > 0;
  for (int n = 0; n < nodes_[axis]; ++n) {
    const int i = upwards ? nodes_[axis] - 1 - n : n;
    for (int j = 0; j < rows; ++j) {
      const float* from = &before_[static_cast<std::size_t>((j + 1 + j_step) * pitch + 1 + k_step)];
      float* to = &plane_[static_cast<std::size_t>((j + 1) * pitch + 1)];
      const std::size_t row = static_cast<std::size_t>(i * strides[axis] + j * strides[across]);
      for (int k = 0; k < columns; ++k) {
        const std::size_t node = row + static_cast<std::size_t>(k * strides[along]);
        const float own = half * density_[node];
        const float reached = own + (1 - fj) * ((1 - fk) * from[k] + fk * from[k + 1]) +
                              fj * ((1 - fk) * from[k + pitch] + fk * from[k + pitch + 1]);
        depth[node] = reached;
        to[k] = reached + own;
      }
    }
    plane_.swap(before_);
  }
}

}  // namespace render
