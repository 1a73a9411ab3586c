// Presets: a part of the parameter tables as JSON: { "name": "soft", "sim": {row: value}, "hair": {...}, "light":
// {...}, "view": {...} }. Rows left out keep their value.
#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>

#include "app/json_reader.h"
#include "app/look_params.h"

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

// All rows that differ from their defaults.
std::string writePreset(const std::string& name, const sim::SimParams& sim, const CharacterLook& hair,
                        const SceneLook& scene);

// A file of presets for a name like "soft", or the name itself when it is a file.
std::string presetFile(const std::string& name, const std::string& base_file);

// The tables' parts of scene and preset files.
void readSimRows(const JsonPlace& place, sim::SimParams& sim);
void readHairRows(const JsonPlace& place, CharacterLook& look);
void readSceneRows(const JsonPlace& place, SceneLook& look, bool light);
nlohmann::json writeSimRows(const sim::SimParams& sim);
nlohmann::json writeHairRows(const CharacterLook& look);
nlohmann::json writeSceneRows(const SceneLook& look, bool light);

}  // namespace app
