// Deformation minimization: after position correction has moved some vertices, moves all others so that edge vectors
// change least (Wu and Yuksel 2016, equations (3) and (4), figures 4 and 5).
//
//   minimize sum over edges |(x''_i - x''_j) - (x_i - x_j)|^2, corrected vertices, resting contacts and roots held
//
// In displacements u = x'' - x this is Laplace's equation on the edge graph, A^T A u = 0 at the free vertices, where A
// is the edge connection matrix: constant, so made once.
#pragma once

#include <span>
#include <vector>

#include "sim/hair_mesh.h"

namespace sim {

// A^T A of the hair mesh's edges, the scalp layer's included, as a graph: row i has degree[i] on the diagonal and -1 at
// each neighbour.
struct EdgeLaplacian {
  std::vector<int> row_first{0}, neighbours;
  int size() const { return static_cast<int>(row_first.size()) - 1; }
  int degree(int i) const { return row_first[i + 1] - row_first[i]; }
};
EdgeLaplacian makeEdgeLaplacian(const HairMesh& mesh);

struct MinimizationScratch {
  std::vector<Vec3> r, z, d, q;
};

// Modified PCG from `displacement` (u' = x' - x: the corrections where held, anything elsewhere), which it overwrites
// at the vertices not held. Stops at a residual of `tolerance` times the first (both in the diagonal's inverse norm).
// Returns the iterations; zero, with no work done, when no held vertex has moved.
int minimizeDeformation(const EdgeLaplacian& laplacian, std::span<const unsigned char> held, double tolerance,
                        MinimizationScratch& scratch, std::span<Vec3> displacement);

}  // namespace sim
