// Cameras and light frusta as matrices.
#pragma once

#include <Eigen/Core>

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
Eigen::Matrix4f perspective(float fov_y, float aspect, float near_plane, float far_plane);
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

// A square light frustum around bounds.
struct LightFrustum {
  Eigen::Matrix4f clip_from_world = Eigen::Matrix4f::Identity();
  float side = 1, depth = 1;  // m
};
// Orthographic, looking along -to_light; its size grows in steps and it moves by whole texels, so that shadows of
// moving hair do not swim.
LightFrustum lightFrustum(const Bounds& bounds, const Eigen::Vector3f& to_light, int texels);

}  // namespace render
