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

// A^T A over all edges of the hair mesh: row i has degree(i) on the diagonal and -1 at each neighbour.
struct EdgeLaplacian {
  std::vector<int> row_first{0}, neighbours;
  int size() const { return static_cast<int>(row_first.size()) - 1; }
  int degree(int i) const { return row_first[i + 1] - row_first[i]; }
};
EdgeLaplacian makeEdgeLaplacian(const HairMesh& mesh);

struct MinimizationScratch {
  std::vector<Vec3> r, z, d, q;
};

// Modified PCG. `displacement`: u' = x' - x at held vertices, a start value at all others, where the result replaces
// it. Stops at a residual of `tolerance` times the first, both in the norm of the diagonal's inverse, or after `most`
// iterations. Returns the iterations; zero, with no work done, when no held vertex has moved.
inline constexpr int kMaxMinimization = 2000;
int minimizeDeformation(const EdgeLaplacian& laplacian, std::span<const unsigned char> held, double tolerance,
                        MinimizationScratch& scratch, std::span<Vec3> displacement, int most = kMaxMinimization);

// The same, solved exactly where few vertices are held. A^T A = L D L^T, with the roots alone held, is factored once.
// L^-1 e_i is nonzero only on the elimination-tree path of i (Gilbert and Peierls 1988), so it is cached per held
// vertex, as are the products e_i^T (A^T A)^-1 e_k. A dense system of these gives the forces that move the held
// vertices to their places; one backward substitution then moves all others. Above kMaxHeld vertices Modified PCG
// serves. What is cached changes no result.
class DeformationMinimizer {
 public:
  static constexpr int kMaxHeld = 96;  // paths cached: 0.8 MB at 10,241 vertices

  explicit DeformationMinimizer(const HairMesh& mesh);  // factors the matrix

  // As minimizeDeformation; roots must be held, and do not move. Returns the iterations or, solved exactly, one plus
  // the number of paths computed; zero with no work done. Allocates nothing.
  int minimize(std::span<const unsigned char> held, double tolerance, std::span<Vec3> displacement,
               int most = kMaxMinimization);
  bool iterated() const { return iterated_; }  // the last call, by Modified PCG

 private:
  bool iterated_ = false;
  EdgeLaplacian laplacian_;
  MinimizationScratch scratch_;
  std::vector<unsigned char> root_;
  // Column j of L below its diagonal: entries first_[j] ... first_[j + 1] - 1 of below_, in rows row_of_, ascending;
  // the first is the parent of j in the elimination tree. inverse_d_: of D.
  std::vector<int> first_, row_of_;
  std::vector<double> below_, inverse_d_;
  std::vector<int> row_;   // per vertex, in the factor's order; -1: a root
  std::vector<int> slot_;  // per vertex: slot of its cached path, or -1
  struct Kept {
    int vertex = -1;
    long used = 0;  // call of the last use
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
  int findPaths();  // of held_; returns the number computed
  void computePath(Kept& kept);
  double productOf(const Kept& a, const Kept& b) const;
};

}  // namespace sim
