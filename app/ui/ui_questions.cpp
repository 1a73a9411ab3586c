// Boxes that wait for an answer: whether to leave, and what an earlier run has left.
#include <imgui/imgui.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <ctime>
#include <string>

#include "app/ui/ui_panels.h"
#include "app/ui/ui_widgets.h"

namespace app {

namespace {

constexpr float kOfferHeight = 90;  // points that the box of an earlier run's project needs
constexpr ImGuiWindowFlags kQuestion =
    ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_AlwaysAutoResize;

// ", at 13:05:40,"; of another day ", on 28 Nov at 13:05:40,"; empty where the file does not tell.
std::string keptAt(const std::string& file) {
  struct stat entry;
  if (stat(file.c_str(), &entry) != 0) return "";
  const std::time_t now = std::time(nullptr);
  std::tm written{}, today{};
  if (!localtime_r(&entry.st_mtime, &written) || !localtime_r(&now, &today)) return "";
  const bool same_day = written.tm_year == today.tm_year && written.tm_yday == today.tm_yday;
  std::array<char, 64> text{};
  std::strftime(text.data(), text.size(), same_day ? ", at %H:%M:%S," : ", on %d %b at %H:%M:%S,", &written);
  return text.data();
}

// In a small window in several lines.
void questionWords(const char* text, float room, const UiState& ui) {
  ImGui::PushTextWrapPos(std::min(420.0f, room / ui.text_scale - 24) * ui.text_scale);
  ImGui::TextUnformatted(text);
  ImGui::PopTextWrapPos();
}

bool answered(const char* label, const char* item, UiState& ui) {
  const bool pressed = ImGui::Button(label);
  noteItem(item, ui);
  return pressed;
}

}  // namespace

void offerPanel(const NoticePlace& place, Demo& demo, UiState& ui) {
  // Where a fault leaves it no room it waits until that is closed.
  if (ui.offered.empty() || place.bottom < kOfferHeight * ui.text_scale) return;
  ImGui::SetNextWindowPos({place.left + 0.5f * place.width, place.bottom}, ImGuiCond_Always, {0.5f, 1});
  ImGui::SetNextWindowBgAlpha(1);
  if (ImGui::Begin("offer", nullptr, kQuestion)) {
    questionWords(
        ("The program was not closed properly before. What it had" + keptAt(ui.offered) + " was kept.").c_str(),
        place.width, ui);
    const bool open = answered("Open it", "offer_open", ui);
    ImGui::SameLine(0, 6);
    const bool forget = answered("Forget it", "offer_forget", ui);
    if (open) postRequest(demo, {Ask::kOpenProject, "", ui.to_go_on_from = ui.offered});
    if (forget) ui.to_forget = ui.offered;
    if (open || forget) ui.offered.clear();
  }
  ImGui::End();
}

void leavePanel(const NoticePlace& place, Demo& demo, UiState& ui) {
  if (!ui.leaving) return;
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({place.left + 0.5f * place.width, 0.5f * size.y}, ImGuiCond_Always, {0.5f, 0.5f});
  ImGui::SetNextWindowBgAlpha(1);
  if (ImGui::Begin("leave", nullptr, kQuestion)) {
    const bool lost = isUnsaved(demo.edits);
    questionWords(lost ? "Leave? What was changed is not saved." : "Leave the program?", place.width, ui);
    ui.quit = answered("Leave", "leave", ui) || ui.quit;
    ImGui::SameLine(0, 6);
    if (lost) {
      if (answered("Save...", "leave_save", ui)) ui.leaving = false, browseToSave(demo, ui);
      ImGui::SameLine(0, 6);
    }
    if (answered("Stay", "stay", ui)) ui.leaving = false;
    ImGui::SameLine(0, 12);
    ImGui::AlignTextToFramePadding();
    ImGui::TextDisabled(lost ? "Esc stays, Ctrl+Q leaves" : "Esc stays");
  }
  ImGui::End();
}

}  // namespace app
