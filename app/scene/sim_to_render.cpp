#include "app/scene/sim_to_render.h"

#include <algorithm>
#include <cmath>

namespace app {

Vec3 pictureOrigin(const Vec3& anchor) {
  constexpr double kGrid = 64;  // m
  return kGrid * Vec3(std::round(anchor.x() / kGrid), 0, std::round(anchor.z() / kGrid));
}

bool blendPositions(std::span<const sim::Vec3> from, std::span<const sim::Vec3> to, double fraction, const Vec3& origin,
                    std::vector<float>& floats) {
  bool changed = floats.size() != 3 * to.size();
  floats.resize(3 * to.size());
  for (std::size_t i = 0; i < to.size(); ++i) {
    const sim::Vec3 p = fraction == 1 ? to[i] : sim::Vec3(from[i] + fraction * (to[i] - from[i]));
    for (int k = 0; k < 3; ++k) {
      const float value = static_cast<float>(p[k] - origin[k]);
      changed = changed || floats[3 * i + k] != value;
      floats[3 * i + k] = value;
    }
  }
  return changed;
}

namespace {

Rigid blend(const Rigid& from, const Rigid& to, double fraction) {
  const Eigen::Quaterniond a(from.linear()), b(to.linear());
  const Vec3 translation = from.translation() + fraction * (to.translation() - from.translation());
  return Eigen::Translation3d(translation) * a.slerp(fraction, b);
}

bool same(const Pose& a, const Pose& b) {
  const auto equal = [](const Rigid& x, const Rigid& y) { return x.matrix() == y.matrix(); };
  return std::equal(a.world.begin(), a.world.end(), b.world.begin(), b.world.end(), equal);
}

}  // namespace

void blendPoses(const Skeleton& skeleton, int head, const Pose& from, const Pose& to, double fraction, Pose& pose) {
  pose.world.resize(to.world.size());
  if (fraction == 1 || same(from, to)) {
    std::copy(to.world.begin(), to.world.end(), pose.world.begin());
    return;
  }
  for (std::size_t j = 0; j < to.world.size(); ++j) {
    const int parent = skeleton.joints[j].parent;
    if (parent < 0) {
      pose.world[j] = blend(from.world[j], to.world[j], fraction);
      continue;
    }
    const auto p = static_cast<std::size_t>(parent);
    pose.world[j] = pose.world[p] * blend(from.world[p].inverse(Eigen::Isometry) * from.world[j],
                                          to.world[p].inverse(Eigen::Isometry) * to.world[j], fraction);
  }
  const auto h = static_cast<std::size_t>(head);
  const Rigid held = blend(from.world[h], to.world[h], fraction) * pose.world[h].inverse(Eigen::Isometry);
  for (Rigid& joint : pose.world) joint = held * joint;
}

bool jointMatrices(const Skeleton& skeleton, const Pose& pose, const Vec3& origin,
                   std::vector<render::Mat4>& matrices) {
  bool changed = matrices.size() != pose.world.size();
  matrices.resize(pose.world.size());
  for (std::size_t j = 0; j < pose.world.size(); ++j) {
    Rigid carried = pose.world[j] * skeleton.joints[j].rest_world.inverse(Eigen::Isometry);
    carried.translation() -= origin;
    const Eigen::Matrix4f m = carried.matrix().cast<float>();
    changed = changed || !std::equal(m.data(), m.data() + 16, matrices[j].begin());
    std::copy(m.data(), m.data() + 16, matrices[j].begin());
  }
  return changed;
}

namespace {

constexpr double kHome = 3;          // in an ellipsoid's measure, see render::SkinEllipsoid
constexpr double kHeadWithin = 1.1;  // the same: one that holds the head's middle, or nearly
constexpr double kFree = 0.2;  // in the measure of the head's ellipsoids: the way to the head that far off is free

// m, an ellipsoid's least radius: limbs lead strands to the head, sheets of skin do not, for the way runs under the
// skin.
constexpr double kSheet = 0.015, kLimb = 0.03;

std::vector<sim::Ellipsoid> headEllipsoids(const Character& character, const Pose& pose) {
  std::vector<sim::Ellipsoid> all;
  for (const BodyEllipsoid& e : character.ellipsoids)
    if (e.joint == character.head_joint) poseEllipsoid(e, pose, pose, 0, all.emplace_back());
  return all;
}

// 0 where the way out of an ellipsoid to the head (in the ellipsoid's measure) ends in the head's own ones, as the
// neck's does; 1 where it ends clear of them.
double freeWayTo(std::span<const sim::Ellipsoid> head, const sim::Ellipsoid& e, const Vec3& home) {
  const Vec3 end = e.center + e.rotation * Vec3(e.radii.cwiseProduct(home.stableNormalized()));
  double clear = kFree;
  for (const sim::Ellipsoid& part : head)
    clear = std::min(clear, (part.rotation.conjugate() * (end - part.center)).cwiseQuotient(part.radii).norm() - 1);
  return std::clamp(clear / kFree, 0.0, 1.0);
}

// Hair comes from the head: around an ellipsoid that holds the head it comes from all sides.
render::SkinEllipsoid skinEllipsoid(const sim::Ellipsoid& e, std::span<const sim::Ellipsoid> head_parts,
                                    const Vec3& head, const Vec3& origin) {
  render::SkinEllipsoid skin;
  const Eigen::Matrix3d to_ball = e.radii.cwiseInverse().asDiagonal() * e.rotation.conjugate().toRotationMatrix();
  const Vec3 middle = to_ball * (e.center - origin);
  for (int row = 0; row < 3; ++row) {
    for (int k = 0; k < 3; ++k) skin.to_ball[row][k] = static_cast<float>(to_ball(row, k));
    skin.to_ball[row][3] = static_cast<float>(-middle[row]);
  }
  const Vec3 home = to_ball * (head - e.center);
  const double thick = std::clamp((e.radii.minCoeff() - kSheet) / (kLimb - kSheet), 0.0, 1.0);
  const double off = thick * std::clamp(home.norm() - kHeadWithin, 0.0, 1.0) * freeWayTo(head_parts, e, home);
  Eigen::Map<Eigen::Vector3f>(skin.home.data()) = (kHome * off * home.stableNormalized()).cast<float>();
  return skin;
}

render::SkinGrid skinGrid(const PartDistance& part, const Pose& pose, const Vec3& origin) {
  render::SkinGrid skin;
  skin.id = part.id;
  skin.nodes = part.grid.n;
  skin.distances = part.grid.distance;
  const Rigid from_world = pose.world[static_cast<std::size_t>(part.joint)].inverse(Eigen::Isometry);
  const Eigen::Matrix3d turn = from_world.linear() / part.grid.h;
  const Vec3 at = (from_world * origin - part.grid.low) / part.grid.h;
  for (int row = 0; row < 3; ++row) {
    for (int k = 0; k < 3; ++k) skin.to_nodes[row][k] = static_cast<float>(turn(row, k));
    skin.to_nodes[row][3] = static_cast<float>(at[row]);
  }
  return skin;
}

}  // namespace

void showSkin(const Character& character, std::span<const PartDistance> unfit_parts, const Pose& pose,
              const Vec3& origin, ShownSkin& skin) {
  skin.ellipsoids.clear();
  const Vec3 head = scalpToWorld(character, pose) * character.scalp.center;
  const std::vector<sim::Ellipsoid> head_parts = headEllipsoids(character, pose);
  for (const BodyEllipsoid& part : character.ellipsoids) {
    if (part.by_distances) continue;
    sim::Ellipsoid e;
    poseEllipsoid(part, pose, pose, 0, e);
    skin.ellipsoids.push_back(skinEllipsoid(e, head_parts, head, origin));
  }
  for (const BodyEllipsoid& part : character.nose) {
    sim::Ellipsoid e;
    poseEllipsoid(part, pose, pose, 0, e);
    skin.ellipsoids.push_back(skinEllipsoid(e, head_parts, head, origin));
  }
  skin.grids.clear();
  for (const PartDistance& part : unfit_parts) skin.grids.push_back(skinGrid(part, pose, origin));
}

render::Float3 toFloat3(const Vec3& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

}  // namespace app
