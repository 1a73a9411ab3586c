// Closed triangle surfaces of a polygon file: welded, wound outwards, sampled.
#pragma once

#include <array>
#include <vector>

#include "app/groom/strips/polygon_mesh.h"
#include "sim/mesh/hair_mesh.h"

namespace app {

struct ClosedSurface {
  std::vector<sim::Vec3> points;  // welded
  std::vector<std::array<int, 3>> faces;
};

// Places of a file that are one, with faces as triangles.
ClosedSurface weld(const PolygonMesh& mesh);

// Edges that lack the face of their other side.
int openEdges(const ClosedSurface& surface);

// Turns round the pieces whose faces are wound inwards: those of negative volume. Returns the number of pieces.
int turnOutwards(ClosedSurface& surface);

// Share of the faces that belong to the piece with most of them, 0 to 1.
double largestPiece(const ClosedSurface& surface);

// Points all over the surface, 8 mm apart where its triangles are larger (m).
std::vector<sim::Vec3> samplesOf(const ClosedSurface& surface);

}  // namespace app
