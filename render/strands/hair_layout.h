// What the strand shaders know of a hair besides its positions: faces with their shares of the strands, columns with
// their rest place on the scalp, and the in-layer gradients that make faces join smoothly. CPU only, so it is tested
// without a context.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "render/frame_input.h"

namespace render {

// A column's neighbour on the scalp.
struct ColumnNeighbour {
  int column;
  Eigen::Vector2f offset;  // m, in this column's rest tangent plane
  float weight;            // 1 / m^2
};

struct HairColumn {
  int first_vertex = 0, layers = 0;
  int shortest_bundle =
      0;  // layers of the shortest bundle around the column: strands near it end there, so cuts have no steps
  Eigen::Vector3f rest =
      Eigen::Vector3f::Zero();  // m, rest root in the hair's own frame (rigid motion leaves it alone)
  Eigen::Vector3f axis_u = Eigen::Vector3f::UnitX(),
                  axis_v = Eigen::Vector3f::UnitZ();  // rest tangent plane, orthonormal
  Eigen::Vector2f way = Eigen::Vector2f::Zero();      // m of rest column up to s layers: s (x + y s), about
  float edge = 0;                                     // m to the hairline, 0.05 at most
  Eigen::Vector2f outward = Eigen::Vector2f::Zero();  // at most unit, in the tangent plane: off the nearest hairline
  std::vector<ColumnNeighbour> neighbours;
};

// Topology and rest geometry, made once per layout from the roots at rest.
struct HairLayout {
  std::vector<HairFace> faces;
  std::vector<std::array<int, 4>> face_columns;  // [3] = -1: triangle
  std::vector<float> face_edge;  // m: how much further from the hairline a face's middle is than its corners tell
  std::vector<HairColumn> columns;
  std::vector<LookShare> root_shares, along_shares;  // a column; from root to tip; both or neither
  float curl_share = 1, width_share = 1;             // largest of them
  int vertex_count = 0, max_layers = 0;
  float layer_length = 0;  // m at rest, of the longest layer
};

// A ball through the roots.
struct HeadBall {
  Eigen::Vector3f center = Eigen::Vector3f::Zero();
  float radius = 0;  // m; 0: the roots lie on no ball of a head's size
};

// positions: 3 floats a vertex. Faces of fewer than two layers or with vertices out of range are left out: they can
// carry no strand, and nothing may be read past the end of the positions.
// The shares of the look are taken where there is one a vertex.
HairLayout makeHairLayout(std::span<const HairFace> faces, std::span<const float> positions,
                          const LookShares& shares = {});

// Largest share of curls' radius along strands.
float curlShare(const LookShares& shares);

// Least squares; stands still in the frame of the roots.
HeadBall fitHead(const HairLayout& layout, std::span<const float> positions);

// m: what hair stands off from: the ball's middle, or that of the positions' box where the roots lie on no ball.
Eigen::Vector3f middleOfHead(const HairLayout& layout, std::span<const float> positions);

// Straight pieces a layer with which curls have at least 12 and waves 8 a turn; `asked` where these need no more.
int segmentsFor(const HairLayout& layout, const HairLook& look, int asked);

// First strand of every face, and the total at the end: strands are dealt out by area, every face's first strands keep
// their shape whatever the total.
std::vector<int> dealStrands(const HairLayout& layout, int strands);

// Gradient of position by the rest tangent plane, per vertex: least squares over the in-layer neighbours. Shape:
// vertex_count matrices, column 0 by u, column 1 by v (m per m). Where a layer leaves too few neighbours, the layer
// below fills in.
void inLayerGradients(const HairLayout& layout, std::span<const float> positions,
                      std::vector<Eigen::Matrix<float, 3, 2>>& gradients);

}  // namespace render
