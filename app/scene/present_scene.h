// The scene as it is now, all that a person has turned included: opened, it looks as it does.
#pragma once

#include <string>
#include <vector>

#include "app/scene/demo.h"

namespace app {

// Characters, look, parameters, playback, and the camera: as seen from the head where it follows it, else where it
// stands.
Scene presentScene(const Demo& demo);

// The scene with the names of its files such that it can be opened from any folder, to be written to `file` (a path;
// may be empty): files that come with the program by their bare name, files in that one's folder or below by the way
// from there, so that they can be moved together, others by their full path.
Scene movable(Scene scene, const std::string& file = "");

// Hair that brushes have reshaped becomes a file of its own beside the scene's, and the scene's hair. Returns the
// names of these files. Throws OutputError.
std::vector<std::string> saveReshapedHair(const std::string& scene_file, const Demo& demo, Scene& scene);

}  // namespace app
