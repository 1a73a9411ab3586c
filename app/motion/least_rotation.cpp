#include "app/motion/least_rotation.h"

#include <cmath>

namespace app {

Eigen::Quaterniond leastRotation(const Vec3& from, const Vec3& to) {
  const Vec3 a = from.normalized(), b = to.normalized();
  const double cosine = a.dot(b);
  Eigen::Quaterniond turn;
  if (cosine < -1 + 1e-12) {
    turn.w() = 0;
    turn.vec() = a.unitOrthogonal();
  } else {
    const double twice_w = std::sqrt(2 * (1 + cosine));
    turn.w() = 0.5 * twice_w;
    turn.vec() = a.cross(b) * (1 / twice_w);
  }
  return turn;
}

}  // namespace app
