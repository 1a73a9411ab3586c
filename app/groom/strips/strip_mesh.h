// Rows of strips and tubes to a hair mesh.
//
// A strip of n quads across becomes n root faces: its rows, doubled on both sides of the strip at a small distance, are
// layers. A tube becomes one bundle where its rings have three or four points, else a row of root faces across its
// rings.
#pragma once

#include <string>
#include <vector>

#include "app/groom/strips/strip_rows.h"
#include "sim/mesh/hair_mesh.h"

namespace app {

struct StripMeshOptions {
  int vertices = 0;      // most of the hair mesh; 0: kStripVertices
  int layers = 0;        // of every column; 0: the rows there are, at least 4
  double thickness = 0;  // m, of strips at their roots; 0: a third of a quad's width, 2 to 8 mm
};

inline constexpr int kStripVertices = 4000;       // asked for when nothing is said
inline constexpr int kMaxStripVertices = 100000;  // more are refused

struct StripMesh {
  sim::HairMeshShape shape;   // has passed sim::buildHairMesh
  std::vector<int> left_out;  // strips whose prisms stay flat or inverted
  int most_layers = 0, least_layers = 0;
  bool thinned = false;  // rows or sides were left out for the number of vertices
  double thickness = 0;  // m, median of the strips'; 0: there are tubes alone
};

// The fewest vertices that these strips can have with as many layers as asked for, or with 4.
int fewestVertices(const std::vector<StripRows>& strips, const StripMeshOptions& options);

// Metres. No more vertices than asked for where fewestVertices lets them be so few. Throws std::runtime_error where no
// strip is left or the vertices are over kMaxStripVertices.
StripMesh meshOfStrips(const std::vector<StripRows>& strips, const StripMeshOptions& options);

}  // namespace app
