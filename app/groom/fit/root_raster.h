// The roots of a groom on a flat map of the scalp, in square cells, and the regions of hair that goes one way.
//
// The map is azimuthal equidistant about the middle direction of the roots, seen from the head's middle: distances from
// the map's origin, and near it all distances, are those on the scalp.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "app/groom/fit/strand_samples.h"

namespace app {

// The scalp as a map. Directions are seen from `center`.
struct ScalpMap {
  Eigen::Vector3f center = Eigen::Vector3f::Zero();  // m
  Eigen::Vector3f pole = Eigen::Vector3f::UnitY(), axis_u = Eigen::Vector3f::UnitX(),
                  axis_v = -Eigen::Vector3f::UnitZ();  // right-handed: u x v = pole
  float radius = 0.09f;                                // m, the mean distance of the roots

  Eigen::Vector2f toMap(const Eigen::Vector3f& point) const;   // m
  Eigen::Vector3f direction(const Eigen::Vector2f& at) const;  // unit
};

// The sphere that fits the roots best; where they cover too little to tell, a head's size under them.
ScalpMap fitScalpMap(const StrandSamples& strands);

struct RootCell {
  int strands = 0;  // 0 with a region: filled in between others
  int region = -1;
  float radius = 0;                   // m, of the roots from the map's centre
  float length = 0;                   // m, that most strands here do not exceed
  std::vector<Eigen::Vector3f> path;  // m, mean strand by share of its length; empty outside
  float path_strands = 0;             // m, mean length of its strands: that of the path and of their curls
};

// Cell (x, y) is number y * columns + x; its lower corner is origin + size * (x, y).
struct RootRaster {
  ScalpMap map;
  Eigen::Vector2f origin = Eigen::Vector2f::Zero();  // m, on the map
  float size = 0;                                    // m, of a cell
  int columns = 0, rows = 0;
  int regions = 0;
  std::vector<RootCell> cells;
  std::vector<int> cell_of;  // per strand
  // Per corner of the cells, (columns + 1) x (rows + 1): the hair parts here, and what lies on either side stays apart.
  std::vector<std::uint8_t> split;

  int cellAt(const Eigen::Vector2f& at) const;  // clamped to the raster
  int regionAt(int x, int y) const {
    return x < 0 || y < 0 || x >= columns || y >= rows ? -1 : cells[static_cast<std::size_t>(y * columns + x)].region;
  }
  float radiusAt(const Eigen::Vector2f& at) const;  // m, bilinear over the cells that have one
  float lengthAt(const Eigen::Vector2f& at) const;  // m, likewise
  Eigen::Vector3f skinAt(const Eigen::Vector2f& at) const;
};

// Cells as fine as a few strands each allow, at least 3 mm; holes smaller than 3 cm^2 are filled. Without regions yet:
// root_tears.h.
RootRaster rasterRoots(const StrandSamples& strands);

// Angle-like: how much two strands' distance grows, over their length up to there.
double divergence(const std::vector<Eigen::Vector3f>& a, const std::vector<Eigen::Vector3f>& b);

}  // namespace app
