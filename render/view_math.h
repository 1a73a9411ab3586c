// Cameras and light frusta as matrices.
#pragma once

#include <Eigen/Core>
#include <array>

#include "render/frame_input.h"

namespace render {

inline Eigen::Vector3f asVector(const Float3& v) {
  return Eigen::Vector3f(v[0], v[1], v[2]);
}
inline std::array<float, 4> asVec4(const Float3& v, float w = 0) {
  return {v[0], v[1], v[2], w};
}
inline std::array<float, 4> asVec4(const Eigen::Vector3f& v, float w = 0) {
  return {v.x(), v.y(), v.z(), w};
}
Mat4 asMat4(const Eigen::Matrix4f& m);

// Unit vector; `otherwise` when v has no direction.
Eigen::Vector3f directionOr(const Float3& v, const Eigen::Vector3f& otherwise);

Eigen::Matrix4f lookAt(const Eigen::Vector3f& eye, const Eigen::Vector3f& target, const Eigen::Vector3f& up);
// `shift`, `rise`: half widths and half heights of the picture that the line of sight lies right of and above its
// middle.
Eigen::Matrix4f perspective(float fov_y, float aspect, float near_plane, float far_plane, float shift = 0,
                            float rise = 0);
// World to clip of a camera.
Eigen::Matrix4f cameraMatrix(const CameraInput& camera, float aspect);

struct Bounds {
  Eigen::Vector3f low = Eigen::Vector3f::Constant(1e30f), high = Eigen::Vector3f::Constant(-1e30f);
  bool empty() const { return low.x() > high.x(); }
  void add(const Eigen::Vector3f& p);
  void add(const Bounds& other);
  Eigen::Vector3f center() const { return 0.5f * (low + high); }
  float diagonal() const { return (high - low).norm(); }
};

// Where something can be seen from, as planes whose normals point inwards.
struct Frustum {
  std::array<Eigen::Vector4f, 6> planes;

  // Of a matrix to clip space; widened by `margin`, a share of the picture's half sides.
  Frustum(const Eigen::Matrix4f& clip_from_world, float margin);
  // False only when nothing inside the box can be seen.
  bool maySee(const Bounds& box) const;
  // The same of the box and all places `along` (m) away from it: where its shadow falls.
  bool maySeeSwept(const Bounds& box, const Eigen::Vector3f& along) const;
  bool seesAllOf(const Bounds& box) const;
};

// A square light frustum around bounds.
struct LightFrustum {
  Eigen::Matrix4f clip_from_world = Eigen::Matrix4f::Identity();
  float side = 1, depth = 1;  // m
};
// Orthographic, looking along -to_light; its size grows in steps and it moves by many whole texels at once, so that
// shadows of moving hair do not swim.
LightFrustum lightFrustum(const Bounds& bounds, const Eigen::Vector3f& to_light, int texels);

}  // namespace render
