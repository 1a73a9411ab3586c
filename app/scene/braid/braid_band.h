// The band that is seen around a tail, where a tie holds it, and around a plait's end.
#pragma once

#include <cstddef>
#include <cstdint>

#include "render/frame_input.h"

namespace app {

// A torus about z, of which the hair that it holds has radius 1; number `band` of a hair, at most 16. Without its
// place.
render::BodyInput bandInput(std::uint64_t hair, std::size_t band);

}  // namespace app
