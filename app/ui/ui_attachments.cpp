// Hats, glasses, collars: what the character wears, and what it may put on.
#include <imgui/imgui.h>

#include <nlohmann/json.hpp>

#include "app/files/data_path.h"
#include "app/scene/attachments.h"
#include "app/ui/ui_panels.h"
#include "app/ui/ui_widgets.h"

namespace app {

namespace {

void postAll(const std::vector<AttachmentSpec>& attachments, Demo& demo) {
  postRequest(demo, {Ask::kAttach, "", writeAttachments(attachments).dump()});
}

// One that is worn: its colour, and a button that takes it off.
void wornRow(std::size_t k, Demo& demo, UiState& ui) {
  AttachmentSpec& one = ui.worn[k];
  rowLabel(readable(stem(one.file)), "At the joint " + one.joint + ": " + one.file);
  ImGui::PushID(static_cast<int>(k));
  std::array<float, 3> color = one.color.value_or(wornColor(selectedActor(demo), k));
  if (ImGui::ColorEdit3("##color", color.data(), ImGuiColorEditFlags_NoInputs))
    one.color = color, ui.worn_edited = true;
  ImGui::SameLine();
  if (ImGui::SmallButton("Take off")) {
    std::vector<AttachmentSpec> all = ui.worn;
    all.erase(all.begin() + static_cast<std::ptrdiff_t>(k));
    postAll(all, demo);
  }
  noteItem("take off " + stem(one.file), ui);
  ImGui::PopID();
}

}  // namespace

void attachmentSection(Demo& demo, UiState& ui) {
  const bool held = ImGui::IsAnyItemActive();
  if (ui.worn_edited && !held) {
    postAll(ui.worn, demo);
    ui.worn_edited = false;
  } else if (!held) {
    ui.worn = selectedActor(demo).spec.attachments;
  }
  const std::size_t count = ui.worn.size();
  for (std::size_t k = 0; k < count; ++k) wornRow(k, demo, ui);
  rowLabel("Put on", "A closed mesh that the hair collides with; one that is dropped on the window goes to the head");
  ImGui::SetNextItemWidth(-1);
  if (ImGui::BeginCombo("##attach", count == 0 ? "nothing worn" : "another")) {
    for (const std::string& file : ui.attachments) {
      if (ImGui::Selectable(readable(stem(file)).c_str())) postRequest(demo, {Ask::kAttach, "add", file});
      noteItem("attach " + stem(file), ui);
    }
    ImGui::EndCombo();
  }
  noteItem("attach", ui);
}

}  // namespace app
