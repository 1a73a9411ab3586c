#include <imgui/imgui.h>

#include <string>

#include "app/ui/ui_panels.h"
#include "app/ui/ui_widgets.h"

namespace app {

namespace {

std::string countText(const SkipCount& count) {
  if (count.of == 0) return "-";
  return std::to_string(count.skipped) + " of " + std::to_string(count.of);
}

}  // namespace

void skipsSection(Demo& demo, UiState& ui) {
  for (const Skip& skip : skipTable()) {
    bool on = demo.scene.skips[skip.id];
    const std::string label = readable(skip.name);
    if (ImGui::Checkbox(label.c_str(), &on)) postRequest(demo, {Ask::kSkip, skip.name, "", on ? 1.0 : 0.0});
    noteItem(std::string("skip ") + skip.name, ui);
    tip(std::string(skip.help) + (skip.exact ? " Changes nothing." : " May change: " + std::string(skip.bound) + "."));
    const SkipCount& count = demo.stats.skipped[skip.id];
    const std::string text = countText(count);
    ImGui::SameLine(0.42f * ImGui::GetWindowWidth());
    ImGui::TextDisabled("%s", text.c_str());
    tip(std::string("Left out in this frame, in ") + skip.counts);
    if (!skip.timed() || count.skipped == 0) continue;
    ImGui::SameLine(0.8f * ImGui::GetWindowWidth());
    ImGui::Text("%.2f ms", 1e3 * count.seconds);
    tip("Time saved in this frame, by what a step usually costs");
  }
  ImGui::Separator();
  ImGui::TextDisabled("always");
  for (const BuiltInSkip& skip : builtInSkips()) {
    const std::string label = readable(skip.name);
    ImGui::TextUnformatted(label.c_str());
    tip(skip.what);
    const std::string text = countText(demo.stats.always[skip.id]);
    ImGui::SameLine(0.42f * ImGui::GetWindowWidth());
    ImGui::TextDisabled("%s", text.c_str());
    tip(std::string("Left out in this frame, in ") + skip.counts);
  }
}

}  // namespace app
