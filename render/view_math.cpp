#include "render/view_math.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace render {

using Eigen::Matrix4f;
using Eigen::Vector3f;

Mat4 asMat4(const Matrix4f& m) {
  Mat4 out;
  std::copy(m.data(), m.data() + 16, out.begin());
  return out;
}

Vector3f directionOr(const Float3& v, const Vector3f& otherwise) {
  const Vector3f direction = asVector(v);
  const float length = direction.norm();
  return std::isfinite(length) && length > 1e-12f ? (direction / length).eval() : otherwise;
}

Matrix4f lookAt(const Vector3f& eye, const Vector3f& target, const Vector3f& up) {
  Vector3f back = eye - target;
  back = back.norm() > 1e-9f ? back.normalized().eval() : Vector3f::UnitZ();
  Vector3f right = up.cross(back);
  right = right.norm() > 1e-6f ? right.normalized().eval() : back.unitOrthogonal();
  const Vector3f above = back.cross(right);
  Matrix4f m = Matrix4f::Identity();
  m.block<1, 3>(0, 0) = right.transpose();
  m.block<1, 3>(1, 0) = above.transpose();
  m.block<1, 3>(2, 0) = back.transpose();
  m.block<3, 1>(0, 3) = Vector3f(-right.dot(eye), -above.dot(eye), -back.dot(eye));
  return m;
}

Matrix4f perspective(float fov_y, float aspect, float near_plane, float far_plane, float shift, float rise) {
  const float f = 1 / std::tan(0.5f * std::clamp(fov_y, 0.01f, 3.0f));
  Matrix4f m = Matrix4f::Zero();
  m(0, 0) = f / aspect;
  m(0, 2) = 0 - shift, m(1, 2) = 0 - rise;  // of -z, which is what clip space divides by
  m(1, 1) = f;
  m(2, 2) = (far_plane + near_plane) / (near_plane - far_plane);
  m(2, 3) = 2 * far_plane * near_plane / (near_plane - far_plane);
  m(3, 2) = -1;
  return m;
}

Matrix4f cameraMatrix(const CameraInput& camera, float aspect) {
  return perspective(camera.fov_y, aspect, camera.near_plane, camera.far_plane, camera.shift, camera.rise) *
         lookAt(asVector(camera.eye), asVector(camera.target), asVector(camera.up));
}

void Bounds::add(const Vector3f& p) {
  low = low.cwiseMin(p);
  high = high.cwiseMax(p);
}

void Bounds::add(const Bounds& other) {
  low = low.cwiseMin(other.low);
  high = high.cwiseMax(other.high);
}

Frustum::Frustum(const Matrix4f& m, float margin) {
  const Eigen::RowVector4f w = m.row(3), wide = (1 + margin) * w;
  planes = {(wide + m.row(0)).transpose(), (wide - m.row(0)).transpose(), (wide + m.row(1)).transpose(),
            (wide - m.row(1)).transpose(), (w + m.row(2)).transpose(),    (w - m.row(2)).transpose()};
}

namespace {

// The largest value of a plane over a box, and the smallest.
float most(const Eigen::Vector4f& plane, const Bounds& box) {
  const Vector3f normal = plane.head<3>();
  return normal.cwiseProduct(box.low).cwiseMax(normal.cwiseProduct(box.high)).sum() + plane.w();
}
float least(const Eigen::Vector4f& plane, const Bounds& box) {
  const Vector3f normal = plane.head<3>();
  return normal.cwiseProduct(box.low).cwiseMin(normal.cwiseProduct(box.high)).sum() + plane.w();
}

}  // namespace

bool Frustum::maySee(const Bounds& box) const {
  return std::all_of(planes.begin(), planes.end(), [&](const auto& plane) { return most(plane, box) >= 0; });
}

bool Frustum::maySeeSwept(const Bounds& box, const Vector3f& along) const {
  return std::all_of(planes.begin(), planes.end(), [&](const auto& plane) {
    return most(plane, box) + std::max(plane.template head<3>().dot(along), 0.0f) >= 0;
  });
}

bool Frustum::seesAllOf(const Bounds& box) const {
  return std::all_of(planes.begin(), planes.end(), [&](const auto& plane) { return least(plane, box) >= 0; });
}

LightFrustum lightFrustum(const Bounds& bounds, const Vector3f& to_light, int texels) {
  const Matrix4f turn =
      lookAt(to_light, Vector3f::Zero(), std::abs(to_light.y()) > 0.9f ? Vector3f::UnitX() : Vector3f::UnitY());
  Bounds seen;
  for (int corner = 0; corner < 8; ++corner) {
    const Vector3f p((corner & 1) ? bounds.high.x() : bounds.low.x(), (corner & 2) ? bounds.high.y() : bounds.low.y(),
                     (corner & 4) ? bounds.high.z() : bounds.low.z());
    seen.add((turn.block<3, 3>(0, 0) * p + turn.block<3, 1>(0, 3)).eval());
  }
  const Vector3f extent = seen.high - seen.low;
  constexpr float kStep = 0.08f;      // m
  constexpr float kSnap = 1.0f / 16;  // of the side
  LightFrustum frustum;
  frustum.side = kStep * (std::floor((1 + kSnap) * std::max(extent.x(), extent.y()) / kStep) + 1);
  frustum.depth = kStep * (std::floor(extent.z() / kStep) + 2);
  // Lines and depths are rounded anew where the frustum moves, so it moves seldom.
  const float snap =
      std::max(std::round(kSnap * static_cast<float>(texels)), 1.0f) * frustum.side / static_cast<float>(texels);
  const auto snapped = [](float at, float to) { return to * std::round(at / to); };
  const float x = snapped(seen.center().x(), snap), y = snapped(seen.center().y(), snap),
              z = snapped(seen.center().z(), 0.5f * kStep);
  Matrix4f fit = Matrix4f::Identity();
  fit(0, 0) = fit(1, 1) = 2 / frustum.side;
  fit(0, 3) = -x * fit(0, 0);
  fit(1, 3) = -y * fit(1, 1);
  // Depth 0 at the light's side of the bounds; view space looks along -z.
  fit(2, 2) = -2 / frustum.depth;
  fit(2, 3) = z * 2 / frustum.depth;
  frustum.clip_from_world = fit * turn;
  return frustum;
}

}  // namespace render
