// Presets: a part of the parameter tables as JSON: { "name": "soft", "sim": {row: value}, "hair": {...}, "light":
// {...}, "view": {...} }. Of the groups that it names a row of, the rows left out take their defaults, so that it
// does not matter which preset was chosen before. All other groups keep their values.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "app/files/json_reader.h"
#include "app/scene/view/look_params.h"

namespace app {

// What a preset writes to. Nothing is changed unless all of it can be read.
struct PresetTarget {
  sim::SimParams* sim;
  SceneLook* scene;
  std::span<CharacterLook*> hairs;
};

// Throws InputError naming file and place.
void applyPreset(std::string_view text, const std::string& file, const PresetTarget& target);
void loadPreset(const std::string& file, const PresetTarget& target);

// Which tables a preset sets rows of. Throws InputError.
struct PresetSections {
  bool sim = false, hair = false, light = false, view = false;
};
PresetSections presetSections(const std::string& file);

// All rows, so that loading it brings back what was saved.
std::string writePreset(const std::string& name, const sim::SimParams& sim, const CharacterLook& hair,
                        const SceneLook& scene);

// The file of the preset of a name like "soft", or the name itself when it is a file. Throws InputError for an unknown
// name.
std::string presetFile(const std::string& name, const std::string& base_file);

// The tables' parts of scene and preset files. Written are the rows that differ from a base's.
void readSimRows(const JsonPlace& place, sim::SimParams& sim);
void readHairRows(const JsonPlace& place, CharacterLook& look);
void readSceneRows(const JsonPlace& place, SceneLook& look, bool light);
nlohmann::json writeSimRows(const sim::SimParams& sim, const sim::SimParams& base);
nlohmann::json writeHairRows(const CharacterLook& look, const CharacterLook& base);
nlohmann::json writeSceneRows(const SceneLook& look, bool light, const SceneLook& base);

}  // namespace app
