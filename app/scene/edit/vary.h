// Parameters drawn at random about what they are: variations to choose from.
#pragma once

#include <cstdint>

#include "sim/sim_params.h"

namespace app {

inline constexpr double kLargestVariation = 2;  // see varyMaterial

// Moves every row of the group "Material" evenly at random, within its range: logarithmic ones by up to `amount`
// decades, others by up to `amount` of half their range. The same seed gives the same bits.
void varyMaterial(double amount, std::uint64_t seed, sim::SimParams& params);

}  // namespace app
