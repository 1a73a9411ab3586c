#pragma once

#include <Eigen/Geometry>

#include "app/motion/motion.h"

namespace app {

// The smallest rotation that takes the direction of `from` to that of `to`; about any normal when they are opposite.
Eigen::Quaterniond leastRotation(const Vec3& from, const Vec3& to);

}  // namespace app
