#include "render/strands/skin_lift.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "render/strands/shader_math.h"
#include "shaders/shared.h"

namespace render {

using Eigen::Vector3f;
using Eigen::Vector4f;
using shared::kSkinBlend, shared::kSkinGap, shared::kSkinFar, shared::kSkinMiddle, shared::kSkinWhole;

void leaveSkin(std::span<const SkinEllipsoid> skin, float s, Vector3f& position, Vector3f& tangent) {
  const float root = smoothstep(0.0f, 1.0f, s);
  bool lifted = true;
  for (int round = 0; round < 2 && lifted; ++round) {
    lifted = false;
    for (const SkinEllipsoid& e : skin) {
      const Eigen::Map<const Vector4f> a(e.to_ball[0].data()), b(e.to_ball[1].data()), c(e.to_ball[2].data());
      const Vector4f p = position.homogeneous();
      const Vector3f ball(a.dot(p), b.dot(p), c.dot(p));
      const float squared = ball.squaredNorm();
      if (squared > kSkinFar || squared < kSkinMiddle) continue;
      const Vector3f slope = ball.x() * a.head<3>() + ball.y() * b.head<3>() + ball.z() * c.head<3>();
      const float far = std::sqrt(squared), steep = slope.norm();
      const float gap = far * (far - 1.0f) / steep - kSkinGap;
      if (gap >= kSkinBlend) continue;
      const float x = std::max(gap + kSkinBlend, 0.0f), share = root * smoothstep(kSkinMiddle, kSkinWhole, squared);
      const Vector3f normal = slope / steep;
      position += share * (x * x / (4.0f * kSkinBlend) - gap) * normal;
      tangent += share * (x / (2.0f * kSkinBlend) - 1.0f) * normal.dot(tangent) * normal;
      lifted = true;
    }
  }
}

std::vector<SkinEllipsoid> skinNear(std::span<const SkinEllipsoid> skin, const Vector3f& low, const Vector3f& high) {
  std::vector<SkinEllipsoid> near;
  for (const SkinEllipsoid& e : skin) {
    // A row's length is one over the radius along its axis.
    Vector3f center = Vector3f::Zero(), reach = Vector3f::Zero();
    for (const auto& row : e.to_ball) {
      const Vector3f along(row[0], row[1], row[2]);
      const float squared = std::max(along.squaredNorm(), 1e-12f);
      center -= row[3] / squared * along;
      reach += (along / squared).cwiseAbs2();
    }
    // Of the box around the ellipsoid.
    reach = reach.cwiseSqrt().array() + kSkinGap + kSkinBlend;
    const bool apart =
        ((center + reach).array() < low.array()).any() || ((center - reach).array() > high.array()).any();
    if (!apart && static_cast<int>(near.size()) < shared::kMaxSkin) near.push_back(e);
  }
  return near;
}

}  // namespace render
