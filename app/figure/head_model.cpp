#include "app/figure/head_model.h"

#include <cmath>

#include "app/groom/inspect/groom_shape.h"

namespace app {

HeadModel headModelOf(const Character& character) {
  // The skull where hair grows: above the ears and behind the face.
  std::vector<Eigen::Vector3f> skull;
  for (int n = 0; n < 400; ++n) {
    const double height = -0.2 + 1.2 * n / 400, azimuth = 2.39996 * n, level = std::sqrt(1 - height * height);
    const Vec3 direction(level * std::sin(azimuth), height, level * std::cos(azimuth));
    if (direction.z() > 0.35 && direction.y() < 0.75) continue;
    skull.push_back((character.scalp.center + character.scalp.radiusAt(direction) * direction).cast<float>());
  }
  const BodyDistance body = restBodyDistance(character);
  const Eigen::Vector3f center = fitSphere(skull).center;
  const Rigid to_world = scalpToWorld(character, restPose(character.skeleton));
  return {[body](const Eigen::Vector3f& p) { return static_cast<float>(body(p.cast<double>())); }, center,
          Eigen::Vector3f((to_world * center.cast<double>()).cast<float>())};
}

}  // namespace app
