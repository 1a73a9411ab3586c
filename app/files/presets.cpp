#include "app/presets.h"

#include <filesystem>
#include <vector>

#include "app/data_path.h"
#include "app/motion.h"
#include "sim/field_text.h"

namespace app {

namespace {

using nlohmann::json;

constexpr std::size_t kLargestFile = std::size_t{4} << 20;

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
  if (std::string fault = setLook(owner, row, place.fieldText()); !fault.empty()) {
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

template <class Owner>
json changedRows(const Owner& owner, std::span<const LookField<Owner>> table) {
  json rows = json::object();
  for (const LookField<Owner>& row : table) {
    if (row.get(owner) != row.default_value) rows[row.name] = rowValue(owner, row);
  }
  return rows;
}

}  // namespace

void readSimRows(const JsonPlace& place, sim::SimParams& params) {
  place.expectObject(namesOf(sim::paramFields()));
  for (const sim::ParamField& row : sim::paramFields()) {
    if (!place.has(row.name)) continue;
    const JsonPlace at = place.at(row.name);
    if (const sim::ParamText answer = sim::setParam(params, row.name, at.fieldText()); !answer.ok) {
      const std::size_t cut = answer.fault.find("; ");
      at.refuse(answer.fault.substr(0, cut), cut == std::string::npos ? "" : answer.fault.substr(cut + 2));
    }
  }
}

void readHairRows(const JsonPlace& place, CharacterLook& look) {
  place.expectObject(namesOf(hairFields()));
  for (const HairField& row : hairFields()) {
    if (place.has(row.name)) readRow(place.at(row.name), look, row);
  }
}

void readSceneRows(const JsonPlace& place, SceneLook& look, bool light) {
  std::vector<std::string_view> names;
  for (const SceneField& row : sceneFields()) {
    if (isLight(row) == light) names.emplace_back(row.name);
  }
  place.expectObject(names);
  for (const SceneField& row : sceneFields()) {
    if (place.has(row.name)) readRow(place.at(row.name), look, row);
  }
}

json writeSimRows(const sim::SimParams& params) {
  json rows = json::object();
  for (const sim::ParamField& row : sim::paramFields()) {
    const double value = row.get(params);
    if (value == row.default_value) continue;
    switch (row.kind) {
      case sim::FieldKind::kSwitch:
        rows[row.name] = value != 0;
        break;
      case sim::FieldKind::kChoice:
        rows[row.name] = row.choices[static_cast<std::size_t>(value)];
        break;
      case sim::FieldKind::kInteger:
        rows[row.name] = static_cast<long long>(value);
        break;
      case sim::FieldKind::kReal:
        rows[row.name] = value;
        break;
    }
  }
  return rows;
}

json writeHairRows(const CharacterLook& look) {
  return changedRows(look, hairFields());
}

json writeSceneRows(const SceneLook& look, bool light) {
  json rows = json::object();
  for (const SceneField& row : sceneFields()) {
    if (isLight(row) == light && row.get(look) != row.default_value) rows[row.name] = rowValue(look, row);
  }
  return rows;
}

void applyPreset(std::string_view text, const std::string& file, const PresetTarget& target) {
  const json parsed = parseJson(text, file);
  const JsonPlace place(parsed, file);
  place.expectObject({"name", "sim", "hair", "light", "view"});
  if (place.has("name")) place.at("name").text();
  sim::SimParams params = *target.sim;
  SceneLook scene = *target.scene;
  std::vector<CharacterLook> hairs;
  for (const CharacterLook* look : target.hairs) hairs.push_back(*look);
  if (hairs.empty()) hairs.emplace_back();
  if (place.has("sim")) readSimRows(place.at("sim"), params);
  if (place.has("light")) readSceneRows(place.at("light"), scene, true);
  if (place.has("view")) readSceneRows(place.at("view"), scene, false);
  for (CharacterLook& look : hairs) {
    if (place.has("hair")) readHairRows(place.at("hair"), look);
  }
  *target.sim = params;
  *target.scene = scene;
  for (std::size_t i = 0; i < target.hairs.size(); ++i) *target.hairs[i] = hairs[i];
}

void loadPreset(const std::string& file, const PresetTarget& target) {
  applyPreset(readText(file, kLargestFile), file, target);
}

std::string writePreset(const std::string& name, const sim::SimParams& params, const CharacterLook& hair,
                        const SceneLook& scene) {
  const json preset = {{"name", name},
                       {"sim", writeSimRows(params)},
                       {"hair", writeHairRows(hair)},
                       {"light", writeSceneRows(scene, true)},
                       {"view", writeSceneRows(scene, false)}};
  return preset.dump(2, ' ', false, json::error_handler_t::replace) + "\n";
}

std::string presetFile(const std::string& name, const std::string& base_file) {
  const bool bare = std::filesystem::path(name).extension().empty();
  return findFile(bare ? name + ".json" : name, base_file, "presets");
}

}  // namespace app
