// The history panel: every step by name, the present one lit.
#include <imgui/imgui.h>

#include <algorithm>
#include <cctype>

#include "app/ui/ui_panels.h"
#include "app/ui/ui_widgets.h"

namespace app {

namespace {

constexpr float kHistoryWidth = 292, kMinHeight = 130, kHistoryMargin = 12;

std::string titleOf(const EditStep& step) {
  std::string title = step.title;
  title[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(title[0])));
  return title;
}

// A line for the moment after `done` steps. A press goes there.
void momentLine(std::size_t done, const std::string& title, Demo& demo, UiState& ui) {
  const EditHistory& edits = demo.edits;
  const bool here = done == edits.done;
  ImGui::PushID(static_cast<int>(done));
  if (done > edits.done) ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetStyleColorVec4(ImGuiCol_TextDisabled));
  const bool pressed = ImGui::Selectable(title.c_str(), here);
  if (done > edits.done) ImGui::PopStyleColor();
  noteItem("moment " + std::to_string(done), ui);
  if (here && (ImGui::IsWindowAppearing() || ui.history_shows != done)) {
    ImGui::SetScrollHereY(0.5f);
    ui.history_shows = done;
  }
  ImGui::PopID();
  if (!pressed || here) return;
  const double steps = static_cast<double>(done) - static_cast<double>(edits.done);
  if (steps > 0) return postRequest(demo, {Ask::kRedo, "", "", steps});
  postRequest(demo, {Ask::kUndo, "", "", heldEdits(demo.loading) - steps});
}

void momentLines(Demo& demo, UiState& ui) {
  const EditHistory& edits = demo.edits;
  momentLine(0, edits.forgot ? "As far back as is kept" : "Opened", demo, ui);
  for (std::size_t k = 0; k < edits.steps.size(); ++k) momentLine(k + 1, titleOf(edits.steps[k]), demo, ui);
}

}  // namespace

float historyLeast(const UiState& ui) {
  const bool shown = ui.history && ui.visible && !ui.history_in_sidebar;
  return shown ? (kMinHeight + kHistoryMargin) * ui.text_scale : 0;
}

void historyPanel(Demo& demo, UiState& ui) {
  ui.history_width = ui.history_height = 0;
  if (historyLeast(ui) == 0) return;
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  const float scale = ui.text_scale, margin = kHistoryMargin * scale;
  const float width = std::min(kHistoryWidth * scale, size.x - 2 * margin);
  // Below the timings where they leave room.
  const float room = size.y - ui.timings_bottom - 2 * margin;
  const float height = std::clamp(room, std::min(kMinHeight * scale, size.y - 2 * margin), 0.5f * size.y);
  ui.history_width = width + margin, ui.history_height = height + margin;
  ImGui::SetNextWindowPos({size.x - margin, size.y - margin}, ImGuiCond_Always, {1, 1});
  ImGui::SetNextWindowSize({std::max(32.0f, width), std::max(32.0f, height)});
  const ImGuiWindowFlags flags = ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoCollapse;
  ImGui::SetNextWindowBgAlpha(1);
  if (ImGui::Begin("History", &ui.history, flags)) {
    momentLines(demo, ui);
  }
  ImGui::End();
}

void historyList(Demo& demo, UiState& ui) {
  if (ImGui::BeginChild("history", {0, kMinHeight * ui.text_scale}, true)) momentLines(demo, ui);
  ImGui::EndChild();
  noteItem("history list", ui);
}

}  // namespace app
