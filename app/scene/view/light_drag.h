// Turning the key light by a drag of the mouse.
#pragma once

#include "render/frame_input.h"

namespace app {

// The key light's direction after the mouse has dragged it by (dx, dy) pixels in a picture `height` pixels high: about
// the vertical, and up or down as the camera sees it. It stays 3 degrees short of the vertical.
render::Float3 turnedLight(const render::Float3& to_light, double dx, double dy, double height);

}  // namespace app
