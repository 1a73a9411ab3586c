// A panorama's light as the renderer takes it: three lights from afar, and light from all around.
#pragma once

#include <string>

#include "app/files/radiance_file.h"
#include "app/files/scene_file.h"
#include "render/frame_input.h"

namespace app {

// Key, fill and rim take what is brighter than the mean within 25 degrees of the three brightest places, strongest
// first; sky and ground are the first two moments of the rest along the vertical. What a sphere gets in all is the
// panorama's, scaled to what it gets of the default lights, for panoramas have units of their own. The panorama's
// middle is +z, which the figure faces, its left side +x. The rest of `light` stays. `file` is what errors name. Throws
// InputError when the panorama is not twice as wide as high, or black.
render::LightInput environmentLight(const std::string& file, const RadiancePicture& panorama, render::LightInput light);

// The same of a file, see readRadiance.
render::LightInput environmentLight(const std::string& file, const render::LightInput& light);

// The scene's lights are a panorama's from now on, or with an empty name those that it had before one. Throws
// InputError.
void setEnvironment(const std::string& file, Scene& scene);

}  // namespace app
