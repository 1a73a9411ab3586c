// Drawn strands are lifted out of the skin: shaders/common/skin.glsl on the CPU, step by step.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "render/frame_input.h"

namespace render {

// `position` (m) of a strand's point leaves the ellipsoids; `tangent` turns with it and is no unit vector any more. s:
// curve parameter, in layers; a root (0) stays.
void leaveSkin(std::span<const SkinEllipsoid> skin, float s, Eigen::Vector3f& position, Eigen::Vector3f& tangent);

// Those that may lift a point of the box (m), in their order; at most kMaxSkin of shaders/shared.h, the first ones.
std::vector<SkinEllipsoid> skinNear(std::span<const SkinEllipsoid> skin, const Eigen::Vector3f& low,
                                    const Eigen::Vector3f& high);

}  // namespace render
