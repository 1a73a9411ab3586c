#include "render/sky_visibility.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

namespace render {
namespace {

using Eigen::Vector3f;

constexpr int kGridSize = 18;
// Light finds its way between clumps: far less is stopped than by hairs strewn evenly.
constexpr float kClumpGaps = 0.3f;
constexpr float kHeadDepth = 6.0f;  // optical depth of a ray through the head's middle; softened at its rim

Vector3f vertexAt(std::span<const float> positions, int vertex) {
  return Vector3f(positions[3 * vertex], positions[3 * vertex + 1], positions[3 * vertex + 2]);
}

// Up, four around at 35 degrees and two low ones: the sky weighs more than the floor.
const std::array<Vector3f, 7>& skyDirections() {
  static const std::array<Vector3f, 7> directions{Vector3f(0, 1, 0),
                                                  Vector3f(0.82f, 0.57f, 0),
                                                  Vector3f(-0.82f, 0.57f, 0),
                                                  Vector3f(0, 0.57f, 0.82f),
                                                  Vector3f(0, 0.57f, -0.82f),
                                                  Vector3f(0.68f, -0.26f, 0.68f),
                                                  Vector3f(-0.68f, -0.26f, -0.68f)};
  return directions;
}

float headDepth(const HeadBall& head, const Vector3f& from, const Vector3f& direction) {
  if (head.radius <= 0) return 0;
  const Vector3f gap = head.center - from;
  const float ahead = gap.dot(direction);
  if (ahead <= 0) return 0;
  const float miss = std::sqrt(std::max(gap.squaredNorm() - ahead * ahead, 0.0f)) / head.radius;
  return kHeadDepth * std::clamp((1.05f - miss) / 0.35f, 0.0f, 1.0f);
}

}  // namespace

HeadBall fitHead(const HairLayout& layout, std::span<const float> positions) {
  // |p|^2 = 2 c.p + (r^2 - |c|^2): linear in c and the bracket. Taken about the mean for conditioning.
  HeadBall ball;
  if (layout.columns.size() < 4) return ball;
  Vector3f mean = Vector3f::Zero();
  for (const HairColumn& column : layout.columns) mean += vertexAt(positions, column.first_vertex);
  mean /= static_cast<float>(layout.columns.size());
  Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
  Eigen::Vector4d right = Eigen::Vector4d::Zero();
  for (const HairColumn& column : layout.columns) {
    const Eigen::Vector3d p = (vertexAt(positions, column.first_vertex) - mean).cast<double>();
    const Eigen::Vector4d row(2 * p.x(), 2 * p.y(), 2 * p.z(), 1);
    normal += row * row.transpose();
    right += row * p.squaredNorm();
  }
  const Eigen::FullPivLU<Eigen::Matrix4d> factor(normal);
  if (!factor.isInvertible()) return ball;
  const Eigen::Vector4d solution = factor.solve(right);
  const double squared = solution[3] + solution.head<3>().squaredNorm();
  if (!(squared > 0.03 * 0.03) || squared > 0.3 * 0.3) return ball;
  ball.center = mean + solution.head<3>().cast<float>();
  ball.radius = static_cast<float>(std::sqrt(squared));
  return ball;
}

void SkyVisibility::splat(const Vector3f& at, float extinction) {
  const Vector3f cell = (at - low_) / cell_ - Vector3f::Constant(0.5f);
  const Eigen::Vector3i base = cell.array().floor().cast<int>().max(0).min(kGridSize - 2);
  const Vector3f f = (cell - base.cast<float>()).cwiseMax(0.0f).cwiseMin(1.0f);
  for (int corner = 0; corner < 8; ++corner) {
    const int dx = corner & 1, dy = (corner >> 1) & 1, dz = corner >> 2;
    const float share = (dx ? f.x() : 1 - f.x()) * (dy ? f.y() : 1 - f.y()) * (dz ? f.z() : 1 - f.z());
    grid_[((base.z() + dz) * kGridSize + base.y() + dy) * kGridSize + base.x() + dx] += share * extinction;
  }
}

float SkyVisibility::density(const Vector3f& at) const {
  const Eigen::Vector3i cell = ((at - low_) / cell_).array().floor().cast<int>();
  if ((cell.array() < 0).any() || (cell.array() >= kGridSize).any()) return 0;
  return grid_[(cell.z() * kGridSize + cell.y()) * kGridSize + cell.x()];
}

void SkyVisibility::fillGrid(const HairLayout& layout, std::span<const float> positions, float hair_width) {
  Vector3f low = Vector3f::Constant(1e9f), high = Vector3f::Constant(-1e9f);
  for (int v = 0; v < layout.vertex_count; ++v) {
    low = low.cwiseMin(vertexAt(positions, v));
    high = high.cwiseMax(vertexAt(positions, v));
  }
  cell_ = std::max((high - low).maxCoeff(), 0.02f) / (kGridSize - 2);
  low_ = 0.5f * (low + high) - Vector3f::Constant(0.5f * kGridSize * cell_);
  grid_.assign(kGridSize * kGridSize * kGridSize, 0.0f);
  double area = 0;
  for (const HairFace& face : layout.faces) area += std::max(face.area, 0.0f);
  // pi / 4: mean projected width of a cylinder over the angles it is crossed at.
  const float per_area =
      area > 0 ? static_cast<float>(hair_width / area) * 0.785f * kClumpGaps / (cell_ * cell_ * cell_) : 0.0f;
  for (const HairFace& face : layout.faces) {
    const int corners = face.first_vertex[3] < 0 ? 3 : 4;
    for (int layer = 0; layer + 1 < face.layers; ++layer) {
      Vector3f lower = Vector3f::Zero(), upper = Vector3f::Zero();
      for (int k = 0; k < corners; ++k) {
        lower += vertexAt(positions, face.first_vertex[k] + layer) / static_cast<float>(corners);
        upper += vertexAt(positions, face.first_vertex[k] + layer + 1) / static_cast<float>(corners);
      }
      const float extinction = per_area * face.area * (upper - lower).norm() / (2.0f * corners);
      for (int k = 0; k < corners; ++k) {
        const Vector3f a = vertexAt(positions, face.first_vertex[k] + layer),
                       b = vertexAt(positions, face.first_vertex[k] + layer + 1);
        // Half way from the middle to the corner, at two heights: spreads a prism over the cells it fills.
        splat(0.5f * (0.75f * (a + lower) + 0.25f * (b + upper)), extinction);
        splat(0.5f * (0.25f * (a + lower) + 0.75f * (b + upper)), extinction);
      }
    }
  }
}

float SkyVisibility::opticalDepth(const Vector3f& from, const Vector3f& direction) const {
  float depth = headDepth(head_, from, direction);
  for (int step = 1; step <= kGridSize; ++step) {
    const Vector3f at = from + (static_cast<float>(step) - 0.25f) * cell_ * direction;
    depth += density(at) * cell_;
  }
  return depth;
}

void SkyVisibility::compute(const HairLayout& layout, std::span<const float> positions, float hair_width,
                            const Vector3f& to_fill, const Vector3f& to_rim) {
  head_ = fitHead(layout, positions);
  fillGrid(layout, positions, hair_width);
  values_.resize(layout.vertex_count);
  for (int v = 0; v < layout.vertex_count; ++v) {
    const Vector3f at = vertexAt(positions, v);
    float open = 0;
    for (const Vector3f& direction : skyDirections()) open += std::exp(-opticalDepth(at, direction));
    values_[v] = Vector3f(open / skyDirections().size(), opticalDepth(at, to_fill), opticalDepth(at, to_rim));
  }
}

}  // namespace render
