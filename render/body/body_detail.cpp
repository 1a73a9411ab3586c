#include "render/body/body_detail.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

namespace render {
namespace {

constexpr float kCellPixels = 1;  // at most, of a cell in the picture
constexpr float kKeep = 1.25f;    // times as many for a level that is there already

// What merged vertices share: cell, main joint, octant of the normal.
using Place = std::tuple<int, int, int, int, int>;

Place placeOf(const BodyInput& input, std::size_t v, float cell) {
  const auto at = [&](std::size_t k) { return static_cast<int>(std::floor(input.positions[3 * v + k] / cell)); };
  int side = 0;
  for (std::size_t k = 0; k < 3; ++k) side |= (input.normals[3 * v + k] < 0 ? 1 : 0) << k;
  return {at(0), at(1), at(2), mainJoint(input, v), side};
}

// Of the vertices members[begin, end), the one nearest their mean.
std::uint32_t middleOf(const BodyInput& input, const std::vector<std::uint32_t>& members, std::size_t begin,
                       std::size_t end) {
  std::array<float, 3> mean{};
  for (std::size_t i = begin; i < end; ++i) {
    for (std::size_t k = 0; k < 3; ++k)
      mean[k] += input.positions[3 * members[i] + k] / static_cast<float>(end - begin);
  }
  const auto away = [&](std::uint32_t v) {
    return std::hypot(input.positions[3 * v] - mean[0], input.positions[3 * v + 1] - mean[1],
                      input.positions[3 * v + 2] - mean[2]);
  };
  return *std::min_element(members.begin() + static_cast<long>(begin), members.begin() + static_cast<long>(end),
                           [&](std::uint32_t a, std::uint32_t b) { return away(a) < away(b); });
}

}  // namespace

int mainJoint(const BodyInput& input, std::size_t vertex) {
  const float* weights = &input.weights[4 * vertex];
  const auto largest = std::max_element(weights, weights + 4) - weights;
  return input.joints[4 * vertex + static_cast<std::size_t>(largest)];
}

std::vector<std::uint32_t> mergedTriangles(const BodyInput& input, float cell) {
  const std::size_t count = input.positions.size() / 3;
  std::vector<Place> places(count);
  for (std::size_t v = 0; v < count; ++v) places[v] = placeOf(input, v, cell);
  std::vector<std::uint32_t> order(count), merged(count);
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return places[a] < places[b]; });
  for (std::size_t begin = 0, end = 0; begin < count; begin = end) {
    while (end < count && places[order[end]] == places[order[begin]]) ++end;
    const std::uint32_t middle = middleOf(input, order, begin, end);
    for (std::size_t i = begin; i < end; ++i) merged[order[i]] = middle;
  }
  std::vector<std::uint32_t> triangles;
  for (std::size_t t = 0; t + 2 < input.triangles.size(); t += 3) {
    const std::uint32_t a = merged[input.triangles[t]], b = merged[input.triangles[t + 1]],
                        c = merged[input.triangles[t + 2]];
    if (a != b && b != c && c != a) triangles.insert(triangles.end(), {a, b, c});
  }
  return triangles;
}

int bodyLevel(float pixels_a_metre, int before) {
  int level = 0;
  for (std::size_t i = 0; i < kBodyCells.size(); ++i) {
    const int coarser = static_cast<int>(i) + 1;
    const float most = coarser <= before ? kKeep * kCellPixels : kCellPixels;
    if (kBodyCells[i] * pixels_a_metre <= most) level = coarser;
  }
  return level;
}

}  // namespace render
