#include "app/scene/view/world_light.h"

#include <Eigen/Geometry>

namespace app {

render::LightInput lightAbout(const Actor& actor, render::LightInput light) {
  if (actor.front == 0) return light;
  const Eigen::AngleAxisf turned(static_cast<float>(actor.front), Eigen::Vector3f::UnitY());
  for (render::Float3* towards : {&light.to_light, &light.to_fill, &light.to_rim}) {
    const Eigen::Vector3f way = turned * Eigen::Vector3f((*towards)[0], (*towards)[1], (*towards)[2]);
    *towards = {way.x(), way.y(), way.z()};
  }
  return light;
}

}  // namespace app
