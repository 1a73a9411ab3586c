#include "render/light/sky_visibility.h"

#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <array>
#include <cmath>

#include "shaders/shared.h"

namespace render {
namespace {

using Eigen::Vector3f;

// Light finds its way between clumps that the lattice doesn't resolve: less is stopped than by hairs strewn evenly.
// Held to traced light; see docs/picture.md.
constexpr float kClumpGaps = 0.4f;
constexpr float kHeadDepth = 6.0f;  // optical depth of a ray through the head's middle; softened at its rim
// The body's ellipsoids have the same depth. Their shadow ends kBodyRim radii from their middle, for a hair mesh has
// too few vertices for its edge, and hair that lies on skin is lit. The lights are soft: the shadow narrows with the
// distance and ends after kBodyReach (m). Thin ellipsoids are left out: kThinnestBlocker (1/m) is the norm of a ball's
// map.
constexpr float kBodyRim = 0.9f, kBodySoft = 0.3f, kBodyReach = 0.5f, kThinnestBlocker = 60;
// Hair that is drawn together fills a cell with many depths, and the lattice blurs its surface into them: what the eye
// sees would count as buried. Of what a cell holds beyond loose hair's kLooseDepth, kBlurredCells lie behind it. Both
// held to traced light; see docs/picture.md.
constexpr float kLooseDepth = 2.0f;
constexpr float kBlurredCells = 1.2f;
constexpr float kSpacing = 0.012f;  // m between the points that stand for a prism's hair
constexpr int kMaxPoints = 6;       // of them along a prism's height

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

// The least-squares fit of a + b . w to values in those directions: (a, b) = fit * values.
const Eigen::Matrix<float, 4, 7>& skyFit() {
  static const Eigen::Matrix<float, 4, 7> fit = [] {
    Eigen::Matrix<float, 7, 4> rows;
    for (int k = 0; k < 7; ++k) rows.row(k) << 1, skyDirections()[static_cast<std::size_t>(k)].transpose();
    return Eigen::Matrix<float, 4, 7>((rows.transpose() * rows).inverse() * rows.transpose());
  }();
  return fit;
}

// Nodes of the lattice from one that surfaces read to the next.
int opennessStride(float cell) {
  return cell < 0.02f ? 2 : 1;
}

// gap: from the place to the head's middle.
float headDepth(const Vector3f& gap, float radius, const Vector3f& direction) {
  if (radius <= 0) return 0;
  const float ahead = gap.dot(direction);
  if (ahead <= 0) return 0;
  const float miss = std::sqrt(std::max(gap.squaredNorm() - ahead * ahead, 0.0f)) / radius;
  return kHeadDepth * std::clamp((1.05f - miss) / 0.35f, 0.0f, 1.0f);
}

// Adds to the depths of all vertices what the body puts before the light.
void addBody(std::span<const float> positions, const Vector3f& to_light, std::span<const SkinEllipsoid> skin,
             std::vector<float>& depths) {
  if (skin.empty() || depths.empty()) return;
  const auto count = static_cast<Eigen::Index>(depths.size());
  const auto axis = [&](int a) {
    return Eigen::Map<const Eigen::ArrayXf, 0, Eigen::InnerStride<3>>(positions.data() + a, count);
  };
  const Eigen::ArrayXf x = axis(0), y = axis(1), z = axis(2);
  const Vector3f center(x.mean(), y.mean(), z.mean());
  const float radius =
      std::sqrt(((x - center.x()).square() + (y - center.y()).square() + (z - center.z()).square()).maxCoeff());
  // The nearest that a vertex's ray comes to an ellipsoid's middle, in radii, squared.
  Eigen::ArrayXf least = Eigen::ArrayXf::Constant(count, kBodyRim * kBodyRim), before(count), squared(count);
  for (const SkinEllipsoid& ellipsoid : skin) {
    Eigen::Matrix<float, 3, 4> to_ball;
    for (int a = 0; a < 3; ++a)
      to_ball.row(a) = Eigen::Map<const Eigen::RowVector4f>(ellipsoid.to_ball[static_cast<std::size_t>(a)].data());
    if (to_ball.leftCols<3>().norm() > kThinnestBlocker) continue;
    const Vector3f way = to_ball.leftCols<3>() * to_light, towards = way.normalized();
    const auto along = [&](const Eigen::RowVector4f& row) { return row[0] * x + row[1] * y + row[2] * z + row[3]; };
    const Eigen::RowVector4f ahead = -towards.transpose() * to_ball;
    const float middle = ahead.dot(center.homogeneous()), around = ahead.head<3>().norm() * radius,
                narrowing = kBodyRim / (kBodyReach * way.norm());  // a radius
    if (middle + around <= 0 || (middle - around) * narrowing >= kBodyRim) continue;
    before = along(ahead);
    squared = along(to_ball.row(0)).square() + along(to_ball.row(1)).square() + along(to_ball.row(2)).square();
    least = (before > 0).select(least.min(squared - (1 - narrowing * narrowing) * before.square()), least);
  }
  const Eigen::ArrayXf inside = (kBodyRim - least.max(0.0f).sqrt()) / kBodySoft;
  Eigen::Map<Eigen::ArrayXf>(depths.data(), count) += kHeadDepth * inside.min(1.0f);
}

}  // namespace

Eigen::Isometry3f headFrame(const HairLayout& layout, std::span<const float> positions) {
  Eigen::Isometry3f frame = Eigen::Isometry3f::Identity();
  if (layout.columns.empty()) return frame;
  Vector3f rest = Vector3f::Zero(), now = Vector3f::Zero();
  for (const HairColumn& column : layout.columns) {
    rest += column.rest;
    now += vertexAt(positions, column.first_vertex);
  }
  rest /= static_cast<float>(layout.columns.size());
  now /= static_cast<float>(layout.columns.size());
  Eigen::Matrix3f covariance = Eigen::Matrix3f::Zero();
  for (const HairColumn& column : layout.columns)
    covariance += (vertexAt(positions, column.first_vertex) - now) * (column.rest - rest).transpose();
  const Eigen::JacobiSVD<Eigen::Matrix3f> svd(covariance, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Matrix3f turn = svd.matrixU();
  if (turn.determinant() * svd.matrixV().determinant() < 0) turn.col(2) *= -1;
  frame.linear() = turn * svd.matrixV().transpose();
  frame.translation() = now - frame.linear() * rest;
  return frame;
}

float packDepths(const LightDepths& depths) {
  const float front = std::clamp(depths.front, 0.0f, shared::kDeepest),
              behind = std::clamp(depths.behind / shared::kDeepest, 0.0f, 0.999f);
  return std::floor(front * shared::kDepthSteps + 0.5f) + behind;
}

void SkyVisibility::placeVertices(const HairLayout& layout, std::span<const float> positions) {
  frame_ = headFrame(layout, positions);
  const Eigen::Isometry3f to_head = frame_.inverse();
  head_center_ = to_head * head_.center;
  Bounds bounds;
  vertices_.resize(static_cast<std::size_t>(layout.vertex_count));
  for (int v = 0; v < layout.vertex_count; ++v) {
    vertices_[static_cast<std::size_t>(v)] = to_head * vertexAt(positions, v);
    bounds.add(vertices_[static_cast<std::size_t>(v)]);
  }
  grid_.place(bounds);
}

void SkyVisibility::fillGrid(const HairLayout& layout, float hair_width, float length_variation) {
  double area = 0;
  for (const HairFace& face : layout.faces) area += std::max(face.area, 0.0f);
  // pi / 4: mean projected width of a cylinder over the angles it is crossed at.
  const float per_area = area > 0 ? static_cast<float>(hair_width / area) * 0.785f * kClumpGaps : 0.0f;
  for (const HairFace& face : layout.faces) {
    const int corners = face.first_vertex[3] < 0 ? 3 : 4;
    const auto vertex = [&](int corner, int layer) -> const Vector3f& {
      return vertices_[static_cast<std::size_t>(face.first_vertex[corner] + layer)];
    };
    const auto middle = [&](int layer) {
      Vector3f sum = Vector3f::Zero();
      for (int k = 0; k < corners; ++k) sum += vertex(k, layer);
      return Vector3f(sum / static_cast<float>(corners));
    };
    Vector3f lower = middle(0);
    for (int layer = 0; layer + 1 < face.layers; ++layer) {
      const Vector3f upper = middle(layer + 1);
      const float length = (upper - lower).norm();
      const int points = std::clamp(static_cast<int>(std::ceil(length / kSpacing)), 1, kMaxPoints);
      const float extinction = per_area * face.area * length / static_cast<float>(points * corners);
      const auto left = [&](float t) {  // of the strands, where they end one after the other
        const float to_end = 1 - (static_cast<float>(layer) + t) / static_cast<float>(face.layers - 1);
        return std::min(to_end / std::max(length_variation, 1e-3f), 1.0f);
      };
      for (int k = 0; k < corners; ++k) {
        // Half way from the middle to the corner: spreads a prism over the nodes that it fills.
        const Vector3f from = 0.5f * (lower + vertex(k, layer)), to = 0.5f * (upper + vertex(k, layer + 1));
        for (int point = 0; point < points; ++point) {
          const float t = (static_cast<float>(point) + 0.5f) / static_cast<float>(points);
          grid_.add((1 - t) * from + t * to, left(t) * extinction);
        }
      }
      lower = upper;
    }
  }
  blurred_.resize(vertices_.size());
  for (std::size_t v = 0; v < vertices_.size(); ++v)
    blurred_[v] = kBlurredCells * std::max(grid_.cell() * grid_.density(vertices_[v]) - kLooseDepth, 0.0f);
}

void SkyVisibility::lookTowards(const Vector3f& direction) {
  grid_.sweep(direction, swept_);
  depths_.resize(vertices_.size());
  for (std::size_t v = 0; v < vertices_.size(); ++v) {
    depths_[v] = std::max(grid_.sample(swept_, vertices_[v]) - blurred_[v], 0.0f) +
                 headDepth(head_center_ - vertices_[v], head_.radius, direction);
  }
}

void SkyVisibility::addOpenness(std::size_t direction) {
  const Eigen::Vector3i nodes = grid_.nodes();
  const int stride = opennessStride(grid_.cell());
  if (direction == 0) {
    for (int a = 0; a < 3; ++a) open_nodes_[static_cast<std::size_t>(a)] = (nodes[a] - 1) / stride + 1;
    open_depths_.resize(open_nodes_[0] * open_nodes_[1] * open_nodes_[2]);
    fitted_.setZero(open_depths_.size(), 4);
  }
  Eigen::Index to = 0;
  for (int x = 0; x < open_nodes_[0]; ++x)
    for (int y = 0; y < open_nodes_[1]; ++y)
      for (int z = 0; z < open_nodes_[2]; ++z)
        open_depths_[to++] = swept_[static_cast<std::size_t>(stride * ((x * nodes.y() + y) * nodes.z() + z))];
  open_depths_ = (-open_depths_).exp();
  for (int k = 0; k < 4; ++k) fitted_.col(k) += skyFit()(k, static_cast<int>(direction)) * open_depths_;
}

void SkyVisibility::packOpenness() {
  constexpr int kRoom = 2;  // sizes are multiples of it
  constexpr std::array<std::uint8_t, 4> kOpen{255, 128, 128, 128};
  const auto [nx, ny, nz] = open_nodes_;
  std::array<int, 3>& size = openness_.size;
  const auto roomFor = [](int nodes) { return std::max((nodes - 2 + kRoom - 1) / kRoom, 1) * kRoom; };
  size = {roomFor(nz), roomFor(ny), roomFor(nx)};  // without the outermost: the texture's border stands for them
  openness_.texels.assign(static_cast<std::size_t>(size[0] * size[1] * size[2]), kOpen);
  for (int x = 1; x + 1 < nx; ++x) {
    for (int y = 1; y + 1 < ny; ++y) {
      for (int z = 1; z + 1 < nz; ++z) {
        const int node = (x * ny + y) * nz + z;
        auto& texel = openness_.texels[static_cast<std::size_t>(((x - 1) * size[1] + y - 1) * size[0] + z - 1)];
        texel[0] = static_cast<std::uint8_t>(255 * std::clamp(fitted_(node, 0), 0.0f, 1.0f) + 0.5f);
        for (int k = 1; k < 4; ++k)
          texel[static_cast<std::size_t>(k)] =
              static_cast<std::uint8_t>(128.5f + 127 * std::clamp(fitted_(node, k), -1.0f, 1.0f));
      }
    }
  }
  const float spacing = grid_.cell() * static_cast<float>(opennessStride(grid_.cell()));
  openness_.from_head.setZero();
  for (int a = 0; a < 3; ++a) {
    const auto room = static_cast<float>(size[static_cast<std::size_t>(a)]);
    openness_.from_head(a, 2 - a) = 1 / (spacing * room);
    openness_.from_head(a, 3) = (-0.5f - static_cast<float>(grid_.low()[2 - a]) * grid_.cell() / spacing) / room;
  }
  openness_.from_head(3, 3) = 1;
}

// Hair alone: the head sends little back.
float SkyVisibility::depthBehind(const Vector3f& from, const Vector3f& to_light) const {
  constexpr int kSteps = 2;
  const float step_length = shared::kBackReach / kSteps;
  float depth = 0;
  for (int step = 0; step < kSteps; ++step) {
    const Vector3f at = from - (static_cast<float>(step) + 0.5f) * step_length * to_light;
    if ((at - head_center_).norm() < head_.radius) break;
    depth += step_length * grid_.density(at);
  }
  return depth;
}

void SkyVisibility::compute(const HairLayout& layout, std::span<const float> positions, float hair_width,
                            float length_variation, const Vector3f& to_fill, const Vector3f& to_rim,
                            std::span<const SkinEllipsoid> skin) {
  head_ = fitHead(layout, positions);
  placeVertices(layout, positions);
  fillGrid(layout, hair_width, length_variation);
  const auto to_head = [&](const Vector3f& direction) { return Vector3f(frame_.linear().transpose() * direction); };
  values_.assign(vertices_.size(), SoftLight{});
  for (SoftLight& value : values_) value.sky = 0;
  for (std::size_t d = 0; d < skyDirections().size(); ++d) {
    lookTowards(to_head(skyDirections()[d]));
    for (std::size_t v = 0; v < vertices_.size(); ++v)
      values_[v].sky += std::exp(-depths_[v]) / static_cast<float>(skyDirections().size());
    addOpenness(d);
  }
  packOpenness();
  const auto light = [&](const Vector3f& to_light, LightDepths SoftLight::*depths) {
    const Vector3f direction = to_head(to_light);
    lookTowards(direction);
    addBody(positions, to_light, skin, depths_);
    for (std::size_t v = 0; v < vertices_.size(); ++v)
      values_[v].*depths = {depths_[v], depthBehind(vertices_[v], direction)};
  };
  light(to_fill, &SoftLight::fill);
  light(to_rim, &SoftLight::rim);
}

}  // namespace render
