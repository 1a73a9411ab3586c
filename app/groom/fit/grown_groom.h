// The strands that grow from a hair mesh at rest, as a groom.
#pragma once

#include <span>

#include "app/files/hair_file.h"
#include "app/groom/groom.h"
#include "render/frame_input.h"
#include "sim/mesh/hair_mesh.h"

namespace app {

// About `strands` of them with `points` points each, dealt out over the faces by area as when they are drawn; metres.
// `shares`: of the look, one a column, or none.
Groom growGroom(const sim::HairMeshShape& shape, const render::HairLook& look, int strands, int points,
                std::span<const ColumnShare> shares = {});

// Every nth strand, so that there are at most `most`.
Groom someStrands(const Groom& groom, std::size_t most);

// The smallest of six overlaps of the silhouettes of two grooms, seen from both ends of each axis at 0.6 m from their
// middle: area of both over area of either, of strands that are `width` (m) wide.
double silhouetteOverlap(const Groom& a, const Groom& b, double width = 0.003);

}  // namespace app
