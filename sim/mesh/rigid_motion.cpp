#include "sim/mesh/rigid_motion.h"

#include <Eigen/SVD>
#include <algorithm>

namespace sim {
namespace {

// rigidMotion of so many points.
Eigen::Isometry3d motionOf(int count, const auto& from, const auto& to) {
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  Vec3 from_center = Vec3::Zero(), to_center = Vec3::Zero();
  for (int i = 0; i < count; ++i) from_center += from(i) / count, to_center += to(i) / count;
  Eigen::Matrix3d moment = Eigen::Matrix3d::Zero();
  for (int i = 0; i < count; ++i) moment += (to(i) - to_center) * (from(i) - from_center).transpose();
  if (!moment.allFinite()) return motion;
  motion.linear() = nearestRotation(moment);
  motion.translation() = to_center - motion.linear() * from_center;
  return motion;
}

}  // namespace

Eigen::Matrix3d nearestRotation(const Eigen::Matrix3d& matrix) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(matrix, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::Matrix3d turn = svd.matrixU() * svd.matrixV().transpose();
  if (turn.determinant() >= 0) return turn;
  return svd.matrixU() * Vec3(1, 1, -1).asDiagonal() * svd.matrixV().transpose();
}

Eigen::Isometry3d rigidMotion(std::span<const Vec3> from, std::span<const Vec3> to) {
  const auto at = [](std::span<const Vec3> points) { return [points](int i) { return points[i]; }; };
  return motionOf(static_cast<int>(from.size()), at(from), at(to));
}

Eigen::Isometry3d rootMotion(const HairMesh& mesh, std::span<const Vec3> from, std::span<const Vec3> to) {
  const std::vector<int>& first = mesh.shape.column_first;
  if (std::all_of(first.begin(), first.end() - 1, [&](int root) { return from[root] == to[root]; }))
    return Eigen::Isometry3d::Identity();
  const auto at = [&](std::span<const Vec3> x) { return [&first, x](int c) { return x[first[c]]; }; };
  return motionOf(mesh.columnCount(), at(from), at(to));
}

}  // namespace sim
