// Which ellipsoids of skin the strands of each bundle can meet between two layers: of the others
// shaders/common/skin.glsl looks at none.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "render/frame_input.h"
#include "render/strands/hair_layout.h"
#include "shaders/shared.h"

namespace render {

// A bit for each of so many ellipsoids and, from bit kMaxSkin of shaders/shared.h on, grids; at most kMaxSkin and
// kMaxSkinGrids. Where others are set the shader reads rows that its uniform block lacks, which is undefined.
constexpr std::uint64_t allSkin(std::size_t ellipsoids, std::size_t grids = 0) {
  return ((std::uint64_t{1} << ellipsoids) - 1) | ((std::uint64_t{1} << grids) - 1) << shared::kMaxSkin;
}

// Sets bit i of reached[face * (max_layers - 1) + layer] where strands between `layer` and the next one may be lifted
// out of skin[i], and bit kMaxSkin + i where out of grids[i]; positions: 3 floats a vertex. sideways: m, how far
// strands may leave the hull of the hair mesh.
void reachSkin(const HairLayout& layout, std::span<const float> positions, std::span<const SkinEllipsoid> skin,
               std::span<const SkinGrid> grids, float sideways, std::vector<std::uint64_t>& reached);

}  // namespace render
