#include "tests/bench/material_points.h"

#include <Eigen/Dense>
#include <algorithm>
#include <limits>

namespace bench {

sim::Vec3 MaterialPoint::at(std::span<const sim::Vec3> x) const {
  sim::Vec3 p = sim::Vec3::Zero();
  for (int k = 0; k < 4; ++k) p += weights[k] * x[v[k]];
  return p;
}

MaterialPoint materialPoint(const sim::HairMesh& mesh, const sim::Vec3& p) {
  MaterialPoint best;
  double nearest = std::numeric_limits<double>::infinity();
  const std::vector<sim::Vec3>& x = mesh.shape.positions;
  for (const sim::CornerTet& tet : mesh.tets) {
    Eigen::Matrix3d edges;
    for (int k = 0; k < 3; ++k) edges.col(k) = x[tet.v[k + 1]] - x[tet.v[0]];
    const sim::Vec3 inside = edges.inverse() * (p - x[tet.v[0]]);
    MaterialPoint point;
    point.v = tet.v;
    double sum = 0;
    for (int k = 0; k < 4; ++k) {
      point.weights[k] = std::max(0.0, k == 0 ? 1 - inside.sum() : inside[k - 1]);
      sum += point.weights[k];
    }
    for (double& w : point.weights) w /= sum;
    point.offset = p - point.at(x);
    if (point.offset.norm() >= nearest) continue;
    nearest = point.offset.norm();
    best = point;
  }
  return best;
}

std::vector<sim::Vec3> tipsOf(const sim::HairMesh& mesh) {
  std::vector<sim::Vec3> tips;
  for (int c = 0; c < mesh.columnCount(); ++c) tips.push_back(mesh.shape.positions[mesh.shape.column_first[c + 1] - 1]);
  return tips;
}

}  // namespace bench
