// Signed distances to triangles, sampled on a grid: exact near the surface, a distance transform farther away. The sign
// is voted by crossings along the three axes, so that bodies of several overlapping or slightly open pieces still have
// an inside.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "app/figure/character.h"

namespace app {

using Triangle = std::array<Vec3, 3>;  // counter-clockwise from outside

struct SignedGrid {
  std::array<int, 3> n{};  // nodes, x runs fastest
  Vec3 low = Vec3::Zero();
  double h = 0.007;  // m
  std::vector<float> distance;

  std::size_t index(int i, int j, int k) const { return (static_cast<std::size_t>(k) * n[1] + j) * n[0] + i; }
  Vec3 point(int i, int j, int k) const { return low + h * Vec3(i, j, k); }
  // Trilinear; outside the box the distance to it is added.
  double interpolate(const Vec3& p) const;
};

// A grid of spacing h over the box, its values not yet filled in.
SignedGrid layOutGrid(const Vec3& low, const Vec3& high, double h);

// What distances inside are measured to where pieces overlap: all triangles, or those alone that bound all pieces
// together.
enum class Pieces { kAll, kOneSolid };

// Fills the values in: exact within `band` (m) of the triangles.
void fillGrid(const std::vector<Triangle>& triangles, double band, Pieces pieces, SignedGrid& grid);

}  // namespace app
