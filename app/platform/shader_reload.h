// Shaders are reloaded when their files are saved, and when a person asks for it.
#pragma once

#include "app/scene/demo.h"
#include "render/renderer.h"

namespace app {

inline constexpr double kShaderLook = 0.25;  // s between two looks at the files' times

struct ShaderWatch {
  double looked = 0;        // s, moment of the last look
  bool reload_all = false;  // asked for
};

// Looks at the files when it is time to. What was reloaded, or the first fault, becomes the demo's message. Returns
// whether there is something new to draw.
bool reloadSavedShaders(double moment, ShaderWatch& watch, render::Renderer& renderer, Demo& demo);

}  // namespace app
