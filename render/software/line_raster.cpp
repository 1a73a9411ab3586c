#include "render/software/line_raster.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "shaders/shared.h"

namespace render {
namespace {

// Rows [begin, end).
struct Rows {
  int begin = 0, end = 0;
};

// Calls visit(texel, depth) for the texels of a line in some rows: one a step of its longer axis, where it passes a
// texel's middle.
template <class Visit>
void walkLine(const LinePoint& from, const LinePoint& to, int side, const Rows& rows, const Visit& visit) {
  const float dx = to.x - from.x, dy = to.y - from.y;
  const bool flat = std::abs(dx) >= std::abs(dy);
  const float begin = flat ? from.x : from.y, length = flat ? dx : dy;
  if (length == 0) return;
  const Rows steps = flat ? Rows{0, side} : rows, across_rows = flat ? rows : Rows{0, side};
  const float low = std::min(begin, begin + length), high = std::max(begin, begin + length);
  const int first = std::max(static_cast<int>(std::ceil(low - 0.5f)), steps.begin),
            end = std::min(static_cast<int>(std::ceil(high - 0.5f)), steps.end);
  for (int step = first; step < end; ++step) {
    const float share = (static_cast<float>(step) + 0.5f - begin) / length;
    const float across = flat ? from.y + share * dy : from.x + share * dx;
    const float depth = from.depth + share * (to.depth - from.depth);
    if (!(across >= static_cast<float>(across_rows.begin)) || across >= static_cast<float>(across_rows.end)) continue;
    if (depth < 0 || depth > 1) continue;
    const int other = static_cast<int>(across);
    visit(static_cast<std::size_t>(flat ? other * side + step : step * side + other), depth);
  }
}

// Calls visit(from, to) for the segments of all strands.
template <class Visit>
void eachSegment(const StoredLines& lines, const Visit& visit) {
  for (std::size_t n = 0; n < lines.points.size(); ++n) {
    const LinePoint* points = &lines.line_points[n * lines.stride];
    for (std::uint32_t i = 0; i + 1 < lines.points[n]; ++i) visit(points[i], points[i + 1]);
  }
}

// Of each layer, how far behind the first hair it ends, m; the eighth takes all.
std::array<float, 8> layerReach(float thickness) {
  std::array<float, 8> reach{};
  float sum = 0;
  for (std::size_t layer = 0; layer < shared::kMaxOpacityLayers; ++layer) {
    sum += thickness;
    thickness *= shared::kLayerGrowth;
    reach[layer] = sum;
  }
  reach[7] = 1e30f;
  return reach;
}

void rasterizeRows(const StoredLines& lines, const Rows& rows, OpacityTile& tile) {
  const auto first = static_cast<std::ptrdiff_t>(rows.begin) * tile.side,
             count = static_cast<std::ptrdiff_t>(rows.end - rows.begin) * tile.side;
  std::fill_n(tile.depth.begin() + first, count, 1.0f);
  std::fill_n(tile.near.begin() + first, count, std::array<float, 4>{});
  std::fill_n(tile.far.begin() + first, count, std::array<float, 4>{});
  eachSegment(lines, [&](const LinePoint& from, const LinePoint& to) {
    walkLine(from, to, tile.side, rows,
             [&](std::size_t at, float depth) { tile.depth[at] = std::min(tile.depth[at], depth); });
  });
  const std::array<float, 8> reach = layerReach(tile.thickness);
  eachSegment(lines, [&](const LinePoint& from, const LinePoint& to) {
    walkLine(from, to, tile.side, rows, [&](std::size_t at, float depth) {
      const float behind = (depth - tile.depth[at]) * tile.depth_range;
      for (std::size_t k = 0; k < 4; ++k) {
        tile.near[at][k] += behind < reach[k] ? to.opacity : 0.0f;
        tile.far[at][k] += behind < reach[k + 4] ? to.opacity : 0.0f;
      }
    });
  });
}

}  // namespace

void rasterizeLines(const StoredLines& lines, OpacityTile& tile, int bands) {
  const auto texels = static_cast<std::size_t>(tile.side) * static_cast<std::size_t>(tile.side);
  tile.depth.resize(texels);
  tile.near.resize(texels);
  tile.far.resize(texels);
  inBands(bands, [&](int band) {
    rasterizeRows(lines, {band * tile.side / bands, (band + 1) * tile.side / bands}, tile);
  });
}

}  // namespace render
