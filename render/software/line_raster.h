// Rasterizes the strands that cast a hair's shadow into its deep opacity map, on the CPU, for drivers that rasterize in
// software. No OpenGL. What it fills is what strand_shadow.geom and opacity.frag draw.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "render/software/bands.h"

namespace render {

// A point of a strand in its map: texels from the tile's corner, depth 0..1, and the opacity of the line that ends
// there.
struct LinePoint {
  float x, y, depth, opacity;
};

// The strands of a map, the points of strand n from n * stride on.
struct StoredLines {
  std::span<const std::uint32_t> points;  // of each strand
  std::span<const LinePoint> line_points;
  std::uint32_t stride = 0;
};

// A tile of a deep opacity map, row by row.
struct OpacityTile {
  int side = 0;                                 // texels
  float depth_range = 1;                        // m
  float thickness = 0.01f;                      // m, of the first layer
  std::vector<float> depth;                     // of the first hair, 1 where there is none
  std::vector<std::array<float, 4>> near, far;  // opacity of layers 0..3; of 4..6 and of all hair
};

// Fills depth, near and far, the same for every number of bands.
void rasterizeLines(const StoredLines& lines, OpacityTile& tile, int bands = bandCount());

}  // namespace render
