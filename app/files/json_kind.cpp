#include "app/files/json_kind.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <vector>

#include "app/scene/view/look_params.h"
#include "sim/field_text.h"
#include "sim/sim_params.h"

namespace app {

namespace {

using Names = std::span<const std::string_view>;

constexpr std::size_t kLongestKey = 40;  // that is quoted

bool among(std::string_view key, Names names) {
  return std::ranges::find(names, key) != names.end();
}

// The section of scenes and presets that has a parameter of that name; empty: none.
std::string sectionOf(std::string_view key) {
  const auto named = [&](const auto& row) { return key == row.name; };
  if (std::ranges::any_of(sim::paramFields(), named)) return "sim";
  if (std::ranges::any_of(hairFields(), named)) return "hair";
  const auto at = std::ranges::find_if(sceneFields(), named);
  return at == sceneFields().end() ? "" : std::string_view(at->group) == "Picture" ? "view" : "light";
}

// What a file with such a key at its top was meant to be; nothing: every kind has it, or none.
std::optional<JsonKind> kindOfKey(std::string_view key) {
  if (key.find("project") != std::string_view::npos) return JsonKind::kProject;
  if (key == "name") return {};
  if (among(key, kPresetKeys) || !sectionOf(key).empty()) return JsonKind::kPreset;
  if (among(key, kSceneKeys) || among(key, kCharacterKeys)) return JsonKind::kScene;
  if (!sim::nearestName(key, kPresetKeys).empty()) return JsonKind::kPreset;
  const bool near = !sim::nearestName(key, kSceneKeys).empty() || !sim::nearestName(key, kCharacterKeys).empty();
  return near ? std::optional(JsonKind::kScene) : std::nullopt;
}

std::string inQuotes(std::string_view key) {
  return "\"" + std::string(key.substr(0, kLongestKey)) + "\"";
}

// Where in a scene or preset a key belongs; empty: nowhere.
std::string homeOf(std::string_view key) {
  const std::string named = inQuotes(key);
  if (among(key, kCharacterKeys)) return "a character: \"characters\": [{ " + named + ": ... }]";
  const std::string section = sectionOf(key);
  if (section == "hair") return "a character's \"look\", or a preset's \"hair\"";
  if (!section.empty()) return "the top of the file: \"" + section + "\": { " + named + ": ... }";
  if (among(key, kSceneKeys)) return "the top of a scene, beside \"characters\"";
  if (among(key, kCameraKeys)) return "the scene's \"camera\"";
  if (among(key, kPlaybackKeys)) return "the scene's \"playback\"";
  return "";
}

constexpr const char* kWhatThereIs =
    "a scene has \"characters\"; a preset has \"sim\", \"hair\", \"light\" or \"view\"";

}  // namespace

JsonKind jsonKind(const JsonPlace& top) {
  if (!top.value().is_object()) throw InputError(top.file(), "", "is no scene, preset or project", kWhatThereIs);
  std::vector<JsonKind> kinds;
  bool known = top.value().empty();
  for (const auto& item : top.value().items()) {
    known = known || item.key() == "name";
    if (const auto kind = kindOfKey(item.key())) kinds.push_back(*kind);
  }
  for (const JsonKind kind : {JsonKind::kProject, JsonKind::kScene, JsonKind::kPreset})
    if (std::ranges::find(kinds, kind) != kinds.end()) return kind;
  if (known) return JsonKind::kPreset;
  throw InputError(top.file(), "key " + inQuotes(top.value().items().begin().key()),
                   "is none of a scene, preset or project", kWhatThereIs);
}

void expectTopKeys(const JsonPlace& top, JsonKind kind) {
  const bool scene = kind == JsonKind::kScene, preset = kind == JsonKind::kPreset;
  const Names known = scene ? Names(kSceneKeys) : preset ? Names(kPresetKeys) : Names(kProjectKeys);
  if (!top.value().is_object()) top.expectObject(known);
  for (const auto& item : top.value().items()) {
    const std::string& key = item.key();
    if (among(key, known)) continue;
    const auto refuse = [&](const std::string& fault, const std::string& mend) {
      throw InputError(top.file(), "key " + inQuotes(key), fault, mend);
    };
    const std::string section = scene || preset ? sectionOf(key) : "";
    if (scene && among(key, kCharacterKeys))
      refuse("belongs to a character of the scene", "write \"characters\": [{ " + inQuotes(key) + ": ... }]");
    if (scene && section == "hair")
      refuse("belongs to a character's look", "write \"characters\": [{ \"look\": { " + inQuotes(key) + ": ... } }]");
    if (!section.empty())
      refuse("belongs to the section " + inQuotes(section),
             "write " + inQuotes(section) + ": { " + inQuotes(key) + ": ... }");
    if (preset && key == "look") refuse("is \"hair\" in a preset", "write \"hair\": { ... }");
    if (preset && jsonKind(top) == JsonKind::kScene)
      refuse("is no preset's: the file is a scene", "open it without an option");
    refuse(scene    ? "is unknown in a scene"
           : preset ? "is unknown in a preset"
                    : "is unknown in a project",
           sim::nameHint(key, known));
  }
}

void expectKeys(const JsonPlace& place, Names known) {
  if (place.value().is_object()) {
    for (const auto& item : place.value().items()) {
      if (among(item.key(), known)) continue;
      if (const std::string home = homeOf(item.key()); !home.empty())
        place.refuse("unknown key '" + item.key().substr(0, kLongestKey) + "'", "it belongs to " + home);
    }
  }
  place.expectObject(known);
}

}  // namespace app
