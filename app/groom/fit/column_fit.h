// Positions of columns by least squares over strands that root in their faces.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "app/groom/fit/block_matrix.h"
#include "app/groom/fit/growth_map.h"
#include "app/groom/fit/strand_samples.h"
#include "sim/mesh/hair_mesh.h"

namespace app {

// What the fit asks of one strand: where it should pass each layer, and how much that counts.
struct StrandTarget {
  int face = 0;  // that it roots in
  GrowthRow row;
  std::vector<Eigen::Vector3f> layers;  // m
  std::vector<float> weight;            // per layer
  // Where along the smooth curve through `layers` each layer is now, the point there and the curve's direction: a layer
  // may lie anywhere along a strand, so that only its distance from the strand counts in full.
  std::vector<float> slid;
  std::vector<Eigen::Vector3f> at, along;
};

// Slides every target's layers to where the strand is nearest to what the shape grows there.
void slideTargets(const sim::HairMeshShape& shape, std::vector<StrandTarget>& targets);

// The layer points of the smooth curve that follows the strand's samples best; `length` (m) is what the last knot
// stands for. Layers beyond the strand's end go straight on and count little.
void layerTargets(std::span<const Eigen::Vector3f> samples, double strand_length, double length,
                  const std::vector<double>& knots, StrandTarget& target);

// The layer parameter of a share of the length, and back.
double layerOf(const std::vector<double>& knots, double share);

// Least squares over the strands for all columns but their roots: |A x - b|^2 of the targets, with neighbouring
// columns' ways from their roots held alike a little. Vertex (column c, layer l > 0) is unknown u = c * (layers - 1) +
// l - 1.
struct ColumnSystem {
  int columns = 0, layers = 0;
  double usual = 1;                 // mean diagonal entry
  std::vector<MatrixBlock> blocks;  // of the normal matrix; of unknowns
  Eigen::VectorXd right;

  int unknown(int column, int layer) const { return column * (layers - 1) + layer - 1; }
  int unknowns() const { return columns * (layers - 1); }
};

// What columns are held to beside their strands. Empty: nothing more.
struct ColumnHold {
  std::span<const double> alike = {};  // one a column: of the weight of neighbours' difference; an edge has the larger
  std::span<const sim::Vec3> toward = {};  // m, one a vertex: where it would be if its strands told nothing
  std::span<const double> weights = {};    // one a column: of that, beside its strands
};

ColumnSystem columnSystem(const std::vector<StrandTarget>& targets, const sim::HairMeshShape& shape,
                          const ColumnHold& hold = {});

// How often, and with how heavy penalties over the strands' weight at first and at last. `anew` begins without any,
// else from the shape as it is.
struct FitRounds {
  int count = 5;
  double first = 0.1, last = 100;
  bool anew = false;
};

// Moves all but the roots to where the system's error is least with every corner tetrahedron at least `fatness` fat
// (app/styles/style_untangle.h) and every edge 3.5 mm long: by Gauss-Newton steps in which what is too flat or short is
// a penalty that grows.  Returns the smallest fatness reached,
// which can lack a little.
double fitColumns(const ColumnSystem& system, double fatness, const FitRounds& rounds, sim::HairMeshShape& shape);

}  // namespace app
