#include "render/strands/hair_layout.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <map>

#include "render/strands/hairline.h"
#include "render/strands/least_rotation.h"

namespace render {
namespace {

using Eigen::Vector3f;

// Small against the weights of real neighbours (each adds about 1 to the trace), large against rounding.
constexpr float kPriorWeight = 1e-3f;

Vector3f vertexAt(std::span<const float> positions, int vertex) {
  return Vector3f(positions[3 * vertex], positions[3 * vertex + 1], positions[3 * vertex + 2]);
}

bool isUsable(const HairFace& face, int vertex_count) {
  if (face.layers < 2) return false;
  for (int k = 0; k < 4; ++k) {
    const int first = face.first_vertex[k];
    if (k == 3 && first < 0) continue;
    if (first < 0 || first + face.layers > vertex_count) return false;
  }
  return true;
}

Vector3f faceNormal(const HairLayout& layout, const std::array<int, 4>& columns) {
  const Vector3f a = layout.columns[columns[0]].rest, b = layout.columns[columns[1]].rest,
                 c = layout.columns[columns[2]].rest;
  if (columns[3] < 0) return (b - a).cross(c - a);
  return (c - a).cross(layout.columns[columns[3]].rest - b);
}

// Turns the roots into the hair's own frame: origin at their middle, y along the mean normal, x towards the first
// column. Only then do hashed patterns stay where they are on the head whatever the pose at the first upload was.
Vector3f intoOwnFrame(HairLayout& layout) {
  Vector3f middle = Vector3f::Zero(), up = Vector3f::Zero();
  for (const HairColumn& column : layout.columns) middle += column.rest / static_cast<float>(layout.columns.size());
  for (const auto& columns : layout.face_columns) up += faceNormal(layout, columns);
  up = up.norm() > 1e-12f ? up.normalized().eval() : Vector3f::UnitY();
  Vector3f ahead = layout.columns.empty() ? Vector3f::UnitX() : (layout.columns[0].rest - middle).eval();
  ahead -= up * up.dot(ahead);
  ahead = ahead.norm() > 1e-6f ? ahead.normalized().eval() : up.unitOrthogonal();
  Eigen::Matrix3f turn;
  turn << ahead.transpose(), up.transpose(), ahead.cross(up).transpose();
  for (HairColumn& column : layout.columns) column.rest = turn * (column.rest - middle);
  return Vector3f::UnitY();
}

// Two measures of a column make its way by layers: its length, and that of its first half.
void measureWay(std::span<const float> positions, HairColumn& column) {
  const int last = column.layers - 1;
  float whole = 0, half = 0;
  for (int layer = 0; layer < last; ++layer) {
    const int v = column.first_vertex + layer;
    const float step = (vertexAt(positions, v + 1) - vertexAt(positions, v)).norm();
    half += step * std::clamp(0.5f * static_cast<float>(last) - static_cast<float>(layer), 0.0f, 1.0f);
    whole += step;
  }
  half = std::clamp(half, 0.3f * whole, 0.7f * whole);  // else the way would turn round
  const auto layers = static_cast<float>(last);
  column.way = {(4 * half - whole) / layers, (2 * whole - 4 * half) / (layers * layers)};
}

void setTangentPlanes(HairLayout& layout, const Vector3f& up) {
  std::vector<Vector3f> normals(layout.columns.size(), Vector3f::Zero());
  for (const auto& columns : layout.face_columns) {
    const Vector3f normal = faceNormal(layout, columns);
    for (int column : columns) {
      if (column >= 0) normals[column] += normal;
    }
  }
  for (std::size_t i = 0; i < layout.columns.size(); ++i) {
    const Vector3f normal = normals[i].norm() > 1e-12f ? normals[i].normalized().eval() : up;
    // The least rotation from the crown: neighbouring columns' axes then agree, so frames blend across faces.
    const Eigen::Quaternionf turn = leastRotation(up, normal);
    layout.columns[i].axis_u = turn * Vector3f::UnitX();
    layout.columns[i].axis_v = turn * Vector3f::UnitZ();
  }
}

void joinNeighbours(HairLayout& layout) {
  std::map<std::pair<int, int>, float> strengths;  // edges count fully, diagonals of quadrilaterals a quarter
  for (const auto& columns : layout.face_columns) {
    const int corners = columns[3] < 0 ? 3 : 4;
    for (int a = 0; a < corners; ++a) {
      for (int b = 0; b < corners; ++b) {
        if (a == b) continue;
        float& strength = strengths[{columns[a], columns[b]}];
        strength = std::max(strength, corners == 4 && (a + 2) % 4 == b ? 0.25f : 1.0f);
      }
    }
  }
  for (const auto& [pair, strength] : strengths) {
    HairColumn& column = layout.columns[pair.first];
    const Vector3f gap = layout.columns[pair.second].rest - column.rest;
    const Eigen::Vector2f offset(gap.dot(column.axis_u), gap.dot(column.axis_v));
    const float squared = std::max(gap.squaredNorm(), 1e-10f);
    column.neighbours.push_back({pair.second, offset, strength / squared});
  }
}

// Where only one of the two is painted the other is 1.
void takeShares(const LookShares& shares, HairLayout& layout) {
  const bool fits = shares.roots.size() == static_cast<std::size_t>(layout.vertex_count);
  if (!fits && shares.along.size() < 2) return;
  for (const HairColumn& column : layout.columns)
    layout.root_shares.push_back(fits ? shares.roots[static_cast<std::size_t>(column.first_vertex)] : LookShare{});
  layout.along_shares.assign(shares.along.begin(), shares.along.end());
  if (layout.along_shares.size() < 2) layout.along_shares.assign(2, LookShare{});
  layout.curl_share = curlShare(shares);
  layout.width_share = 0;
  for (const LookShare& share : layout.along_shares) layout.width_share = std::max(layout.width_share, share.width);
}

}  // namespace

float curlShare(const LookShares& shares) {
  float most = shares.along.empty() ? 1.0f : 0.0f;
  for (const LookShare& share : shares.along) most = std::max(most, share.curl);
  return most;
}

HairLayout makeHairLayout(std::span<const HairFace> faces, std::span<const float> positions, const LookShares& shares) {
  HairLayout layout;
  layout.vertex_count = static_cast<int>(positions.size() / 3);
  std::map<int, int> column_of_first;
  for (const HairFace& face : faces) {
    if (!isUsable(face, layout.vertex_count)) continue;
    layout.faces.push_back(face);
    layout.max_layers = std::max(layout.max_layers, face.layers);
    std::array<int, 4>& columns = layout.face_columns.emplace_back(std::array<int, 4>{-1, -1, -1, -1});
    for (int k = 0; k < 4 && face.first_vertex[k] >= 0; ++k) {
      const auto [entry, added] =
          column_of_first.try_emplace(face.first_vertex[k], static_cast<int>(layout.columns.size()));
      if (added) {
        HairColumn column;
        column.first_vertex = face.first_vertex[k];
        column.rest = vertexAt(positions, column.first_vertex);
        layout.columns.push_back(column);
      }
      columns[k] = entry->second;
      HairColumn& column = layout.columns[columns[k]];
      column.layers = std::max(column.layers, face.layers);
      column.shortest_bundle = added ? face.layers : std::min(column.shortest_bundle, face.layers);
    }
  }
  for (HairColumn& column : layout.columns) {
    measureWay(positions, column);
    const float tip = column.way.x() + 2 * column.way.y() * static_cast<float>(column.layers - 1);
    layout.layer_length = std::max({layout.layer_length, column.way.x(), tip});
  }
  const Vector3f up = intoOwnFrame(layout);
  setTangentPlanes(layout, up);
  joinNeighbours(layout);
  measureHairline(layout);
  takeShares(shares, layout);
  return layout;
}

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

Vector3f middleOfHead(const HairLayout& layout, std::span<const float> positions) {
  const HeadBall ball = fitHead(layout, positions);
  if (ball.radius > 0 || layout.vertex_count == 0) return ball.center;
  const auto points = Eigen::Map<const Eigen::Matrix3Xf>(positions.data(), 3, layout.vertex_count);
  return 0.5f * (points.rowwise().minCoeff() + points.rowwise().maxCoeff());
}

int segmentsFor(const HairLayout& layout, const HairLook& look, int asked) {
  constexpr int kMaxCount = 32;
  float turns = 0;  // of the sharpest bends, in pieces a metre
  if (look.curl_radius > 0) turns = 12 / (0.8f * std::max(look.curl_pitch, 1e-3f));
  if (look.wave_height > 0) turns = std::max(turns, 8 / (0.85f * std::max(look.wave_length, 1e-3f)));
  const int needed = static_cast<int>(std::min(std::ceil(turns * layout.layer_length), static_cast<float>(kMaxCount)));
  return std::max(std::clamp(asked, 1, 8), needed);
}

std::vector<int> dealStrands(const HairLayout& layout, int strands) {
  double total = 0;
  for (const HairFace& face : layout.faces) total += std::max(face.area, 0.0f);
  std::vector<int> first(layout.faces.size() + 1, 0);
  double passed = 0;
  for (std::size_t i = 0; i < layout.faces.size(); ++i) {
    passed += total > 0 ? std::max(layout.faces[i].area, 0.0f) / total : 1.0 / static_cast<double>(layout.faces.size());
    first[i + 1] = static_cast<int>(std::lround(std::min(passed, 1.0) * std::max(strands, 0)));
  }
  return first;
}

void inLayerGradients(const HairLayout& layout, std::span<const float> positions,
                      std::vector<Eigen::Matrix<float, 3, 2>>& gradients) {
  gradients.assign(layout.vertex_count, Eigen::Matrix<float, 3, 2>::Zero());
  for (const HairColumn& column : layout.columns) {
    Eigen::Matrix<float, 3, 2> below = Eigen::Matrix<float, 3, 2>::Zero();
    for (int layer = 0; layer < column.layers; ++layer) {
      const Vector3f here = vertexAt(positions, column.first_vertex + layer);
      Eigen::Matrix2f spread = kPriorWeight * Eigen::Matrix2f::Identity();
      Eigen::Matrix<float, 3, 2> moment = kPriorWeight * below;
      for (const ColumnNeighbour& neighbour : column.neighbours) {
        const HairColumn& other = layout.columns[neighbour.column];
        if (layer >= other.layers) continue;
        const Vector3f gap = vertexAt(positions, other.first_vertex + layer) - here;
        spread += neighbour.weight * neighbour.offset * neighbour.offset.transpose();
        moment += neighbour.weight * gap * neighbour.offset.transpose();
      }
      below = moment * spread.inverse();
      gradients[column.first_vertex + layer] = below;
    }
  }
}

}  // namespace render
