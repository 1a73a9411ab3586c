// Rasterizes strands' ribbons on the CPU, sample by sample, for drivers that rasterize in software: those spend a block
// of pixels on every triangle, and a strand's are smaller than a pixel is wide. No OpenGL.
//
// Covers the samples that OpenGL's triangles cover (render/../shaders/strand.frag says which of them a thin strand
// takes), but for those on an edge to within its rounding. A segment that reaches before the near plane is left out.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "render/software/bands.h"

namespace render {

// A ribbon's point as strand_points.comp stores it. Pixels, from below; depth 0..1, negative before the near plane.
struct RibbonEdges {
  float left_x, left_y, right_x, right_y;
  float depth, coverage, unused[2];
};

struct StoredStrand {
  std::uint32_t points;
  float dither;
  std::uint32_t key, clump_key;
  std::array<float, 4> share{};  // painted, of its root: colour, roughness; for the shading
};

inline constexpr int kMaxRasterSamples = 4;
inline constexpr std::uint32_t kMaxRasterPoints = 1u << 24;  // a sample keeps its point's number in 24 bits

// Where the samples of a pixel lie in it.
struct SamplePattern {
  int count = 1;
  std::array<float, kMaxRasterSamples> x{0.5f, 0.5f, 0.5f, 0.5f}, y{0.5f, 0.5f, 0.5f, 0.5f};
};

// A pixel's samples: the nearest ribbon's depth (1: none), and the point that its segment starts at with the share of
// the segment in the low 8 bits.
struct SampledPixel {
  std::array<float, kMaxRasterSamples> depth;
  std::array<std::uint32_t, kMaxRasterSamples> shown;
};

// Pixels [low, high).
struct PixelBox {
  int low_x = 0, low_y = 0, high_x = 0, high_y = 0;
  bool empty() const { return low_x >= high_x || low_y >= high_y; }
  void add(const PixelBox& other);
};

// Pixels row by row from below, all of them without samples at first.
struct SampleGrid {
  std::span<SampledPixel> pixels;
  int width = 0, height = 0;
  SamplePattern pattern;
};

// The strands of a hair, the points of strand n from n * stride on; the number of the hair's first point in the
// picture.
struct StoredHair {
  std::span<const StoredStrand> strands;
  std::span<const RibbonEdges> points;
  std::uint32_t stride = 0, first_point = 0;
};

// Returns the pixels that it may have touched. The samples are the same for every number of bands.
PixelBox rasterizeStrands(const StoredHair& hair, SampleGrid& grid, int bands = bandCount());

// Takes all samples off the pixels of a box.
void clearSamples(const PixelBox& box, SampleGrid& grid);

// Marks in `seen` the points between which a sample lies.
void markSeen(const PixelBox& box, const SampleGrid& grid, std::vector<std::uint8_t>& seen);

}  // namespace render
