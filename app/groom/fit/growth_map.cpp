#include "app/groom/fit/growth_map.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <map>
#include <span>

#include "render/strands/layer_curve.h"

namespace app {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3f;

constexpr float kPriorWeight = 1e-3f;  // as render/hair_layout
constexpr int kNewtonSteps = 4;

}  // namespace

GrowthMap::GrowthMap(const sim::HairMeshShape& shape) {
  std::vector<render::HairFace> faces;
  for (const sim::RootFace& face : shape.root_faces) {
    render::HairFace& out = faces.emplace_back();
    out.layers = shape.bundleLayers(face);
    for (int k = 0; k < face.corner_count; ++k) out.first_vertex[k] = shape.column_first[face.columns[k]];
  }
  std::vector<float> positions;
  for (const sim::Vec3& p : shape.positions) {
    for (int k = 0; k < 3; ++k) positions.push_back(static_cast<float>(p[k]));
  }
  layout_ = render::makeHairLayout(faces, positions);
  std::map<int, int> column_of_first;
  for (int c = 0; c < shape.columnCount(); ++c) column_of_first[shape.column_first[c]] = c;
  for (const render::HairColumn& column : layout_.columns) {
    column_of_.push_back(column_of_first.at(column.first_vertex));
    roots_.push_back(shape.positions[column.first_vertex].cast<float>());
    Eigen::Matrix2f spread = kPriorWeight * Eigen::Matrix2f::Identity();
    for (const render::ColumnNeighbour& n : column.neighbours) spread += n.weight * n.offset * n.offset.transpose();
    inverse_spread_.push_back(spread.inverse());
  }
  for (const auto& columns : layout_.face_columns) {
    std::vector<int>& reach = reach_.emplace_back();
    for (int c : columns) {
      if (c < 0) continue;
      reach.push_back(c);
      for (const render::ColumnNeighbour& n : layout_.columns[c].neighbours) reach.push_back(n.column);
    }
    std::sort(reach.begin(), reach.end());
    reach.erase(std::unique(reach.begin(), reach.end()), reach.end());
  }
  dense_.assign(layout_.columns.size(), 0);
}

Vector2f GrowthMap::planeOffset(int from, int to) const {
  const render::HairColumn& a = layout_.columns[from];
  const Vector3f gap = layout_.columns[to].rest - a.rest;
  return Vector2f(gap.dot(a.axis_u), gap.dot(a.axis_v));
}

// Adds the weights of G d, G the column's in-layer gradient.
void GrowthMap::addGradient(int column, const Vector2f& along, std::vector<float>& dense) const {
  const Vector2f d = inverse_spread_[column] * along;
  for (const render::ColumnNeighbour& n : layout_.columns[column].neighbours) {
    const float weight = n.weight * n.offset.dot(d);
    dense[n.column] += weight;
    dense[column] -= weight;
  }
}

void GrowthMap::weighQuad(const std::array<int, 4>& columns, const Vector2f& place, std::vector<float>& dense) const {
  const float u = place.x(), v = place.y(), iu = 1 - u, iv = 1 - v;
  const float u0 = iu * iu * (1 + 2 * u), u1 = 1 - u0, v0 = iv * iv * (1 + 2 * v), v1 = 1 - v0;
  const float tu0 = u * iu * iu, tu1 = u * u * iu, tv0 = v * iv * iv, tv1 = v * v * iv;
  const std::array<float, 4> weight{iv * u0 + iu * v0 - iu * iv, iv * u1 + u * v0 - u * iv, v * u1 + u * v1 - u * v,
                                    v * u0 + iu * v1 - iu * v};
  const std::array<float, 4> to_next{iv * tu0, u * tv0, v * tu1, iu * tv1};
  const std::array<float, 4> to_last{iu * tv0, iv * tu1, u * tv1, v * tu0};
  for (int k = 0; k < 4; ++k) {
    dense[columns[k]] += weight[k];
    addGradient(columns[k],
                to_next[k] * planeOffset(columns[k], columns[(k + 1) & 3]) +
                    to_last[k] * planeOffset(columns[k], columns[(k + 3) & 3]),
                dense);
  }
}

void GrowthMap::weighTriangle(const std::array<int, 4>& columns, const Vector2f& place,
                              std::vector<float>& dense) const {
  const Vector3f b(1 - place.x() - place.y(), place.x(), place.y());
  const float bubble = b.x() * b.y() * b.z();
  for (int k = 0; k < 3; ++k) {
    const int next = (k + 1) % 3, last = (k + 2) % 3;
    dense[columns[k]] += b[k] * b[k] * (3 - 2 * b[k]) + 2 * bubble;
    addGradient(columns[k],
                (b[k] * b[k] * b[next] + 0.5f * bubble) * planeOffset(columns[k], columns[next]) +
                    (b[k] * b[k] * b[last] + 0.5f * bubble) * planeOffset(columns[k], columns[last]),
                dense);
  }
}

GrowthRow GrowthMap::row(const RootPlace& root) const {
  const auto& columns = layout_.face_columns[root.face];
  if (columns[3] < 0) {
    weighTriangle(columns, root.place, dense_);
  } else {
    weighQuad(columns, root.place, dense_);
  }
  GrowthRow out;
  for (int c : reach_[root.face]) {
    if (dense_[c] != 0) {
      out.columns.push_back(column_of_[c]);
      out.weights.push_back(dense_[c]);
    }
    dense_[c] = 0;
  }
  return out;
}

Vector3f GrowthMap::rootAt(const RootPlace& root) const {
  const auto& columns = layout_.face_columns[root.face];
  if (columns[3] < 0) {
    weighTriangle(columns, root.place, dense_);
  } else {
    weighQuad(columns, root.place, dense_);
  }
  Vector3f at = Vector3f::Zero();
  for (int c : reach_[root.face]) {
    at += dense_[c] * roots_[c];
    dense_[c] = 0;
  }
  return at;
}

RootPlace GrowthMap::placeIn(int face, const Vector3f& point) const {
  const auto& columns = layout_.face_columns[face];
  const bool quad = columns[3] >= 0;
  const Vector3f &a = roots_[columns[0]], &b = roots_[columns[1]], &c = roots_[columns[2]];
  // The Jacobian of the flat face: the patch stays close to it, so a few steps do.
  Eigen::Matrix<float, 3, 2> jacobian;
  jacobian.col(0) = quad ? Vector3f(0.5f * (b - a + c - roots_[columns[3]])) : Vector3f(b - a);
  jacobian.col(1) = quad ? Vector3f(0.5f * (c - b + roots_[columns[3]] - a)) : Vector3f(c - a);
  const Eigen::Matrix2f normal = (jacobian.transpose() * jacobian).inverse();
  RootPlace root{face, quad ? Vector2f(0.5f, 0.5f) : Vector2f(1.0f / 3, 1.0f / 3)};
  for (int step = 0; step < kNewtonSteps; ++step) {
    root.place += normal * (jacobian.transpose() * (point - rootAt(root)));
    root.place = root.place.cwiseMax(0).cwiseMin(1);
    if (!quad && root.place.sum() > 1) {
      const float over = 0.5f * (root.place.sum() - 1);
      root.place = (root.place.array() - over).matrix();
      if (root.place.x() < 0) root.place = Vector2f(0, 1);
      if (root.place.y() < 0) root.place = Vector2f(1, 0);
    }
  }
  return root;
}

Vector3f curveAt(std::span<const Vector3f> layers, float s) {
  const auto at = [&](int l) { return layers[static_cast<std::size_t>(l)]; };
  return render::onLayers<Vector3f>(at, static_cast<int>(layers.size()), s);
}

}  // namespace app
