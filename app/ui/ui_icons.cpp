// Signs drawn by the panels themselves: icon buttons, and the mark that resets a row.
#include <imgui/imgui.h>

#include <cmath>

#include "app/ui/ui_widgets.h"

namespace app {

namespace {

// A small turning arrow.
void drawTurn(ImDrawList* list, ImVec2 middle, float radius, ImU32 ink) {
  list->PathArcTo(middle, radius, -2.4f, 2.2f, 16);
  list->PathStroke(ink, 0, 1.6f);
  const ImVec2 end(middle.x + radius * std::cos(-2.4f), middle.y + radius * std::sin(-2.4f));
  const float s = 0.75f * radius;
  list->AddTriangleFilled({end.x - 0.7f * s, end.y - 0.25f * s}, {end.x + 0.75f * s, end.y - 0.55f * s},
                          {end.x + 0.1f * s, end.y + 0.8f * s}, ink);
}

// The sign of a button about its middle `m`, of scale `s`.
void drawIcon(Icon icon, ImVec2 m, float s, bool lit, ImU32 ink, ImDrawList* list) {
  const float r = 6 * s;
  switch (icon) {
    case Icon::kPlay:
      list->AddTriangleFilled({m.x - 0.7f * r, m.y - r}, {m.x - 0.7f * r, m.y + r}, {m.x + r, m.y}, ink);
      break;
    case Icon::kPause:
      list->AddRectFilled({m.x - 0.8f * r, m.y - r}, {m.x - 0.2f * r, m.y + r}, ink, 1);
      list->AddRectFilled({m.x + 0.2f * r, m.y - r}, {m.x + 0.8f * r, m.y + r}, ink, 1);
      break;
    case Icon::kStep:
      list->AddTriangleFilled({m.x - r, m.y - r}, {m.x - r, m.y + r}, {m.x + 0.45f * r, m.y}, ink);
      list->AddRectFilled({m.x + 0.55f * r, m.y - r}, {m.x + r, m.y + r}, ink, 1);
      break;
    case Icon::kBack:
      list->AddTriangleFilled({m.x + r, m.y - r}, {m.x + r, m.y + r}, {m.x - 0.45f * r, m.y}, ink);
      list->AddRectFilled({m.x - r, m.y - r}, {m.x - 0.55f * r, m.y + r}, ink, 1);
      break;
    case Icon::kReset:
      drawTurn(list, m, r, ink);
      break;
    case Icon::kRestart:
      list->AddTriangleFilled({m.x + r, m.y - r}, {m.x + r, m.y + r}, {m.x - 0.45f * r, m.y}, ink);
      list->AddRectFilled({m.x - r, m.y - r}, {m.x - 0.55f * r, m.y + r}, ink, 1);
      break;
    case Icon::kCollapse:
      // Four arrows towards a point.
      for (int k = 0; k < 4; ++k) {
        const float a = 0.7854f + 1.5708f * static_cast<float>(k), c = std::cos(a), d = std::sin(a);
        list->AddLine({m.x + 1.35f * r * c, m.y + 1.35f * r * d}, {m.x + 0.65f * r * c, m.y + 0.65f * r * d}, ink,
                      1.8f);
      }
      list->AddCircleFilled(m, 0.32f * r, ink, 12);
      break;
    case Icon::kPhoto:
      list->AddRect({m.x - 1.2f * r, m.y - 0.7f * r}, {m.x + 1.2f * r, m.y + 0.9f * r}, ink, 2, 0, 1.6f);
      list->AddRectFilled({m.x - 0.5f * r, m.y - 1.05f * r}, {m.x + 0.5f * r, m.y - 0.6f * r}, ink, 1);
      list->AddCircle({m.x, m.y + 0.1f * r}, 0.45f * r, ink, 16, 1.6f);
      break;
    case Icon::kRecord:
      list->AddCircleFilled(m, 0.85f * r, lit ? IM_COL32(235, 70, 60, 255) : ink, 20);
      break;
    case Icon::kPanels:
      for (int k = -1; k <= 1; ++k) {
        const float y = m.y + 0.75f * r * static_cast<float>(k);
        list->AddLine({m.x - r, y}, {m.x + r, y}, ink, 1.8f);
      }
      break;
    case Icon::kHelp:
      const ImVec2 text = ImGui::CalcTextSize("?");
      list->AddText({m.x - 0.5f * text.x, m.y - 0.5f * text.y}, ink, "?");
      break;
  }
}

}  // namespace

bool iconButton(Icon icon, const char* name, const std::string& help, bool lit, UiState& ui) {
  const float s = ui.text_scale;
  const ImVec2 size(32 * s, 30 * s);
  const bool pressed = ImGui::InvisibleButton(name, size);
  noteItem(name, ui);
  const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
  const ImVec2 m(0.5f * (low.x + high.x), 0.5f * (low.y + high.y));
  ImDrawList* list = ImGui::GetWindowDrawList();
  const ImGuiCol back = ImGui::IsItemActive()    ? ImGuiCol_ButtonActive
                        : ImGui::IsItemHovered() ? ImGuiCol_ButtonHovered
                                                 : ImGuiCol_Button;
  list->AddRectFilled(low, high, ImGui::GetColorU32(back), 5 * s);
  const ImU32 ink = lit ? ImGui::GetColorU32(ImGuiCol_CheckMark) : ImGui::GetColorU32(ImGuiCol_Text, 0.9f);
  drawIcon(icon, m, s, lit, ink, list);
  tip(help);
  return pressed;
}

bool resetMark(const char* name, const std::string& default_text, UiState& ui) {
  ImGui::SameLine(0, 4);
  const float height = ImGui::GetFrameHeight();
  ImGui::PushID("reset");
  const bool pressed = ImGui::InvisibleButton(name, {kResetWidth * ui.text_scale, height});
  ImGui::PopID();
  noteItem(std::string("reset ") + name, ui);
  const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
  drawTurn(ImGui::GetWindowDrawList(), {0.5f * (low.x + high.x), 0.5f * (low.y + high.y)}, 5 * ui.text_scale,
           ImGui::GetColorU32(ImGui::IsItemHovered() ? ImGuiCol_Text : ImGuiCol_CheckMark));
  tip("Back to " + default_text);
  return pressed;
}

}  // namespace app
