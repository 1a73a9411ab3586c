// The hair mesh: polygon layers extruded from the scalp, immutable once built.
//
// A *column* is one root vertex's chain of vertices from root to tip; a *root face* is a triangle or quadrilateral of
// the scalp layer; the *bundle* over a root face is a stack of *prisms*, one per pair of consecutive layers. Columns
// may have different lengths: a bundle ends where its shortest column ends.
//
// Source: Yuksel, Schaefer, Keyser, "Hair Meshes" (2009); Wu, Yuksel, "Real-time Hair Mesh Simulation" (2016),
// section 3. Units: metres. Frame: the head joint's (y up, z forward, x to the character's left).
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

namespace sim {

using Vec3 = Eigen::Vector3d;

// What is wrong with a hair mesh, in words for the person who made it. `place` names the element ("root face 12",
// "column 3, layer 4"), `fault` what is wrong there, `mend` what would put it right.
struct MeshError : std::runtime_error {
  MeshError(std::string place, std::string fault, std::string mend);
  std::string place, fault, mend;
};

// A root face: its corners are columns, counter-clockwise seen from outside the scalp.
struct RootFace {
  int corner_count = 0;  // 3 or 4
  std::array<int, 4> columns{-1, -1, -1, -1};
};

// What an author gives: the columns' rest positions and the root faces. Vertex (column c, layer l) is number
// column_first[c] + l, so a column is contiguous, root first.
struct HairMeshShape {
  std::vector<RootFace> root_faces;
  std::vector<int> column_first{0};  // columns + 1 entries
  std::vector<Vec3> positions;       // one per vertex
  // m, one per vertex or none: from there to where strands grow (render/strands/groom_offsets.h); nothing else sees it.
  std::vector<Vec3> groom_offsets;

  int columnCount() const { return static_cast<int>(column_first.size()) - 1; }
  int columnLength(int c) const { return column_first[c + 1] - column_first[c]; }
  int vertexCount() const { return column_first.back(); }
  // Layers of the bundle over a root face: those of its shortest column.
  int bundleLayers(const RootFace& face) const {
    int layers = columnLength(face.columns[0]);
    for (int k = 1; k < face.corner_count; ++k) layers = std::min(layers, columnLength(face.columns[k]));
    return layers;
  }
};

// An edge of the hair mesh. Horizontal edges join columns in one layer, vertical ones two layers of a column.
struct Edge {
  int a, b;            // vertices; for a vertical edge a is nearer the root
  double rest_length;  // m
  double volume;       // m^3, the share of the adjacent prisms' volume that the edge stands for
};

// A wall: the quadrilateral over a root edge between two layers. Corners (a, l), (b, l), (b, l + 1), (a, l + 1).
struct Wall {
  std::array<int, 4> v;
  double volume;  // m^3, its share of the adjacent prisms
  bool external;  // seen by one prism only
};

// Two consecutive walls over one root edge; they hinge on the horizontal edge (v[2], v[3]).
struct Hinge {
  std::array<int, 6> v;  // (a, l-1), (b, l-1), (a, l), (b, l), (a, l+1), (b, l+1)
  double rest_angle;     // rad, signed dihedral angle of the rest shape
  double length;         // m, mean rest length of the two walls along the hair
  double volume;         // m^3
};

// A corner tetrahedron: a prism's corner v[0] and its three edge neighbours, in order of positive rest volume.
struct CornerTet {
  std::array<int, 4> v;
  double rest_volume;  // m^3, signed: e1 . (e2 x e3) / 6
  double volume;       // m^3, the prism's volume over its corner count
};

// The corner tetrahedron at corner k of a prism over a face of n corners, by the prism's vertices: the corner, its two
// neighbours in the layer and the vertex above or below it. Around an upper corner the neighbours swap, so that the
// volume stays positive.
constexpr std::array<int, 4> cornerTetOf(int k, int n) {
  const int layer = k < n ? 0 : n, corner = k - layer;
  const int next = layer + (corner + 1) % n, previous = layer + (corner + n - 1) % n;
  return {k, layer ? previous : next, layer ? next : previous, n - layer + corner};
}

// A prism over a root face between layers `layer` and `layer + 1`. v: corners of the lower layer, then the upper.
struct Prism {
  int root_face, layer, corner_count;
  std::array<int, 8> v;
  double volume;  // m^3
};

// An external face (outer surface but for the scalp layer); corner_count 3 or 4, wound to face outwards.
struct ExternalFace {
  int corner_count;
  std::array<int, 4> v;
};

struct HairMesh {
  HairMeshShape shape;
  std::vector<int> bundle_layers;        // per root face: number of layers, the scalp's included (at least 2)
  std::vector<int> column_of, layer_of;  // per vertex
  std::vector<Prism> prisms;
  std::vector<Edge> horizontal_edges, vertical_edges;  // horizontal: scalp layer left out, roots are prescribed
  std::vector<Wall> walls;
  std::vector<Hinge> hinges;
  std::vector<CornerTet> tets;
  std::vector<int> external_vertices;  // roots left out
  std::vector<ExternalFace> external_faces;
  std::vector<double> vertex_volume;  // m^3 per vertex: its share of the adjacent prisms, the base of lumped mass
  std::vector<double> damping_share;  // per vertex, of SimParams::damping; an element has the mean; empty: 1 everywhere
  double total_volume = 0;            // m^3
  double hair_length = 0;             // m, the longest column's rest length: the scale of every relative error

  int vertexCount() const { return shape.vertexCount(); }
  int columnCount() const { return shape.columnCount(); }
  bool isRoot(int vertex) const { return layer_of[vertex] == 0; }
  double dampingShare(const auto& vertices) const {
    double sum = 0;
    for (const int v : vertices) sum += damping_share.empty() ? 1 : damping_share[v];
    return sum / vertices.size();
  }
};

// Builds topology and rest quantities. Throws MeshError on: no face, a face with repeated or dangling columns,
// duplicate faces, an edge shared by more than two root faces or wound the same way twice, a column shorter than two
// layers or used by no face, coordinates that are not finite or beyond 1e3 m, zero-area faces, edges shorter than 1e-5
// m, a corner tetrahedron whose rest volume is not positive.
HairMesh buildHairMesh(HairMeshShape shape);

}  // namespace sim
