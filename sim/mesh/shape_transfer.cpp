#include "sim/mesh/shape_transfer.h"

#include <algorithm>
#include <cassert>
#include <limits>

namespace sim {

namespace {

using RootTriangle = std::array<int, 3>;  // columns

struct RootPlace {
  std::array<int, 3> columns{};
  Vec3 weights = Vec3::Zero();  // barycentric
};

std::vector<RootTriangle> rootTriangles(const HairMesh& mesh) {
  std::vector<RootTriangle> triangles;
  for (const RootFace& face : mesh.shape.root_faces) {
    triangles.push_back({face.columns[0], face.columns[1], face.columns[2]});
    if (face.corner_count == 4) triangles.push_back({face.columns[0], face.columns[2], face.columns[3]});
  }
  return triangles;
}

// Barycentric weights of the point of the triangle's plane nearest to p, clamped into the triangle: near enough to the
// nearest point, since columns of the two meshes cover the same scalp.
Vec3 weightsAt(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& p) {
  const Vec3 u = b - a, v = c - a, w = p - a;
  const double uu = u.dot(u), uv = u.dot(v), vv = v.dot(v), wu = w.dot(u), wv = w.dot(v);
  const double area = uu * vv - uv * uv;
  if (!(area > 0)) return {1, 0, 0};
  Vec3 weights;
  weights[1] = (vv * wu - uv * wv) / area;
  weights[2] = (uu * wv - uv * wu) / area;
  weights[0] = 1 - weights[1] - weights[2];
  weights = weights.cwiseMax(0.0);
  return weights / weights.sum();
}

RootPlace placeOnScalp(const HairMesh& mesh, std::span<const RootTriangle> triangles, const Vec3& root) {
  const auto at = [&](int column) -> const Vec3& { return mesh.shape.positions[mesh.shape.column_first[column]]; };
  RootPlace best;
  double nearest = std::numeric_limits<double>::infinity();
  for (const RootTriangle& triangle : triangles) {
    const Vec3 &a = at(triangle[0]), &b = at(triangle[1]), &c = at(triangle[2]);
    const Vec3 weights = weightsAt(a, b, c, root);
    const double distance = (weights[0] * a + weights[1] * b + weights[2] * c - root).squaredNorm();
    if (distance < nearest) {
      nearest = distance;
      best = {triangle, weights};
    }
  }
  return best;
}

}  // namespace

ShapeTransfer makeShapeTransfer(const HairMesh& from, const HairMesh& to) {
  const std::vector<RootTriangle> triangles = rootTriangles(from);
  ShapeTransfer transfer;
  transfer.rows.resize(to.vertexCount());
  for (int c = 0; c < to.columnCount(); ++c) {
    const int first = to.shape.column_first[c], length = to.shape.columnLength(c);
    const RootPlace place = placeOnScalp(from, triangles, to.shape.positions[first]);
    for (int layer = 0; layer < length; ++layer) {
      ShapeTransfer::Row& row = transfer.rows[first + layer];
      const double share = static_cast<double>(layer) / (length - 1);
      for (int k = 0; k < 3; ++k) {
        const int column = place.columns[k], last = from.shape.columnLength(column) - 1;
        const double height = share * last;
        const int below = std::min(static_cast<int>(height), last - 1);
        const double part = height - below;
        row.vertex[2 * k] = from.shape.column_first[column] + below;
        row.vertex[2 * k + 1] = row.vertex[2 * k] + 1;
        row.weight[2 * k] = static_cast<float>(place.weights[k] * (1 - part));
        row.weight[2 * k + 1] = static_cast<float>(place.weights[k] * part);
      }
    }
  }
  return transfer;
}

void transferPositions(const ShapeTransfer& transfer, const HairMesh& from, const HairMesh& to,
                       const Eigen::Isometry3d& head_to_world, std::span<const Vec3> source, std::span<Vec3> target) {
  assert(target.size() == transfer.rows.size() && target.size() == to.shape.positions.size());
  const Eigen::Matrix3d turn = head_to_world.linear();
  for (std::size_t i = 0; i < target.size(); ++i) {
    const ShapeTransfer::Row& row = transfer.rows[i];
    Vec3 moved = Vec3::Zero(), rest = to.shape.positions[i];
    for (int k = 0; k < ShapeTransfer::kSources; ++k) {
      moved += row.weight[k] * source[row.vertex[k]];
      rest -= row.weight[k] * from.shape.positions[row.vertex[k]];
    }
    target[i] = moved + turn * rest;
  }
}

void transferVectors(const ShapeTransfer& transfer, std::span<const Vec3> source, std::span<Vec3> target) {
  assert(target.size() == transfer.rows.size());
  for (std::size_t i = 0; i < target.size(); ++i) {
    const ShapeTransfer::Row& row = transfer.rows[i];
    target[i].setZero();
    for (int k = 0; k < ShapeTransfer::kSources; ++k) target[i] += row.weight[k] * source[row.vertex[k]];
  }
}

}  // namespace sim
