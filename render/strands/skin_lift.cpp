#include "render/strands/skin_lift.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>

#include "render/strands/shader_math.h"
#include "shaders/shared.h"

namespace render {

using Eigen::Vector3f;
using Eigen::Vector4f;
using shared::kSkinBack, shared::kSkinBlend, shared::kSkinGap, shared::kSkinLeft, shared::kSkinFar, shared::kSkinMiddle,
    shared::kSkinReturn, shared::kSkinRounds, shared::kSkinTurns, shared::kSkinWhole;

float liftsWithin(const SkinEllipsoid& skin) {
  float steep = 0;
  for (const auto& row : skin.to_ball) steep += row[0] * row[0] + row[1] * row[1] + row[2] * row[2];
  const float reach = 1 + (kSkinGap + kSkinBlend) * std::sqrt(steep);
  return std::min(1.001f * reach * reach, kSkinFar);
}

namespace {

// The way out of a piece of skin for a point at a gap (m, signed) from it.
struct WayOut {
  float gap, share;        // share: of the way that is taken
  Vector3f along, normal;  // normal: shorter where sides meet
};

Vector3f turnedBack(const std::array<std::array<float, 4>, 3>& rows, const Vector3f& v) {
  const auto row = [&](int k) { return Eigen::Map<const Vector3f>(rows[static_cast<std::size_t>(k)].data()); };
  return v.x() * row(0) + v.y() * row(1) + v.z() * row(2);
}

// back: the way that the strand's point before was lifted, which leads in the middle (shaders/common/skin.glsl). line:
// a unit vector that the way follows, or zero.
std::optional<WayOut> wayOutOf(const SkinEllipsoid& e, const Vector3f& point, const Vector3f& back,
                               const Vector3f& line, float blend) {
  const Eigen::Map<const Vector4f> a(e.to_ball[0].data()), b(e.to_ball[1].data()), c(e.to_ball[2].data());
  const Vector4f p = point.homogeneous();
  const Vector3f ball(a.dot(p), b.dot(p), c.dot(p));
  const float squared = ball.squaredNorm();
  if (squared > kSkinFar || squared > liftsWithin(e)) return {};
  const Vector3f from = ball + std::max(1.0f - squared, 0.0f) * Eigen::Map<const Vector3f>(e.home.data());
  const float off = from.squaredNorm();
  Vector3f leads =
      std::sqrt(off) * turnedBack(e.to_ball, from).normalized() + (1 - smoothstep(kSkinMiddle, kSkinWhole, off)) * back;
  if (!line.isZero(0)) leads = line;
  const float sure = leads.squaredNorm();
  if (sure < kSkinMiddle) return {};
  const Vector3f out_of = leads / std::sqrt(sure);
  const Vector3f pace(a.head<3>().dot(out_of), b.head<3>().dot(out_of), c.head<3>().dot(out_of));
  const float along = ball.dot(pace), paces = pace.squaredNorm();
  const float surface = (std::sqrt(std::max(along * along + paces * (1.0f - squared), 0.0f)) - along) / paces;
  const float gap = -surface - kSkinGap;
  if (gap >= blend) return {};
  return WayOut{gap, smoothstep(kSkinMiddle, kSkinWhole, sure), out_of,
                turnedBack(e.to_ball, ball + surface * pace).normalized()};
}

std::optional<WayOut> wayOutOf(const SkinGrid& grid, const Vector3f& point, const Vector3f& back, float blend) {
  const Vector4f p = point.homogeneous();
  Vector3f f;
  std::array<int, 3> cell;
  for (std::size_t k = 0; k < 3; ++k) {
    const float at = Eigen::Map<const Vector4f>(grid.to_nodes[k].data()).dot(p);
    if (!(at >= 0.0f && at < static_cast<float>(grid.nodes[k] - 1))) return {};
    cell[k] = static_cast<int>(at);
    f[static_cast<int>(k)] = at - static_cast<float>(cell[k]);
  }
  const int row = grid.nodes[0], sheet = row * grid.nodes[1];
  const auto first = static_cast<std::size_t>(cell[0] + row * cell[1] + sheet * cell[2]);
  const auto at = [&](int dx, int dy, int dz) {
    return grid.distances[first + static_cast<std::size_t>(dx + row * dy + sheet * dz)];
  };
  // Of the four edges along x: values and slopes.
  const Vector4f low(at(0, 0, 0), at(0, 1, 0), at(0, 0, 1), at(0, 1, 1));
  const Vector4f rise = Vector4f(at(1, 0, 0), at(1, 1, 0), at(1, 0, 1), at(1, 1, 1)) - low;
  const Vector4f edge = low + f.x() * rise;
  const float near = edge[0] + f.y() * (edge[1] - edge[0]), far = edge[2] + f.y() * (edge[3] - edge[2]);
  const float gap = near + f.z() * (far - near) - kSkinGap;
  if (gap >= blend - kSkinLeft) return {};
  const float slope_near = rise[0] + f.y() * (rise[1] - rise[0]), slope_far = rise[2] + f.y() * (rise[3] - rise[2]);
  const float across = edge[1] - edge[0], slope_y = across + f.z() * (edge[3] - edge[2] - across);
  const Vector3f slope =
      turnedBack(grid.to_nodes, {slope_near + f.z() * (slope_far - slope_near), slope_y, far - near});
  const float steep = slope.squaredNorm();
  const float clear = smoothstep(kSkinMiddle, kSkinWhole, steep);
  const Vector3f leads = slope + (1 - clear) * back;
  const float sure = leads.squaredNorm();
  if (sure < kSkinMiddle) return {};
  return WayOut{gap, smoothstep(kSkinMiddle, kSkinWhole, sure), leads / std::sqrt(sure),
                clear / std::sqrt(std::max(steep, kSkinMiddle)) * slope};
}

}  // namespace

void leaveSkin(std::span<const SkinEllipsoid> skin, std::span<const SkinGrid> grids, float s, SkinLift& lift,
               Vector3f& position, Vector3f& tangent) {
  const Vector3f free = position;
  if (skin.empty() && grids.empty() && lift.by.isZero(0)) {
    lift.free = free;
    return;
  }
  lift.by *= std::exp(-(free - lift.free).norm() / kSkinReturn);
  const Vector3f back = lift.by / (lift.by.norm() + kSkinBack), back_in_grid = back - (1 - back.norm()) * tangent;
  position += lift.by;
  tangent -= lift.by / kSkinReturn;
  Vector3f lifted = position, turned = tangent;
  Vector3f by_grids = Vector3f::Zero(), together = by_grids, line = by_grids;
  bool moved = true;
  const SkinEllipsoid* last = nullptr;
  for (int round = 0; round < kSkinRounds && moved; ++round) {
    moved = false;
    const float blend = round == 0 ? kSkinBlend : 0.0f;
    if (round == kSkinTurns && together.squaredNorm() > kSkinMiddle) line = together.normalized();
    together.setZero();
    // Returns what it is moved by.
    const auto take = [&](const WayOut& way) -> Vector3f {
      const float bent = std::max(way.gap + blend, 0.0f) / (2 * kSkinBlend);
      const Vector3f by = way.share * (kSkinBlend * bent * bent - way.gap) * way.along;
      lifted += by;
      together += way.along;
      turned += way.share * (bent - 1) * way.normal.dot(turned) * way.normal;
      moved = true;
      return by;
    };
    for (const SkinEllipsoid& e : skin) {
      const auto way = &e == last ? std::nullopt : wayOutOf(e, lifted, back, line, blend);
      if (!way) continue;
      take(*way);
      last = &e;
    }
    for (const SkinGrid& grid : grids) {
      const auto way = wayOutOf(grid, lifted, back_in_grid, blend);
      if (!way) continue;
      by_grids += take(*way);
      last = nullptr;
    }
  }
  const float root = smoothstep(0.0f, 1.0f, s);
  position += root * (lifted - position) + (1 - root) * by_grids;
  tangent += root * (turned - tangent);
  lift = {free, position - free};
}

Eigen::AlignedBox3f liftingBox(const SkinEllipsoid& skin) {
  // A row's length is one over the radius along its axis.
  Vector3f center = Vector3f::Zero(), reach = Vector3f::Zero();
  for (const auto& row : skin.to_ball) {
    const Vector3f along(row[0], row[1], row[2]);
    const float squared = std::max(along.squaredNorm(), 1e-12f);
    center -= row[3] / squared * along;
    reach += (along / squared).cwiseAbs2();
  }
  reach = reach.cwiseSqrt().array() + kSkinGap + kSkinBlend;
  return {center - reach, center + reach};
}

std::vector<SkinEllipsoid> skinNear(std::span<const SkinEllipsoid> skin, const Vector3f& low, const Vector3f& high) {
  const Eigen::AlignedBox3f box(low, high);
  std::vector<SkinEllipsoid> near;
  for (const SkinEllipsoid& e : skin) {
    if (static_cast<int>(near.size()) < shared::kMaxSkin && liftingBox(e).intersects(box)) near.push_back(e);
  }
  return near;
}

SkinAround::SkinAround(std::span<const SkinEllipsoid> skin, std::span<const SkinGrid> skin_grids)
    : ellipsoids(skin.begin(), skin.end()), grids(skin_grids.begin(), skin_grids.end()) {
  for (const SkinEllipsoid& e : skin) boxes.push_back(liftingBox(e));
}

SkinAround SkinAround::near(const Eigen::AlignedBox3f& strand) const {
  const Vector3f room = Vector3f::Constant(kMostLifted);
  const Eigen::AlignedBox3f box(strand.min() - room, strand.max() + room);
  SkinAround near;
  for (std::size_t i = 0; i < ellipsoids.size(); ++i) {
    if (boxes[i].intersects(box)) near.ellipsoids.push_back(ellipsoids[i]);
  }
  near.grids = skinNear(grids, box.min(), box.max());
  return near;
}

bool meetsBox(const SkinGrid& grid, const Vector3f& middle, const Vector3f& half) {
  for (std::size_t k = 0; k < 3; ++k) {
    const Eigen::Map<const Vector4f> row(grid.to_nodes[k].data());
    const float at = row.dot(middle.homogeneous()), reach = row.head<3>().cwiseAbs().dot(half);
    if (at + reach < 0 || at - reach > static_cast<float>(grid.nodes[k] - 1)) return false;
  }
  return true;
}

std::vector<SkinGrid> skinNear(std::span<const SkinGrid> grids, const Vector3f& low, const Vector3f& high) {
  std::vector<SkinGrid> near;
  for (const SkinGrid& grid : grids)
    if (static_cast<int>(near.size()) < shared::kMaxSkinGrids &&
        meetsBox(grid, 0.5f * (low + high), 0.5f * (high - low)))
      near.push_back(grid);
  return near;
}

}  // namespace render
