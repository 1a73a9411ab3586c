#include "render/software/strand_raster.h"

#include <algorithm>
#include <cmath>

namespace render {
namespace {

using Lanes = float __attribute__((vector_size(16)));
using Bits = std::int32_t __attribute__((vector_size(16)));

constexpr Bits kNone{0, 0, 0, 0};

Lanes all(float x) {
  return Lanes{x, x, x, x};
}

struct Point {
  float x, y;
};

// a x + b y + c, at the samples of the pixel at the origin: not negative on the inner side of an edge.
struct Edge {
  float a = 0, b = 0;
  Lanes at{0, 0, 0, 0};
};

Edge edgeOf(const Point& from, const Point& to, float turn, const SamplePattern& pattern) {
  Edge edge{turn * (from.y - to.y), turn * (to.x - from.x), {}};
  for (int s = 0; s < kMaxRasterSamples; ++s)
    edge.at[s] = edge.a * (pattern.x[s] - from.x) + edge.b * (pattern.y[s] - from.y);
  return edge;
}

float turnOf(const Point& a, const Point& b, const Point& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

// How far along a segment a place lies: 0 at its first point, 1 at its second.
struct Progress {
  float a = 0, b = 0, c = 0;
};

Progress progressOf(const Point& from, const Point& to) {
  const float x = to.x - from.x, y = to.y - from.y, squared = x * x + y * y;
  if (squared < 1e-12f) return {};
  return {x / squared, y / squared, -(x * from.x + y * from.y) / squared};
}

struct Segment {
  Progress progress;
  float depth = 0, depth_step = 0;  // at its first point, and to its second
  float coverage = 0, coverage_step = 0;
  float dither = 0;
  std::uint32_t point = 0;
};

// How many samples a ribbon of some coverage takes, and which: as strand.frag.
int takenCount(float coverage, float dither, int samples) {
  return static_cast<int>(std::clamp(coverage, 0.0f, 1.0f) * static_cast<float>(samples) + dither);
}

Bits takenSamples(int taken, float dither, int samples) {
  const float turns = dither * 61.803f;
  const int turn = static_cast<int>((turns - std::floor(turns)) * static_cast<float>(samples));
  const int mask = (1 << taken) - 1, turned = (mask << turn) | (mask >> (samples - turn));
  Bits bits = kNone;
  for (int s = 0; s < samples; ++s) bits[s] = ((turned >> s) & 1) != 0 ? -1 : 0;
  return bits;
}

bool any(const Bits& bits) {
  return (bits[0] | bits[1] | bits[2] | bits[3]) != 0;
}

// Where all four edges hold, shows a segment at the samples that it takes and that nothing nearer has.
void fill(const std::array<Edge, 4>& edges, const Segment& segment, const PixelBox& box, SampleGrid& grid) {
  const SamplePattern& pattern = grid.pattern;
  const Progress& along = segment.progress;
  Lanes share;
  for (int s = 0; s < kMaxRasterSamples; ++s) share[s] = along.a * pattern.x[s] + along.b * pattern.y[s] + along.c;
  const int taken = takenCount(segment.coverage, segment.dither, pattern.count);
  const bool even = taken == takenCount(segment.coverage + segment.coverage_step, segment.dither, pattern.count);
  const Bits always = takenSamples(taken, segment.dither, pattern.count);
  for (int y = box.low_y; y < box.high_y; ++y) {
    const auto row = static_cast<float>(y);
    SampledPixel* pixels = &grid.pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(grid.width)];
    for (int x = box.low_x; x < box.high_x; ++x) {
      const auto column = static_cast<float>(x);
      Bits inside = edges[0].at + all(edges[0].a * column + edges[0].b * row) >= all(0);
      for (int k = 1; k < 4; ++k) inside &= edges[k].at + all(edges[k].a * column + edges[k].b * row) >= all(0);
      if (!any(inside)) continue;
      const float middle = along.a * (column + 0.5f) + along.b * (row + 0.5f) + along.c,
                  at = std::clamp(middle, 0.0f, 1.0f);
      inside &=
          even ? always
               : takenSamples(takenCount(segment.coverage + at * segment.coverage_step, segment.dither, pattern.count),
                              segment.dither, pattern.count);
      Lanes depth;
      Bits shown;
      __builtin_memcpy(&depth, pixels[x].depth.data(), sizeof(depth));
      __builtin_memcpy(&shown, pixels[x].shown.data(), sizeof(shown));
      const Lanes own = all(segment.depth) + segment.depth_step * (share + all(along.a * column + along.b * row));
      inside &= own < depth;
      const auto number = static_cast<std::int32_t>(segment.point << 8u | static_cast<std::uint32_t>(255 * at + 0.5f));
      depth = inside ? own : depth;
      shown = inside ? Bits{number, number, number, number} : shown;
      __builtin_memcpy(pixels[x].depth.data(), &depth, sizeof(depth));
      __builtin_memcpy(pixels[x].shown.data(), &shown, sizeof(shown));
    }
  }
}

PixelBox boxAround(const std::array<Point, 4>& corners, const SampleGrid& grid) {
  const auto [left, right] = std::minmax({corners[0].x, corners[1].x, corners[2].x, corners[3].x});
  const auto [below, above] = std::minmax({corners[0].y, corners[1].y, corners[2].y, corners[3].y});
  const auto pixel = [](float at, int size) {
    return static_cast<int>(std::clamp(at, 0.0f, static_cast<float>(size)));
  };
  return {pixel(left, grid.width), pixel(below, grid.height), pixel(right + 1, grid.width),
          pixel(above + 1, grid.height)};
}

// The two triangles of a strip's step: from (0, 1) to (3, 2), around them. A step that turns over itself is no
// quadrilateral, and is filled triangle by triangle.
void fillStep(const std::array<Point, 4>& corners, const Segment& segment, const PixelBox& box, SampleGrid& grid) {
  const SamplePattern& pattern = grid.pattern;
  std::array<float, 4> turns;
  for (std::size_t k = 0; k < 4; ++k) turns[k] = turnOf(corners[(k + 3) & 3], corners[k], corners[(k + 1) & 3]);
  const auto [least, most] = std::minmax({turns[0], turns[1], turns[2], turns[3]});
  if (least >= 0 || most <= 0) {
    const float turn = most > 0 ? 1.0f : -1.0f;
    std::array<Edge, 4> edges;
    for (std::size_t k = 0; k < 4; ++k) edges[k] = edgeOf(corners[k], corners[(k + 1) & 3], turn, pattern);
    fill(edges, segment, box, grid);
    return;
  }
  for (const std::array<std::size_t, 3>& of : {std::array<std::size_t, 3>{0, 1, 3}, {1, 2, 3}}) {
    const float turn = turnOf(corners[of[0]], corners[of[1]], corners[of[2]]) > 0 ? 1.0f : -1.0f;
    std::array<Edge, 4> edges{};
    for (std::size_t k = 0; k < 3; ++k) edges[k] = edgeOf(corners[of[k]], corners[of[(k + 1) % 3]], turn, pattern);
    fill(edges, segment, box, grid);
  }
}

Segment segmentOf(const RibbonEdges& from, const RibbonEdges& to) {
  Segment segment;
  segment.progress = progressOf({0.5f * (from.left_x + from.right_x), 0.5f * (from.left_y + from.right_y)},
                                {0.5f * (to.left_x + to.right_x), 0.5f * (to.left_y + to.right_y)});
  segment.depth = from.depth;
  segment.depth_step = to.depth - from.depth;
  segment.coverage = from.coverage;
  segment.coverage_step = to.coverage - from.coverage;
  return segment;
}

constexpr int kStripe = 32;  // rows; bands take stripes in turns, for hair is not as thick everywhere

// Calls visit(part) for the parts of a box in a band's stripes.
template <class Visit>
void eachStripe(const PixelBox& box, int band, int bands, const Visit& visit) {
  for (int stripe = box.low_y / kStripe; stripe * kStripe < box.high_y; ++stripe) {
    if (stripe % bands != band) continue;
    visit(PixelBox{box.low_x, std::max(box.low_y, stripe * kStripe), box.high_x,
                   std::min(box.high_y, (stripe + 1) * kStripe)});
  }
}

// Shows the strands in the stripes of a band.
PixelBox rasterizeBand(const StoredHair& hair, int band, int bands, SampleGrid& grid) {
  PixelBox touched;
  for (std::size_t n = 0; n < hair.strands.size(); ++n) {
    const StoredStrand& strand = hair.strands[n];
    for (std::size_t i = 0; i + 1 < strand.points; ++i) {
      const std::size_t at = n * hair.stride + i;
      const RibbonEdges &from = hair.points[at], &to = hair.points[at + 1];
      if (from.depth < 0 || to.depth < 0) continue;
      const std::array<Point, 4> corners{
          {{from.left_x, from.left_y}, {from.right_x, from.right_y}, {to.right_x, to.right_y}, {to.left_x, to.left_y}}};
      const PixelBox box = boxAround(corners, grid);
      if (box.empty()) continue;
      eachStripe(box, band, bands, [&](const PixelBox& part) {
        touched.add(part);
        Segment segment = segmentOf(from, to);
        segment.dither = strand.dither;
        segment.point = hair.first_point + static_cast<std::uint32_t>(at);
        fillStep(corners, segment, part, grid);
      });
    }
  }
  return touched;
}

}  // namespace

void PixelBox::add(const PixelBox& other) {
  if (other.empty()) return;
  if (empty()) {
    *this = other;
    return;
  }
  low_x = std::min(low_x, other.low_x);
  low_y = std::min(low_y, other.low_y);
  high_x = std::max(high_x, other.high_x);
  high_y = std::max(high_y, other.high_y);
}

PixelBox rasterizeStrands(const StoredHair& hair, SampleGrid& grid, int bands) {
  std::vector<PixelBox> touched(static_cast<std::size_t>(bands));
  inBands(bands, [&](int band) { touched[static_cast<std::size_t>(band)] = rasterizeBand(hair, band, bands, grid); });
  PixelBox all;
  for (const PixelBox& box : touched) all.add(box);
  return all;
}

void clearSamples(const PixelBox& box, SampleGrid& grid) {
  SampledPixel none;
  none.depth.fill(1);
  none.shown.fill(0);
  for (int y = box.low_y; y < box.high_y; ++y) {
    SampledPixel* row = &grid.pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(grid.width)];
    std::fill(row + box.low_x, row + box.high_x, none);
  }
}

void markSeen(const PixelBox& box, const SampleGrid& grid, std::vector<std::uint8_t>& seen) {
  for (int y = box.low_y; y < box.high_y; ++y) {
    const SampledPixel* row = &grid.pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(grid.width)];
    for (int x = box.low_x; x < box.high_x; ++x) {
      for (int s = 0; s < grid.pattern.count; ++s) {
        if (row[x].depth[static_cast<std::size_t>(s)] >= 1) continue;
        const std::uint32_t point = row[x].shown[static_cast<std::size_t>(s)] >> 8u;
        seen[point] = seen[point + 1] = 1;
      }
    }
  }
}

}  // namespace render
