// Presets: their pictures, the list of them, and saving one.
#include <imgui/imgui.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include "app/files/data_path.h"
#include "app/files/presets.h"
#include "app/ui/ui_panels.h"
#include "app/ui/ui_widgets.h"

namespace app {

namespace {

constexpr int kPicturesAcross = 5, kPictureRows = 2;
constexpr float kPictureGap = 4;           // px
constexpr float kMinRoomOfPictures = 420;  // px of the window's height

// Saves under the name that was typed; a file that is there already only when asked a second time.
void savePreset(Demo& demo, UiState& ui) {
  const std::string file = std::string(ui.preset_name.data()) + ".json";
  std::error_code ignored;
  if (std::filesystem::exists(file, ignored) && ui.to_replace != file) {
    ui.to_replace = file;
    return;
  }
  ui.to_replace.clear();
  postRequest(demo, {Ask::kSavePreset, "", file});
  if (std::find(ui.presets.begin(), ui.presets.end(), file) == ui.presets.end()) ui.presets.push_back(file);
}

template <class Owner, class Field>
bool sameRows(std::span<const Field> table, const Owner& a, const Owner& b) {
  return std::ranges::all_of(table, [&](const Field& row) { return row.get(a) == row.get(b); });
}

// The chosen preset's name, and whether a parameter has been changed since.
std::string presetTitle(const Demo& demo) {
  const std::string& file = demo.scene.preset;
  if (file.empty()) return "choose...";
  const RowValues& base = demo.scene.base;
  const CharacterLook& hair = selectedActor(demo).spec.look;
  const bool same = sameRows(sim::paramFields(), demo.scene.sim, base.sim) &&
                    sameRows(hairFields(), hair, base.hairs[static_cast<std::size_t>(demo.selected)]) &&
                    sameRows(sceneFields(), demo.scene.look, base.scene);
  return readable(stem(file)) + (same ? "" : ", changed");
}

// What choosing a preset changes, in words.
std::string scopeOf(const std::string& file) {
  try {
    const PresetSections sets = presetSections(file);
    std::string scope;
    const auto add = [&](bool is, const char* what) {
      if (is) scope.append(scope.empty() ? "" : ", ").append(what);
    };
    add(sets.sim, "how the hair moves");
    add(sets.hair, "how it looks");
    add(sets.light, "the light");
    add(sets.view, "the picture");
    return scope.empty() ? "changes nothing" : "changes " + scope;
  } catch (const std::exception& fault) {
    return fault.what();
  }
}

// Over the widget just made: the picture, or a plain square until there is one, and the name below.
void drawPreset(const std::string& file, float side, bool chosen, const UiState& ui) {
  const ImVec2 low = ImGui::GetItemRectMin(), high(low.x + side, low.y + side);
  ImDrawList* list = ImGui::GetWindowDrawList();
  const auto made = std::ranges::find(ui.preset_pictures, file, &PresetPicture::file);
  const bool shown = made != ui.preset_pictures.end() && made->texture != 0;
  const float round = 4 * ui.text_scale;
  if (shown) {
    list->AddImageRounded(reinterpret_cast<ImTextureID>(made->texture), low, high, {0, 1}, {1, 0}, IM_COL32_WHITE,
                          round);
  } else {
    list->AddRectFilled(low, high, ImGui::GetColorU32(ImGuiCol_FrameBg), round);
  }
  if (chosen)
    list->AddRect({low.x + 1, low.y + 1}, {high.x - 1, high.y - 1}, ImGui::GetColorU32(ImGuiCol_CheckMark), round, 0,
                  2 * ui.text_scale);
  const std::string name = readable(stem(file));
  const float width = ImGui::CalcTextSize(name.c_str()).x;
  const ImVec2 at(low.x + std::max(0.0f, 0.5f * (side - width)), high.y + 1);
  const ImVec4 within(low.x, high.y, high.x, ImGui::GetItemRectMax().y);
  const bool faulty = made != ui.preset_pictures.end() && made->faulty;
  list->AddText(nullptr, 0, at, ImGui::GetColorU32(faulty ? ImGuiCol_TextDisabled : ImGuiCol_Text), name.c_str(),
                nullptr, 0, &within);
}

void presetTip(const std::string& file, UiState& ui) {
  if (!ImGui::IsItemHovered()) return;
  if (std::exchange(ui.scoped_preset, file) != file) ui.preset_scope = scopeOf(file);
  tip(readable(stem(file)) + ": " + ui.preset_scope);
}

// Rows of pictures; the rest is scrolled to. Arrow keys go from one to the next.
void pictureGrid(Demo& demo, UiState& ui) {
  const ImGuiStyle& style = ImGui::GetStyle();
  const float room = ImGui::GetContentRegionAvail().x - style.ScrollbarSize;
  const float side = std::floor((room - (kPicturesAcross - 1) * kPictureGap) / kPicturesAcross);
  const float height = side + ImGui::GetTextLineHeight() + 3;
  if (ImGui::BeginChild("preset_pictures", {0, kPictureRows * (height + kPictureGap)}, false,
                        ImGuiWindowFlags_NavFlattened)) {
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {kPictureGap, kPictureGap});
    for (std::size_t k = 0; k < ui.presets.size(); ++k) {
      const std::string& file = ui.presets[k];
      if (k % kPicturesAcross != 0) ImGui::SameLine();
      ImGui::PushID(file.c_str());
      const bool chosen = file == demo.scene.preset;
      if (ImGui::Selectable("##picture", false, 0, {side, height})) postRequest(demo, {Ask::kPresetFile, "", file});
      noteItem("preset_picture " + stem(file), ui);
      presetTip(file, ui);
      if (ImGui::IsItemVisible()) {
        ui.presets_in_sight.push_back(file);
        drawPreset(file, side, chosen, ui);
      }
      ImGui::PopID();
    }
    ImGui::PopStyleVar();
  }
  ImGui::EndChild();
}

void presetCombo(Demo& demo, UiState& ui) {
  rowLabel("Preset", "Sets the groups of parameters that it names: what it leaves out of them takes its default");
  const std::string shown = presetTitle(demo);
  const std::string file = fileCombo("##preset", shown, ui.presets, ui);
  noteItem("preset " + shown, ui);
  if (!file.empty()) postRequest(demo, {Ask::kPresetFile, "", file});
}

void savePresetRow(Demo& demo, UiState& ui) {
  rowLabel("Save as", "Writes every parameter to NAME.json in the working folder");
  const bool replaces = !ui.to_replace.empty() && ui.to_replace == std::string(ui.preset_name.data()) + ".json";
  const float button = (replaces ? 72 : 52) * ui.text_scale;
  ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x - button - 5);
  const bool entered = ImGui::InputTextWithHint("##preset_name", "name, then Enter", ui.preset_name.data(),
                                                ui.preset_name.size(), ImGuiInputTextFlags_EnterReturnsTrue);
  noteItem("preset_name", ui);
  ImGui::SameLine(0, 5);
  const bool pressed = ImGui::Button(replaces ? "Replace" : "Save", {button, 0});
  noteItem("save_preset", ui);
  if (replaces) tip("A file of this name is there already");
  if ((entered || pressed) && ui.preset_name[0]) savePreset(demo, ui);
}

}  // namespace

void presetRows(Demo& demo, UiState& ui) {
  presetCombo(demo, ui);
  // In a low window, or a sheet over half of one, the list alone.
  if (ImGui::GetWindowHeight() > kMinRoomOfPictures * ui.text_scale) pictureGrid(demo, ui);
  savePresetRow(demo, ui);
}

}  // namespace app
