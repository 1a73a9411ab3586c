#include "render/strands/skin_lift.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "render/strands/shader_math.h"
#include "shaders/shared.h"

namespace render {

using Eigen::Vector3f;
using Eigen::Vector4f;
using shared::kSkinBlend, shared::kSkinGap, shared::kSkinFar, shared::kSkinMiddle, shared::kSkinReturn,
    shared::kSkinRounds, shared::kSkinWhole;

void leaveSkin(std::span<const SkinEllipsoid> skin, float s, SkinLift& lift, Vector3f& position, Vector3f& tangent) {
  const Vector3f free = position;
  if (skin.empty() && lift.by.isZero(0)) {
    lift.free = free;
    return;
  }
  lift.by *= std::exp(-(free - lift.free).norm() / kSkinReturn);
  position += lift.by;
  tangent -= lift.by / kSkinReturn;
  Vector3f lifted = position, turned = tangent;
  bool moved = true;
  const SkinEllipsoid* last = nullptr;
  for (int round = 0; round < kSkinRounds && moved; ++round) {
    moved = false;
    const float blend = round == 0 ? kSkinBlend : 0.0f;
    for (const SkinEllipsoid& e : skin) {
      if (&e == last) continue;
      const Eigen::Map<const Vector4f> a(e.to_ball[0].data()), b(e.to_ball[1].data()), c(e.to_ball[2].data());
      const Vector4f p = lifted.homogeneous();
      const Vector3f ball(a.dot(p), b.dot(p), c.dot(p));
      const float squared = ball.squaredNorm();
      if (squared > kSkinFar) continue;
      const Vector3f from = ball + std::max(1.0f - squared, 0.0f) * Eigen::Map<const Vector3f>(e.home.data());
      const float off = from.squaredNorm();
      if (off < kSkinMiddle) continue;
      const auto toWorld = [&](const Vector3f& v) -> Vector3f {
        return (v.x() * a.head<3>() + v.y() * b.head<3>() + v.z() * c.head<3>()).normalized();
      };
      const Vector3f out_of = toWorld(from);
      const Vector3f pace(a.head<3>().dot(out_of), b.head<3>().dot(out_of), c.head<3>().dot(out_of));
      const float along = ball.dot(pace), paces = pace.squaredNorm();
      const float surface = (std::sqrt(std::max(along * along + paces * (1.0f - squared), 0.0f)) - along) / paces;
      const float gap = -surface - kSkinGap;
      if (gap >= blend) continue;
      const float share = smoothstep(kSkinMiddle, kSkinWhole, off),
                  bent = std::max(gap + blend, 0.0f) / (2 * kSkinBlend);
      const Vector3f normal = toWorld(ball + surface * pace);
      lifted += share * (kSkinBlend * bent * bent - gap) * out_of;
      turned += share * (bent - 1) * normal.dot(turned) * normal;
      moved = true;
      last = &e;
    }
  }
  const float root = smoothstep(0.0f, 1.0f, s);
  position += root * (lifted - position);
  tangent += root * (turned - tangent);
  lift = {free, position - free};
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
