// Coarser triangles of a body for when it is small in the picture: vertices that share a cell, a joint and a side are
// drawn as one of them. No vertex is added, so that skinning and shading are the full mesh's.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "render/frame_input.h"

namespace render {

// m, of the cells of each coarser level, finest first.
inline constexpr std::array<float, 4> kBodyCells{0.012f, 0.024f, 0.048f, 0.096f};

// Triangles of a sound body with vertices merged within cells of `cell` m of the rest pose. Vertices of other joints
// and those that face other ways stay apart, so that thin limbs neither vanish nor grow together.
std::vector<std::uint32_t> mergedTriangles(const BodyInput& input, float cell);

// The joint that moves a vertex most.
int mainJoint(const BodyInput& input, std::size_t vertex);

// How many levels coarser a body is drawn whose metre spans so many pixels; 0: as it is. A level is kept until it is
// off by more than a little, so that nothing switches to and fro. `before`: the last answer, or -1.
int bodyLevel(float pixels_a_metre, int before);

}  // namespace render
