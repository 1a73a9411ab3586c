// Comparing: what with, how it is shown, what the two differ by, and the line between them that a drag moves.
#include <imgui/imgui.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "app/files/data_path.h"
#include "app/ui/ui_panels.h"
#include "app/ui/ui_widgets.h"

namespace app {

namespace {

constexpr float kGrip = 9;  // px about the line within which it can be grasped

std::string otherTitle(const Comparison& comparison) {
  if (!comparison.on()) return "nothing";
  return comparison.with.empty() ? "as it was" : readable(stem(comparison.with));
}

void choices(Demo& demo, UiState& ui) {
  const auto choice = [&](const std::string& label, const std::string& name, Request request) {
    if (ImGui::Selectable(label.c_str())) postRequest(demo, std::move(request));
    noteItem("compare " + name, ui);
  };
  choice("nothing", "nothing", {Ask::kCompare, "", "", 0});
  choice("as it is now", "now", {Ask::kCompare, "", "", 1});
  for (const std::string& file : ui.presets) choice(readable(stem(file)), stem(file), {Ask::kCompare, "", file, 1});
}

void differenceLines(const Demo& demo) {
  const Comparison& comparison = demo.comparison;
  const double frames = static_cast<double>(std::max(1L, comparison.frames));
  char text[96];
  rowLabel("Apart", "Of the same vertices now, root mean square and worst");
  if (comparison.now.known)
    std::snprintf(text, sizeof text, "%.1f mm, at most %.1f mm", 1e3 * comparison.now.rms, 1e3 * comparison.now.worst);
  else
    std::snprintf(text, sizeof text, "other hair");
  ImGui::TextDisabled("%s", text);
  rowLabel("Cost", "Milliseconds of simulation a frame, in the mean: left, right");
  std::snprintf(text, sizeof text, "%.2f and %.2f ms", 1e3 * comparison.seconds[0] / frames,
                1e3 * comparison.seconds[1] / frames);
  ImGui::TextDisabled("%s", text);
}

}  // namespace

void compareRows(Demo& demo, UiState& ui) {
  Comparison& comparison = demo.comparison;
  rowLabel("Compare with", "The same figure with other settings, simulated in step and shown beside it");
  ImGui::SetNextItemWidth(-1);
  const bool open = ImGui::BeginCombo("##compare", otherTitle(comparison).c_str());
  noteItem("compare", ui);
  if (open) {
    choices(demo, ui);
    ImGui::EndCombo();
  }
  if (!comparison.on()) return;
  const int pressed = segments("compare_view", {"Split by a line", "Side by side"}, comparison.side_by_side, ui);
  if (pressed >= 0) postRequest(demo, {Ask::kCompareView, pressed == 1 ? "side" : "split", "", comparison.line});
  differenceLines(demo);
}

void compareLine(Demo& demo, UiState& ui) {
  const Comparison& comparison = demo.comparison;
  const ImGuiIO& io = ImGui::GetIO();
  const float scale = ui.text_scale, width = io.DisplaySize.x;
  if (!comparison.on() || width < 1) {
    ui.line_held = ui.line_placed = false;
    return;
  }
  if (!std::exchange(ui.line_placed, true) && !comparison.side_by_side) {
    const PicturePart free = freePart(demo, ui);
    postRequest(demo, {Ask::kCompareView, "split", "", 0.5 * (free.left + free.right)});
  }
  const float x = width * static_cast<float>(comparison.side_by_side ? 0.5 : comparison.line);
  const float top = 0.14f * io.DisplaySize.y;
  ImDrawList* list = ImGui::GetBackgroundDrawList();
  const auto label = [&](const std::string& text, float at) {
    const ImVec2 size = ImGui::CalcTextSize(text.c_str());
    const ImVec2 low(at - 6 * scale, top - 4 * scale), high(at + size.x + 6 * scale, top + size.y + 4 * scale);
    list->AddRectFilled(low, high, IM_COL32(18, 19, 22, 190), 4 * scale);
    list->AddText({at, top}, ImGui::GetColorU32(ImGuiCol_Text), text.c_str());
  };
  const std::string other = otherTitle(comparison);
  label("now", x - ImGui::CalcTextSize("now").x - 16 * scale);
  label(other, x + 16 * scale);
  if (comparison.side_by_side) {
    ui.line_held = false;
    return;
  }
  const bool over = std::abs(io.MousePos.x - x) < kGrip * scale && !io.WantCaptureMouse;
  ui.line_held = io.MouseDown[0] && (ui.line_held || (over && ImGui::IsMouseClicked(0)));
  const float middle = 0.5f * io.DisplaySize.y, r = 11 * scale;
  list->AddCircleFilled({x, middle}, r,
                        ImGui::GetColorU32(over || ui.line_held ? ImGuiCol_NavHighlight : ImGuiCol_Button));
  for (const float side : {-1.0f, 1.0f})
    list->AddTriangleFilled({x + side * 7 * scale, middle}, {x + side * 3 * scale, middle - 4 * scale},
                            {x + side * 3 * scale, middle + 4 * scale}, ImGui::GetColorU32(ImGuiCol_Text));
  if (ui.line_held) postRequest(demo, {Ask::kCompareView, "split", "", std::clamp(io.MousePos.x / width, 0.0f, 1.0f)});
}

}  // namespace app
