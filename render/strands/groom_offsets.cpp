#include "render/strands/groom_offsets.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cstddef>
#include <map>

namespace render {
namespace {

using Eigen::Vector3f;

Vector3f at(std::span<const float> values, int vertex) {
  const std::size_t first = 3 * static_cast<std::size_t>(vertex);
  return {values[first], values[first + 1], values[first + 2]};
}

struct Column {
  int layers = 0;
  std::vector<std::pair<int, int>> beside;  // first vertices of the columns around it, and the layers of their faces
};

std::map<int, Column> columnsOf(std::span<const HairFace> faces, int vertices) {
  std::map<int, Column> columns;
  for (const HairFace& face : faces) {
    const std::size_t corners = face.first_vertex[3] < 0 ? 3 : 4;
    for (std::size_t k = 0; k < corners; ++k) {
      const int first = face.first_vertex[k];
      if (first < 0 || first + face.layers > vertices) continue;
      Column& column = columns[first];
      column.layers = std::max(column.layers, face.layers);
      for (const std::size_t other : {(k + 1) % corners, (k + corners - 1) % corners})
        column.beside.push_back({face.first_vertex[other], face.layers});
    }
  }
  return columns;
}

}  // namespace

Eigen::Matrix3f GroomOffsets::axes(const Frame& frame, std::span<const float> positions) {
  const Vector3f along = (at(positions, frame.after) - at(positions, frame.before)).stableNormalized();
  const Vector3f beside = at(positions, frame.beside) - at(positions, frame.vertex);
  const Vector3f across = (beside - beside.dot(along) * along).stableNormalized();
  Eigen::Matrix3f axes;
  axes << along, across, along.cross(across);
  return axes;
}

GroomOffsets::GroomOffsets(std::span<const HairFace> faces, std::span<const float> rest,
                           std::span<const float> offsets) {
  if (offsets.empty() || offsets.size() != rest.size()) return;
  const int vertices = static_cast<int>(rest.size() / 3);
  for (const auto& [first, column] : columnsOf(faces, vertices)) {
    for (int l = 0; l < column.layers; ++l) {
      const int vertex = first + l;
      Frame frame{vertex, l > 0 ? vertex - 1 : vertex, l + 1 < column.layers ? vertex + 1 : vertex, -1,
                  at(offsets, vertex)};
      if (frame.offset.isZero(0)) continue;
      const Vector3f along = (at(rest, frame.after) - at(rest, frame.before)).stableNormalized();
      float most = 0;
      for (const auto& [other, layers] : column.beside) {
        if (l >= layers || other < 0 || other + l >= vertices) continue;
        const float across = (at(rest, other + l) - at(rest, vertex)).stableNormalized().cross(along).norm();
        if (across <= most) continue;
        most = across;
        frame.beside = other + l;
      }
      if (frame.beside < 0) continue;
      frame.offset = axes(frame, rest).transpose() * frame.offset;
      frames_.push_back(frame);
    }
  }
}

void GroomOffsets::add(std::span<const float> positions, std::vector<float>& drawn) const {
  drawn.assign(positions.begin(), positions.end());
  for (const Frame& frame : frames_) {
    const Vector3f moved = at(positions, frame.vertex) + axes(frame, positions) * frame.offset;
    std::copy_n(moved.data(), 3, drawn.begin() + 3 * static_cast<std::ptrdiff_t>(frame.vertex));
  }
}

}  // namespace render
