// Which hairs can shade a place: cells across the light, each with a bit for every hair's map whose ball reaches into
// it. A point of body or ground then asks the few maps above it instead of all of them.
#pragma once

#include <Eigen/Geometry>
#include <span>

#include "shaders/shared.h"

namespace render {

// balls: of the hairs' shadows, world, w: radius (m); at most kMaxHairShadows. to_light: unit.
void fillShadowGrid(std::span<const shared::vec4> balls, const Eigen::Vector3f& to_light,
                    shared::ShadowGridBlock& grid);

}  // namespace render
