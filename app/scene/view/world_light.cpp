#include "app/scene/view/world_light.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

namespace app {

render::LightInput lightAbout(const Actor& actor, render::LightInput light) {
  constexpr double kStep = std::numbers::pi / 12;
  const Character& character = actor.body->character;
  const Vec3 forward =
      (character.skeleton.joints[static_cast<std::size_t>(character.head_joint)].rest_world * character.head_frame)
          .linear() *
      Vec3::UnitZ();
  const double turn = kStep * std::round(std::atan2(forward.x(), forward.z()) / kStep);
  if (turn == 0) return light;
  const Eigen::AngleAxisf turned(static_cast<float>(turn), Eigen::Vector3f::UnitY());
  for (render::Float3* towards : {&light.to_light, &light.to_fill, &light.to_rim}) {
    const Eigen::Vector3f way = turned * Eigen::Vector3f((*towards)[0], (*towards)[1], (*towards)[2]);
    *towards = {way.x(), way.y(), way.z()};
  }
  return light;
}

}  // namespace app
