// Connected pieces of a polygon mesh: the cards, sheets of joined cards and tubes of a hairstyle.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "app/groom/strips/polygon_mesh.h"

namespace app {

// A piece whose faces are joined by edges. Vertices at one place are one; faces that repeat another are left out.
struct StripPatch {
  int object = 0;                            // of the first face
  std::vector<Eigen::Vector3d> at;           // per vertex
  std::vector<std::vector<int>> faces;       // corners
  std::vector<std::vector<int>> neighbours;  // per vertex: over an edge
  std::vector<std::vector<int>> loops;       // boundaries, each in order
  bool simple = true;                        // no vertex is passed twice by a boundary, no edge has three faces
  std::vector<double> angle;                 // rad per vertex: sum of its faces' angles
  std::vector<int> face_count;               // per vertex
};

// The pieces of those faces whose object is taken, in the order of their first faces. Vertices of different pieces
// nearer than `join` (the file's unit) become one before; 0: only those at the same place.
std::vector<StripPatch> stripPatches(const PolygonMesh& mesh, const std::vector<bool>& object_taken, double join);

}  // namespace app
