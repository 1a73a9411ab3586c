// Hair as a density on a lattice, and optical depths through it. The lattice stands still in the frame of its points:
// where bounds move, nodes join and leave at the border, and none of the others moves.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "render/view_math.h"

namespace render {

class DensityGrid {
 public:
  // An empty lattice around the bounds. Its cells are kCell wide, or twice, four times that where it would have more
  // than kMaxNodes a side.
  void place(const Bounds& bounds);
  // Spreads extinction (m^2 of projected hair) over the nodes around a point.
  void add(const Eigen::Vector3f& at, float extinction);

  // 1/m.
  float density(const Eigen::Vector3f& at) const { return sample(density_, at); }
  // Optical depth from every node along a unit direction, plane by plane; for sample.
  void sweep(const Eigen::Vector3f& direction, std::vector<float>& depth);
  // Of values at the nodes: trilinear; 0 outside.
  float sample(std::span<const float> values, const Eigen::Vector3f& at) const;

  float cell() const { return cell_; }                     // m
  const Eigen::Vector3i& low() const { return low_; }      // the first node, in cells
  const Eigen::Vector3i& nodes() const { return nodes_; }  // a side; of values at the nodes z is next to z

 private:
  Eigen::Vector3i low_ = Eigen::Vector3i::Zero(), nodes_ = Eigen::Vector3i::Zero();  // first node; nodes a side
  float cell_ = 0;
  std::vector<float> density_;         // 1/m
  std::vector<float> plane_, before_;  // of a sweep, with a border of zeros
};

}  // namespace render
