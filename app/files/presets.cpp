#include "app/files/presets.h"

#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <vector>

#include "app/files/data_path.h"
#include "app/files/json_kind.h"
#include "app/files/text_file.h"
#include "sim/field_text.h"

namespace app {

namespace {

using nlohmann::json;

constexpr std::size_t kLargestPreset = std::size_t{4} << 20;

template <class Field>
std::vector<std::string_view> namesOf(std::span<const Field> table) {
  std::vector<std::string_view> names;
  for (const Field& row : table) names.emplace_back(row.name);
  return names;
}

// "Light" and "Shadows" rows belong to the light; the others to the view.
bool isLight(const SceneField& row) {
  return std::string_view(row.group) != "Picture";
}

template <class Owner>
void readRow(const JsonPlace& place, Owner& owner, const LookField<Owner>& row) {
  const std::string text = place.fieldText({row.kind, row.components(), row.minimum, row.maximum, row.unit});
  if (std::string fault = setLook(owner, row, text); !fault.empty()) {
    place.refuse(fault.substr(0, fault.find("; ")), fault.substr(std::min(fault.size(), fault.find("; ") + 2)));
  }
}

template <class Owner>
json rowValue(const Owner& owner, const LookField<Owner>& row) {
  const LookValue value = row.get(owner);
  if (row.components() == 3) return json{value[0], value[1], value[2]};
  switch (row.kind) {
    case sim::FieldKind::kSwitch:
      return value[0] != 0;
    case sim::FieldKind::kChoice:
      return row.choices[static_cast<std::size_t>(value[0])];
    case sim::FieldKind::kInteger:
      return static_cast<long long>(value[0]);
    case sim::FieldKind::kReal:
      break;
  }
  return value[0];
}

json rowValue(const sim::SimParams& params, const sim::ParamField& row) {
  const double value = row.get(params);
  switch (row.kind) {
    case sim::FieldKind::kSwitch:
      return value != 0;
    case sim::FieldKind::kChoice:
      return row.choices[static_cast<std::size_t>(value)];
    case sim::FieldKind::kInteger:
      return static_cast<long long>(value);
    case sim::FieldKind::kReal:
      break;
  }
  return value;
}

// Rows of a table by name: all, or those that differ from a base's.
template <class Owner, class Field>
json rowsOf(const Owner& owner, std::span<const Field> table, const Owner* base = nullptr) {
  json rows = json::object();
  for (const Field& row : table) {
    if (!base || row.get(owner) != row.get(*base)) rows[row.name] = rowValue(owner, row);
  }
  return rows;
}

std::vector<SceneField> sceneRows(bool light) {
  std::vector<SceneField> rows;
  for (const SceneField& row : sceneFields())
    if (isLight(row) == light) rows.push_back(row);
  return rows;
}

// Puts every row of the groups that a section names back to its default.
template <class Owner, class Field>
void resetNamedGroups(const JsonPlace& section, std::span<const Field> table, Owner& owner) {
  std::set<std::string_view> groups;
  for (const Field& row : table) {
    if (section.value().is_object() && section.has(row.name)) groups.insert(row.group);
  }
  for (const Field& row : table) {
    if (groups.contains(row.group)) row.set(owner, row.default_value);
  }
}

}  // namespace

void readSimRows(const JsonPlace& place, sim::SimParams& params) {
  expectKeys(place, namesOf(sim::paramFields()));
  for (const sim::ParamField& row : sim::paramFields()) {
    if (!place.has(row.name)) continue;
    const JsonPlace at = place.at(row.name);
    const std::string text = at.fieldText({row.kind, 1, row.minimum, row.maximum, row.unit});
    if (const sim::ParamText answer = sim::setParam(params, row.name, text); !answer.ok) {
      const std::size_t cut = answer.fault.find("; ");
      at.refuse(answer.fault.substr(0, cut), cut == std::string::npos ? "" : answer.fault.substr(cut + 2));
    }
  }
}

void readHairRows(const JsonPlace& place, CharacterLook& look) {
  expectKeys(place, namesOf(hairFields()));
  for (const HairField& row : hairFields()) {
    if (place.has(row.name)) readRow(place.at(row.name), look, row);
  }
}

void readSceneRows(const JsonPlace& place, SceneLook& look, bool light) {
  std::vector<std::string_view> names;
  for (const SceneField& row : sceneFields()) {
    if (isLight(row) == light) names.emplace_back(row.name);
  }
  expectKeys(place, names);
  for (const SceneField& row : sceneFields()) {
    if (place.has(row.name)) readRow(place.at(row.name), look, row);
  }
}

json writeSimRows(const sim::SimParams& params, const sim::SimParams& base) {
  return rowsOf(params, sim::paramFields(), &base);
}

json writeHairRows(const CharacterLook& look, const CharacterLook& base) {
  return rowsOf(look, hairFields(), &base);
}

json writeSceneRows(const SceneLook& look, bool light, const SceneLook& base) {
  return rowsOf(look, std::span<const SceneField>(sceneRows(light)), &base);
}

void applyPreset(std::string_view text, const std::string& file, const PresetTarget& target) {
  const json parsed = parseJson(text, file);
  const JsonPlace place(parsed, file);
  expectTopKeys(place, JsonKind::kPreset);
  if (place.has("name")) place.at("name").text();
  sim::SimParams params = *target.sim;
  SceneLook scene = *target.scene;
  std::vector<CharacterLook> hairs;
  for (const CharacterLook* look : target.hairs) hairs.push_back(*look);
  if (hairs.empty()) hairs.emplace_back();
  if (place.has("sim")) {
    resetNamedGroups(place.at("sim"), sim::paramFields(), params);
    readSimRows(place.at("sim"), params);
  }
  for (const bool light : {true, false}) {
    const char* section = light ? "light" : "view";
    if (!place.has(section)) continue;
    resetNamedGroups(place.at(section), sceneFields(), scene);
    readSceneRows(place.at(section), scene, light);
  }
  for (CharacterLook& look : hairs) {
    if (!place.has("hair")) break;
    resetNamedGroups(place.at("hair"), hairFields(), look);
    readHairRows(place.at("hair"), look);
  }
  *target.sim = params;
  *target.scene = scene;
  for (std::size_t i = 0; i < target.hairs.size(); ++i) *target.hairs[i] = hairs[i];
}

void loadPreset(const std::string& file, const PresetTarget& target) {
  applyPreset(readText(file, kLargestPreset), file, target);
}

PresetSections presetSections(const std::string& file) {
  const json parsed = parseJson(readText(file, kLargestPreset), file);
  const JsonPlace place(parsed, file);
  expectTopKeys(place, JsonKind::kPreset);
  const auto sets = [&](const char* section) { return place.has(section) && !place.at(section).value().empty(); };
  return {sets("sim"), sets("hair"), sets("light"), sets("view")};
}

std::string writePreset(const std::string& name, const sim::SimParams& params, const CharacterLook& hair,
                        const SceneLook& scene) {
  const json preset = {{"name", name},
                       {"sim", rowsOf(params, sim::paramFields())},
                       {"hair", rowsOf(hair, hairFields())},
                       {"light", rowsOf(scene, std::span<const SceneField>(sceneRows(true)))},
                       {"view", rowsOf(scene, std::span<const SceneField>(sceneRows(false)))}};
  return preset.dump(2, ' ', false, json::error_handler_t::replace) + "\n";
}

std::string presetFile(const std::string& name, const std::string& base_file) {
  const bool bare = std::filesystem::path(name).extension().empty();
  const std::string file = findFile(bare ? name + ".json" : name, base_file, "presets");
  std::error_code ignored;
  if (std::filesystem::exists(file, ignored)) return file;
  const std::string scene = findFile(bare ? name + ".json" : name, base_file, "scenes");
  if (std::filesystem::exists(scene, ignored))
    throw InputError("preset '" + name + "'", "", "is not there: that name is a scene's",
                     "name it " + std::filesystem::path(scene).filename().string() + ", without --preset");
  if (!bare) return file;
  std::vector<std::string> known;
  for (const std::string& preset : listAssets("presets", {".json"})) known.push_back(stem(preset));
  const std::vector<std::string_view> names(known.begin(), known.end());
  throw InputError("preset '" + name + "'", "", "is not there",
                   sim::nameHint(name, names) + "; a file may be named too");
}

}  // namespace app
