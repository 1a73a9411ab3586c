// The ring that is seen around a plait's end.
#pragma once

#include <cstddef>
#include <cstdint>

#include "render/frame_input.h"

namespace app {

// A torus about z, of which the hair that it holds has radius 1; number `plait` of a hair. Without its place.
render::BodyInput bandInput(std::uint64_t hair, std::size_t plait);

}  // namespace app
