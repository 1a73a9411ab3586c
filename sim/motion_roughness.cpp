#include "sim/motion_roughness.h"

#include <algorithm>
#include <cmath>

namespace sim {

MotionRoughness::MotionRoughness(const HairMesh& mesh)
    : velocity_(mesh.vertexCount(), Vec3::Zero()), change_(mesh.vertexCount(), Vec3::Zero()) {}

double MotionRoughness::at(const HairMesh& mesh, std::span<const Vec3> velocities) {
  double first = 0, second = 0;
  for (int i = 0; i < mesh.vertexCount(); ++i) {
    const Vec3 change = velocities[i] - velocity_[i];
    if (!mesh.isRoot(i)) {
      first += mesh.vertex_volume[i] * change.squaredNorm();
      second += mesh.vertex_volume[i] * (change - change_[i]).squaredNorm();
    }
    change_[i] = change;
    velocity_[i] = velocities[i];
  }
  steps_ = std::min(steps_ + 1, 3);
  return steps_ == 3 && first > 0 ? std::sqrt(second / first) : 0;
}

double toleranceFactor(double roughness, double slack) {
  const double factor = 1 + slack * std::max(0.0, roughness - kSmooth);
  return std::isfinite(factor) ? std::min(factor, kMostSlack) : 1;
}

}  // namespace sim
