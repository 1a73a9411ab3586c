// Parameters drawn at random about what they are: variations to choose from.
#pragma once

#include <cstdint>

#include "app/scene/camera.h"
#include "render/frame_input.h"
#include "sim/sim_params.h"

namespace app {

inline constexpr double kLargestVariation = 2;  // see varyMaterial

// Moves every row of the group "Material" evenly at random, within its range: logarithmic ones by up to `amount`
// decades, others by up to `amount` of half their range. The same seed gives the same bits.
void varyMaterial(double amount, std::uint64_t seed, sim::SimParams& params);

// The key light's direction after the mouse has dragged it by (dx, dy) pixels in a picture `height` pixels high: about
// the vertical, and up or down as the camera sees it. It stays 3 degrees short of the vertical.
render::Float3 turnedLight(const render::Float3& to_light, double dx, double dy, double height);

}  // namespace app
