// Between two directions.
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <type_traits>

namespace render {

// The smallest rotation that takes one unit vector to another; about any normal when they are opposite. As Eigen's
// FromTwoVectors, whose singular value decomposition takes seconds to compile wherever it is used.
template <class T>
Eigen::Quaternion<T> leastRotation(const Eigen::Matrix<T, 3, 1>& from, const Eigen::Matrix<T, 3, 1>& to) {
  constexpr T kOpposite = std::is_same_v<T, float> ? T(1e-5) : T(1e-12);
  const T cosine = from.dot(to);
  Eigen::Quaternion<T> turn;
  if (cosine < -1 + kOpposite) {
    turn.w() = 0;
    turn.vec() = from.unitOrthogonal();
  } else {
    const T twice_w = std::sqrt(2 * (1 + cosine));
    turn.w() = T(0.5) * twice_w;
    turn.vec() = from.cross(to) * (1 / twice_w);
  }
  return turn;
}

}  // namespace render
