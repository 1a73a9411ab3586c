#include "render/hair/skin_reach.h"

#include <Eigen/Core>
#include <algorithm>
#include <bit>
#include <cmath>

#include "render/strands/skin_lift.h"
#include "render/view_math.h"
#include "shaders/shared.h"

namespace render {
namespace {

using Eigen::Vector3f;

// Around the bundle's vertices of two layers, with room for what its strands leave their hull by; see measureFaces of
// hair_store.cpp.
Bounds strandsBetween(const HairFace& face, std::span<const float> positions, int layer, float sideways) {
  const auto at = [&](int v) { return Vector3f(positions[3 * v], positions[3 * v + 1], positions[3 * v + 2]); };
  const int corners = face.first_vertex[3] < 0 ? 3 : 4;
  const int low = std::max(layer - 1, 0), high = std::min(layer + 2, face.layers - 1);
  Bounds box;
  float across = 0, along = 0;
  for (int k = 0; k < corners; ++k) {
    const int first = face.first_vertex[k], next = face.first_vertex[(k + 1) % corners];
    for (int l = layer; l <= layer + 1; ++l) {
      box.add(at(first + l));
      across = std::max(across, (at(next + l) - at(first + l)).norm());
    }
    for (int l = low; l < high; ++l) along = std::max(along, (at(first + l + 1) - at(first + l)).norm());
  }
  const float margin = sideways + 0.6f * across + 0.25f * along + kMostLifted;
  box.low.array() -= margin;
  box.high.array() += margin;
  return box;
}

// Whether a point of the box may lie so near.
bool mayMeet(const SkinEllipsoid& skin, float reach, const Vector3f& middle, const Vector3f& half) {
  float squared = 0;
  for (const auto& row : skin.to_ball) {
    const Vector3f along(row[0], row[1], row[2]);
    const float gap = std::abs(along.dot(middle) + row[3]) - along.cwiseAbs().dot(half);
    squared += gap > 0 ? gap * gap : 0;
  }
  return squared <= reach;
}

// Of the ellipsoids and grids of `among`, those that the box may meet.
std::uint64_t met(std::span<const SkinEllipsoid> skin, std::span<const SkinGrid> grids,
                  const std::vector<float>& reaches, const Bounds& box, std::uint64_t among) {
  const Vector3f middle = box.center(), half = 0.5f * (box.high - box.low);
  std::uint64_t bits = 0;
  for (; among != 0; among &= among - 1) {
    const auto i = static_cast<std::size_t>(std::countr_zero(among));
    const bool may = i < shared::kMaxSkin ? mayMeet(skin[i], reaches[i], middle, half)
                                          : meetsBox(grids[i - shared::kMaxSkin], middle, half);
    if (may) bits |= std::uint64_t{1} << i;
  }
  return bits;
}

}  // namespace

void reachSkin(const HairLayout& layout, std::span<const float> positions, std::span<const SkinEllipsoid> skin,
               std::span<const SkinGrid> grids, float sideways, std::vector<std::uint64_t>& reached) {
  const auto steps = static_cast<std::size_t>(std::max(layout.max_layers - 1, 1));
  const std::uint64_t all = allSkin(skin.size(), grids.size());
  std::vector<float> reaches(skin.size());
  std::ranges::transform(skin, reaches.begin(), [](const SkinEllipsoid& one) { return 1.001f * liftsWithin(one); });
  std::vector<Bounds> boxes(steps);
  reached.assign(layout.faces.size() * steps, 0);
  for (std::size_t f = 0; f < layout.faces.size(); ++f) {
    const auto count = static_cast<std::size_t>(std::max(layout.faces[f].layers - 1, 0));
    Bounds whole;
    for (std::size_t layer = 0; layer < count; ++layer) {
      boxes[layer] = strandsBetween(layout.faces[f], positions, static_cast<int>(layer), sideways);
      whole.add(boxes[layer]);
    }
    if (count == 0) continue;
    const std::uint64_t near = met(skin, grids, reaches, whole, all);
    for (std::size_t layer = 0; layer < count; ++layer)
      reached[f * steps + layer] = met(skin, grids, reaches, boxes[layer], near);
  }
}

}  // namespace render
