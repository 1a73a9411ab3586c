#include "app/motion/least_rotation.h"

#include "render/strands/least_rotation.h"

namespace app {

Eigen::Quaterniond leastRotation(const Vec3& from, const Vec3& to) {
  return render::leastRotation<double>(from.normalized(), to.normalized());
}

}  // namespace app
