#include "render/strands/hairline.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <map>

namespace render {
namespace {

using Eigen::Vector3f;

constexpr float kPartingWidth = 0.015f;  // m, at most, between its banks
constexpr float kFarthest = 0.05f;       // m: further inside it makes no difference

struct BorderEdge {
  Vector3f from, to;
  Vector3f outward;  // unit, in the scalp's plane, off its face
};

Vector3f nearestPoint(const BorderEdge& edge, const Vector3f& p) {
  const Vector3f along = edge.to - edge.from;
  const float squared = std::max(along.squaredNorm(), 1e-12f);
  return edge.from + std::clamp((p - edge.from).dot(along) / squared, 0.0f, 1.0f) * along;
}

std::vector<BorderEdge> borderEdges(const HairLayout& layout) {
  struct Side {
    int faces = 0, from = 0, to = 0;
    Vector3f middle;  // of the face
  };
  std::map<std::pair<int, int>, Side> sides;
  for (const std::array<int, 4>& columns : layout.face_columns) {
    const int corners = columns[3] < 0 ? 3 : 4;
    Vector3f middle = Vector3f::Zero();
    for (int k = 0; k < corners; ++k) middle += layout.columns[columns[k]].rest / static_cast<float>(corners);
    for (int k = 0; k < corners; ++k) {
      const int a = columns[k], b = columns[(k + 1) % corners];
      Side& side = sides[std::minmax(a, b)];
      ++side.faces;
      side.from = a;
      side.to = b;
      side.middle = middle;
    }
  }
  std::vector<BorderEdge> edges;
  for (const auto& [pair, side] : sides) {
    if (side.faces != 1) continue;
    BorderEdge edge{layout.columns[side.from].rest, layout.columns[side.to].rest, Vector3f::Zero()};
    const Vector3f along = (edge.to - edge.from).normalized(), off = 0.5f * (edge.from + edge.to) - side.middle;
    edge.outward = (off - along * along.dot(off)).normalized();
    edges.push_back(edge);
  }
  return edges;
}

bool facesAnother(const BorderEdge& edge, const std::vector<BorderEdge>& edges) {
  const Vector3f middle = 0.5f * (edge.from + edge.to);
  return std::any_of(edges.begin(), edges.end(), [&](const BorderEdge& other) {
    if (&other == &edge || other.outward.dot(edge.outward) > -0.3f) return false;
    const Vector3f gap = nearestPoint(other, middle) - middle;
    return gap.norm() < kPartingWidth && gap.dot(edge.outward) > -0.003f;
  });
}

// m: the radius of the circle in a face, for faces of which every corner stands on the hairline.
float innerRadius(const HairLayout& layout, const std::array<int, 4>& columns) {
  const int corners = columns[3] < 0 ? 3 : 4;
  float around = 0;
  Vector3f area = Vector3f::Zero();
  for (int k = 0; k < corners; ++k) {
    const HairColumn &a = layout.columns[columns[k]], &b = layout.columns[columns[(k + 1) % corners]];
    if (a.edge > 1e-4f) return 0;
    around += (b.rest - a.rest).norm();
    area += (a.rest - layout.columns[columns[0]].rest).cross(b.rest - layout.columns[columns[0]].rest);
  }
  return around > 1e-9f ? area.norm() / around : 0.0f;
}

}  // namespace

void measureHairline(HairLayout& layout) {
  const std::vector<BorderEdge> border = borderEdges(layout);
  std::vector<BorderEdge> hairline;
  std::copy_if(border.begin(), border.end(), std::back_inserter(hairline),
               [&](const BorderEdge& edge) { return !facesAnother(edge, border); });
  for (HairColumn& column : layout.columns) {
    column.edge = kFarthest;
    Vector3f outward = Vector3f::Zero();  // of the nearest edges, of both beside a corner
    for (const BorderEdge& edge : hairline) {
      const float distance = (nearestPoint(edge, column.rest) - column.rest).norm();
      if (distance < column.edge - 1e-5f) outward.setZero();
      if (distance < column.edge + 1e-5f) outward += edge.outward;
      column.edge = std::min(column.edge, distance);
    }
    const Eigen::Vector2f in_plane(outward.dot(column.axis_u), outward.dot(column.axis_v));
    column.outward = in_plane / std::max(in_plane.norm(), 1.0f);
  }
  layout.face_edge.clear();
  for (const std::array<int, 4>& columns : layout.face_columns)
    layout.face_edge.push_back(innerRadius(layout, columns));
}

}  // namespace render
