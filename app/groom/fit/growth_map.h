// The growth of strands as a linear map: where a strand rooted in a face passes each layer is one fixed weighted sum of
// that layer's vertices. Weights as in shaders/common/strand.glsl (Coons patches, Bezier triangles, in-layer
// gradients).
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "render/strands/hair_layout.h"
#include "sim/mesh/hair_mesh.h"

namespace app {

// Where a strand roots: `place` is (u, v) of a quadrilateral, the last two barycentric coordinates of a triangle.
struct RootPlace {
  int face = -1;
  Eigen::Vector2f place = Eigen::Vector2f::Zero();
};

// A strand's weights over the columns. They sum to 1.
struct GrowthRow {
  std::vector<int> columns;
  std::vector<float> weights;
};

class GrowthMap {
 public:
  // Columns that reach every layer of their faces alike: gradients then are the same sums in every layer.
  explicit GrowthMap(const sim::HairMeshShape& shape);

  GrowthRow row(const RootPlace& root) const;

  // The place in the face whose patch passes the root nearest to `point` (m); clamped to the face.
  RootPlace placeIn(int face, const Eigen::Vector3f& point) const;

  // Where the strand roots, m.
  Eigen::Vector3f rootAt(const RootPlace& root) const;

 private:
  void addGradient(int column, const Eigen::Vector2f& along, std::vector<float>& dense) const;
  Eigen::Vector2f planeOffset(int from, int to) const;
  void weighQuad(const std::array<int, 4>& columns, const Eigen::Vector2f& place, std::vector<float>& dense) const;
  void weighTriangle(const std::array<int, 4>& columns, const Eigen::Vector2f& place, std::vector<float>& dense) const;

  render::HairLayout layout_;
  std::vector<int> column_of_;  // of the layout's columns, in the shape
  std::vector<Eigen::Vector3f> roots_;
  std::vector<Eigen::Matrix2f> inverse_spread_;  // per layout column
  std::vector<std::vector<int>> reach_;          // per face: columns that can have a weight
  mutable std::vector<float> dense_;             // by layout column; all zero between calls
};

// The smooth curve through a strand's layer points, as the shaders draw it (render/strands/layer_curve.h). `s` in layers,
// from 0 to layers - 1.
Eigen::Vector3f curveAt(std::span<const Eigen::Vector3f> layers, float s);

}  // namespace app
