// Changes of a hair mesh's structure: a layer more or fewer, a parting drawn or closed, bundles grown at the border.
//
// Every result is a valid hair mesh (buildHairMesh takes it); where prisms would be flat what is around gives way (see
// untangle). New places are outside of the body. What would not be valid is refused by an
// InputError, and so is the removal of a last layer. All positions are rest positions in the scalp's frame, m.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "app/styles/hair_styles.h"

namespace app {

// Where a vertex of the new mesh comes from: `share` of the way from one vertex of the old mesh to another.
struct VertexSource {
  int from = 0, to = 0;
  double share = 0;
};

struct EditedMesh {
  sim::HairMeshShape shape;
  std::vector<VertexSource> sources;  // one a vertex
  double moved = 0;                   // m, farthest that the curve of a column lies from the one that it had
};

// An edge of the scalp layer, by its columns.
struct ColumnPair {
  int a = 0, b = 0;
};

inline constexpr int kMaxEditedLayers = 64;

// Uniform Catmull-Rom through the vertices of a column, as strands are drawn: layer `at`, 0 to length - 1.
Vec3 onColumn(std::span<const Vec3> column, double at);

// A layer between `after` and the next one, on the columns' curves; after the last layer: beyond the tips, as long as
// the last segment.
EditedMesh addLayer(const sim::HairMeshShape& shape, int after, const BodyDistance& body);

// Takes a layer (from 1 on) away. The layers beside it slide along the columns' curves to where the curves of the new
// mesh are nearest to the old ones.
EditedMesh removeLayer(const sim::HairMeshShape& shape, int layer, const BodyDistance& body);

// Root edges, or columns, with their likes on the other side of the plane x = `middle` (m). The like of a column is the
// one that roots nearest to its mirrored root, with those that root where it does; the like of an edge are the fewest
// edges that join the likes of its ends, for the two sides of a head need not have the same columns. Throw InputError
// where there is no like within an edge's length.
std::vector<ColumnPair> withMirrored(const sim::HairMeshShape& shape, std::span<const ColumnPair> edges, double middle);
std::vector<int> withMirrored(const sim::HairMeshShape& shape, std::span<const int> columns, double middle);

// Draws a parting along root edges: bundles on its two sides share no column any more. Ends of the parting inside the
// hair stay joined. No vertex moves.
EditedMesh splitColumns(const sim::HairMeshShape& shape, std::span<const ColumnPair> edges);

// Closes partings: each of the columns is welded to those that root where it does, in the mean of their places.
EditedMesh mergeColumns(const sim::HairMeshShape& shape, std::span<const int> columns);

// Bundles over the bald side of the border's root edges, in their neighbours' shape, laid under them. Where a chain of
// edges ends they end in a point.
EditedMesh extrudeColumns(const sim::HairMeshShape& shape, std::span<const ColumnPair> edges, const Scalp& scalp,
                          const BodyDistance& body);

// Whether every prism is positive and the structure is that of a hair mesh.
bool isValid(const sim::HairMeshShape& shape);

// Whether two hair meshes differ in their positions at most.
bool sameStructure(const sim::HairMeshShape& a, const sim::HairMeshShape& b);

}  // namespace app
