// Hats, glasses, collars: what the character wears, and what it may put on.
#include <imgui/imgui.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <span>

#include "app/files/data_path.h"
#include "app/scene/attachments.h"
#include "app/ui/ui_panels.h"
#include "app/ui/ui_widgets.h"

namespace app {

namespace {

void postAll(const std::vector<AttachmentSpec>& attachments, Demo& demo) {
  postRequest(demo, {Ask::kAttach, "", writeAttachments(attachments).dump()});
}

void postDragged(Demo& demo, const UiState& ui) {
  postRequest(demo, {Ask::kDragWorn, "", writeAttachments(ui.worn).dump()});
}

// Numbers that are dragged, or typed after a double click; `standard`: what the mark at the end goes back to.
bool dragRow(const char* label, const std::string& name, const std::string& help, std::span<float> values,
             std::span<const float> standard, const char* format, float speed, float low, float high, UiState& ui) {
  rowLabel(label, help + ". Drag, or double-click to type");
  const bool touched = !std::ranges::equal(values, standard);
  const float reset = touched ? kResetWidth * ui.text_scale + 4 : 0;
  ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x - reset);
  ImGui::PushID(label);
  bool changed = ImGui::DragScalarN("##value", ImGuiDataType_Float, values.data(), static_cast<int>(values.size()),
                                    speed, &low, &high, format, ImGuiSliderFlags_AlwaysClamp);
  noteItem(name, ui);
  if (touched && resetMark(name.c_str(), "how the file has it", ui)) {
    std::ranges::copy(standard, values.begin());
    changed = true;
  }
  ImGui::PopID();
  return changed;
}

// Where one that is worn sits, how it is turned, and how large it is.
void placeRows(std::size_t k, const Demo& demo, UiState& ui) {
  AttachmentSpec& one = ui.worn[k];
  const std::vector<WornAttachment>& worn = selectedActor(demo).worn;
  const std::string of = " " + stem(one.file);
  constexpr std::array<float, 3> kZero{};
  constexpr std::array kOne{1.0f};
  const auto floats = [](const Vec3& v) { return std::array{float(v.x()), float(v.y()), float(v.z())}; };
  // What was inferred is moved and turned on from where it is.
  const bool known = k < worn.size();
  const Vec3 place = known && one.at.isZero() ? worn[k].mesh->at : one.at;
  std::array<float, 3> at = floats(100 * place);
  const std::array<float, 3> standard_at = one.at.isZero() ? at : kZero;
  constexpr auto kFarthest = static_cast<float>(100 * kFarthestAttachment);
  if (dragRow("Place", "place" + of, "cm from the joint: to the figure's left, up, to the front", at, standard_at,
              "%.1f cm", 0.05f, -kFarthest, kFarthest, ui)) {
    one.at = Vec3(at[0], at[1], at[2]) / 100;
    ui.worn_edited = true;
  }
  const Vec3 inferred = known && one.turn.isZero() ? worn[k].mesh->turn : one.turn;
  std::array<float, 3> turn = floats(inferred);
  const std::array<float, 3> standard = one.turn.isZero() ? turn : kZero;
  if (dragRow("Turn", "turn" + of, "Degrees about the axis to the left, then the one up, then the one to the front",
              turn, standard, "%.0f deg", 0.5f, -kMaxAttachmentTurn, kMaxAttachmentTurn, ui)) {
    one.turn = Vec3(turn[0], turn[1], turn[2]), one.at = place;
    ui.worn_edited = true;
  }
  std::array size{static_cast<float>(one.size)};
  if (dragRow("Size", "size" + of, "Times as large, about the joint", size, kOne, "%.2f x", 0.003f, kSmallestTimes,
              kLargestTimes, ui)) {
    one.size = size[0], one.at = place, one.turn = inferred;
    ui.worn_edited = true;
  }
}

// One that is worn: its colour, a button that takes it off, and where it sits.
void wornRow(std::size_t k, Demo& demo, UiState& ui) {
  AttachmentSpec& one = ui.worn[k];
  rowLabel(readable(stem(one.file)), "At the joint " + one.joint + ": " + one.file);
  ImGui::PushID(static_cast<int>(k));
  std::array<float, 3> color = one.color.value_or(wornColor(selectedActor(demo), k));
  if (colorSwatch("##color", color, ImGuiColorEditFlags_NoInputs)) one.color = color, ui.worn_edited = true;
  noteItem("color " + stem(one.file), ui);
  ImGui::SameLine();
  if (ImGui::SmallButton("Take off")) {
    std::vector<AttachmentSpec> all = ui.worn;
    all.erase(all.begin() + static_cast<std::ptrdiff_t>(k));
    postAll(all, demo);
  }
  noteItem("take off " + stem(one.file), ui);
  placeRows(k, demo, ui);
  ImGui::PopID();
}

}  // namespace

void attachmentSection(Demo& demo, UiState& ui) {
  const bool held = ImGui::IsAnyItemActive();
  if (ui.worn_edited && !held) {
    postDragged(demo, ui);  // it is drawn there until it is loaded
    postAll(ui.worn, demo);
    ui.worn_edited = false;
  } else if (!held && !demo.loading.running.valid()) {
    ui.worn = selectedActor(demo).spec.attachments;
  }
  const std::size_t count = ui.worn.size();
  for (std::size_t k = 0; k < count; ++k) wornRow(k, demo, ui);
  if (ui.worn_edited) postDragged(demo, ui);
  rowLabel("Put on", "A closed mesh that the hair collides with; one that is dropped on the window goes to the head");
  const float button = 58 * ui.text_scale;
  ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x - button - 5);
  if (ImGui::BeginCombo("##attach", count == 0 ? "nothing worn" : "another")) {
    for (const std::string& file : ui.attachments) {
      if (ImGui::Selectable(readable(stem(file)).c_str())) postRequest(demo, {Ask::kAttach, "add", file});
      noteItem("attach " + stem(file), ui);
    }
    ImGui::EndCombo();
  }
  noteItem("attach", ui);
  ImGui::SameLine(0, 5);
  if (ImGui::Button("Open...##attach", {button, 0})) browseFor(BrowseFor::kWorn, ui);
  noteItem("open attach", ui);
}

}  // namespace app
