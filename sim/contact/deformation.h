// Deformation minimization: after position correction has moved some vertices, moves all others so that edge vectors
// change least (Wu and Yuksel 2016, equations (3) and (4), figures 4 and 5).
//
//   minimize sum over edges |(x''_i - x''_j) - (x_i - x_j)|^2, corrected vertices, resting contacts and roots held
//
// In displacements u = x'' - x this is Laplace's equation on the edge graph, A^T A u = 0 at the free vertices, where A
// is the edge connection matrix: constant, so made once.
#pragma once

#include <Eigen/Dense>
#include <span>
#include <vector>

#include "sim/linear/lanes.h"
#include "sim/mesh/hair_mesh.h"

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

// The same for some held vertices, exactly and at the price of one backward substitution: the matrix, only its roots
// held, is factored once, A^T A = L D L^T. What a pull at a vertex makes of the forward half, L^-1 e, lies on its path
// through the elimination tree (Gilbert and Peierls 1988) and is kept from step to step, as are the products of two
// such, which tell how far one pull moves the other's vertex. A small dense system of these says how hard each held
// vertex must be pulled to go where it is to. Beyond kMaxHeld vertices the iterations above serve, to `tolerance`.
class DeformationMinimizer {
 public:
  static constexpr int kMaxHeld = 96;  // paths kept: 0.8 MB at 10,241 vertices

  explicit DeformationMinimizer(const HairMesh& mesh);  // factors the matrix

  // As minimizeDeformation; roots must be held, and stay. Returns the iterations or, of the exact way, the paths
  // computed anew plus one; zero with no work done. Allocates nothing.
  int minimize(std::span<const unsigned char> held, double tolerance, std::span<Vec3> displacement);

 private:
  EdgeLaplacian laplacian_;
  MinimizationScratch scratch_;
  std::vector<unsigned char> root_;
  // The factor: column j of L below its diagonal is below_[first_[j]] ... in the rows row_of_, ascending, so that the
  // first of them is its parent in the tree; and the inverse of D.
  std::vector<int> first_, row_of_;
  std::vector<double> below_, inverse_d_;
  std::vector<int> row_;   // per vertex, in the factor's order; -1: a root
  std::vector<int> slot_;  // per vertex: where its path is kept, or -1
  struct Kept {
    int vertex = -1;
    long used = 0;  // when last
    std::vector<int> path;
    std::vector<double> half;  // L^-1 e along it
  };
  std::vector<Kept> kept_;
  long now_ = 0;
  Eigen::MatrixXd products_;      // of two slots: e^T A^-1 e
  Eigen::MatrixXd gram_, pulls_;  // of the held vertices
  std::vector<double> work_;      // per row, zero between calls
  LineVector<double> moved_;      // four a row: x, y, z and none
  std::vector<int> held_;         // vertices

  void factor();
  int findPaths();  // of held_; the number that were computed
  void computePath(Kept& kept);
  double productOf(const Kept& a, const Kept& b) const;
};

}  // namespace sim
