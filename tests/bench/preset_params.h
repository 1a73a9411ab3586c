// The simulator's parameters of a shipped preset.
#pragma once

#include <string>

#include "app/files/data_path.h"
#include "app/files/presets.h"
#include "app/scene/view/look_params.h"
#include "sim/sim_params.h"

namespace bench {

// The default scene's, with which the program opens.
inline constexpr const char* kOpened = "natural";

// Of assets/presets/`name`.json. Throws app::InputError as loadPreset does.
inline sim::SimParams presetParams(const std::string& name) {
  sim::SimParams params;
  app::SceneLook scene;
  app::CharacterLook look;
  app::CharacterLook* looks[] = {&look};
  app::loadPreset(app::dataPath("assets/presets/" + name + ".json"), {&params, &scene, looks});
  return params;
}

}  // namespace bench
