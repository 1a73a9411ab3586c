#include <imgui/imgui.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string>

#include "app/files/report_line.h"
#include "app/ui/ui_panels.h"
#include "app/ui/ui_widgets.h"

namespace app {

namespace {

// Stages as the paper's figure 6 groups them, then the frame's other costs.
constexpr std::array<ImU32, kFrameStageCount> kStageColors{
    IM_COL32(226, 140, 88, 255),  IM_COL32(240, 196, 110, 255), IM_COL32(118, 178, 130, 255),
    IM_COL32(86, 156, 190, 255),  IM_COL32(140, 140, 150, 255), IM_COL32(176, 132, 196, 255),
    IM_COL32(104, 112, 190, 255), IM_COL32(84, 92, 108, 255),   IM_COL32(60, 66, 76, 255)};

using Stages = std::array<double, kFrameStageCount>;

// Mean over the last half second: single frames are too jumpy to read.
Stages meanStages(const Demo& demo, std::size_t frames) {
  Stages mean{};
  const std::size_t count = std::min(frames, demo.history.size());
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t at = (demo.history_next + kHistoryLength - 1 - i) % kHistoryLength;
    if (at >= demo.history.size()) continue;
    for (int s = 0; s < kFrameStageCount; ++s) mean[s] += demo.history[at].seconds[s] / static_cast<double>(count);
  }
  return mean;
}

double sum(const Stages& stages, int first, int last) {
  double total = 0;
  for (int s = first; s <= last; ++s) total += stages[s];
  return total;
}

void stackedBar(const Stages& stages, int first, int last, float height) {
  const float width = ImGui::GetContentRegionAvail().x;
  const ImVec2 at = ImGui::GetCursorScreenPos();
  ImDrawList* list = ImGui::GetWindowDrawList();
  const double total = std::max(1e-9, sum(stages, first, last));
  float x = at.x;
  for (int s = first; s <= last; ++s) {
    const float w = static_cast<float>(stages[s] / total) * width;
    if (w < 0.5f) continue;
    list->AddRectFilled({x, at.y}, {x + w, at.y + height}, kStageColors[s]);
    x += w;
  }
  ImGui::Dummy({width, height});
}

// Three digits are all that a glance can use.
std::string shortMilliseconds(double seconds) {
  const double value = 1e3 * seconds;
  char text[32];
  std::snprintf(text, sizeof text, value < 9.995 ? "%.2f" : value < 99.95 ? "%.1f" : "%.0f", value);
  return text;
}

void legend(const Stages& stages, int first, int last, float scale) {
  const float gap = 14 * scale;
  const float column = 0.5f * (ImGui::GetContentRegionAvail().x + gap);
  const float left = ImGui::GetCursorPosX();
  int place = 0;
  for (int s = first; s <= last; ++s, ++place) {
    const float start = left + (place % 2 ? column : 0);
    if (place % 2) ImGui::SameLine(start);
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float text = ImGui::GetTextLineHeight(), box = 9 * scale;
    const float y = at.y + 0.5f * (text - box);
    ImGui::GetWindowDrawList()->AddRectFilled({at.x, y}, {at.x + box, y + box}, kStageColors[s], 2);
    ImGui::Dummy({box + 2 * scale, text});
    ImGui::SameLine(0, 3);
    ImGui::TextDisabled("%s", kFrameStageNames[s].data());
    const std::string value = shortMilliseconds(stages[s]);
    ImGui::SameLine(start + column - gap - ImGui::CalcTextSize(value.c_str()).x);
    ImGui::TextUnformatted(value.c_str());
  }
}

// Stacked areas over the last frames, with the budget of a sixtieth of a second as a line when it is in reach.
void historyPlot(const Demo& demo, int first, int last, float height) {
  const float width = ImGui::GetContentRegionAvail().x;
  const ImVec2 at = ImGui::GetCursorScreenPos();
  ImDrawList* list = ImGui::GetWindowDrawList();
  list->AddRectFilled(at, {at.x + width, at.y + height}, ImGui::GetColorU32(ImGuiCol_FrameBg), 3);
  double highest = 1e-4;
  for (const FrameStats& frame : demo.history) highest = std::max(highest, sum(frame.seconds, first, last));
  // The next of 1, 2, 5 times a power of ten, so that the scale does not breathe.
  const double decade = std::pow(10, std::floor(std::log10(highest)));
  const double top = highest <= decade       ? decade
                     : highest <= 2 * decade ? 2 * decade
                     : highest <= 5 * decade ? 5 * decade
                                             : 10 * decade;
  const std::size_t count = demo.history.size();
  const float bar = width / static_cast<float>(kHistoryLength);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t oldest = count < kHistoryLength ? 0 : demo.history_next;
    const FrameStats& frame = demo.history[(oldest + i) % kHistoryLength];
    float y = at.y + height;
    const float x = at.x + bar * static_cast<float>(i + kHistoryLength - count);
    for (int s = first; s <= last; ++s) {
      const float h = static_cast<float>(frame.seconds[s] / top) * height;
      if (h < 0.2f) continue;
      list->AddRectFilled({x, y - h}, {x + bar + 0.5f, y}, kStageColors[s]);
      y -= h;
    }
  }
  const std::string label = threeDigits(1e3 * top) + " ms";
  list->AddText({at.x + 5, at.y + 2}, ImGui::GetColorU32(ImGuiCol_TextDisabled), label.c_str());
  ImGui::Dummy({width, height});
}

// The latest frame that `has` something to say: frames without a step, or kept from the one before, say nothing.
template <class Has>
const FrameStats& latest(const Demo& demo, Has&& has) {
  const std::size_t count = demo.history.size();
  for (std::size_t i = 0; i < count; ++i) {
    const FrameStats& frame = demo.history[(demo.history_next + 2 * count - 1 - i) % count];
    if (has(frame)) return frame;
  }
  return demo.stats;
}

void solverLines(const Demo& demo) {
  const FrameStats& stats = latest(demo, [](const FrameStats& frame) { return frame.steps > 0; });
  const FrameStats& drawn = latest(demo, [](const FrameStats& frame) { return frame.draw.strands_drawn > 0; });
  const auto line = [](const char* name, const char* format, auto... values) {
    ImGui::TextDisabled("%s", name);
    ImGui::SameLine(0.46f * ImGui::GetWindowWidth());
    ImGui::Text(format, values...);
  };
  line("iterations", stats.steps > 1 ? "%d in %d steps" : "%d", stats.solver_iterations, stats.steps);
  line("residual", stats.converged ? "%.1e" : "%.1e, not converged", stats.residual);
  line("contacts", "%d", stats.contacts);
  line("corrected", "%d, deepest %.1f mm", stats.corrected, 1e3 * stats.max_penetration);
  line("recoveries", "%d", stats.recoveries);
  double saved = 0;
  for (const SkipCount& count : stats.skipped) saved += count.seconds;
  line("skips save", "%.2f ms", 1e3 * saved);
  if (drawn.draw.strands_drawn > 0) {
    line("strands", "%ld", drawn.draw.strands_drawn);
    line("hair on GPU", "%.1f KB", static_cast<double>(drawn.draw.gpu_bytes_hair) / 1024);
  }
}

}  // namespace

void timingsPanel(Demo& demo, UiState& ui) {
  const Stages stages = meanStages(demo, 30);
  const float scale = ui.text_scale;
  if (demo.paused) {
    ImGui::TextWrapped("Paused: these are of the last frames that ran");
    noteItem("timings paused", ui);
  }
  ImGui::Text("Simulation");
  ImGui::SameLine();
  ImGui::TextDisabled("%s ms a frame", shortMilliseconds(sum(stages, kTimeForces, kTimeStepOther)).c_str());
  stackedBar(stages, kTimeForces, kTimeStepOther, 12 * scale);
  noteItem("stage_bar", ui);
  legend(stages, kTimeForces, kTimeStepOther, scale);
  historyPlot(demo, kTimeForces, kTimeStepOther, 58 * scale);
  budgetLines(demo, ui);
  ImGui::Spacing();
  ImGui::Text("Frame");
  ImGui::SameLine();
  ImGui::TextDisabled("%s ms", shortMilliseconds(sum(stages, 0, kFrameStageCount - 1)).c_str());
  stackedBar(stages, 0, kFrameStageCount - 1, 8 * scale);
  legend(stages, kTimeCharacter, kTimePanels, scale);
  drawBudgetLines(demo, ui);
  ImGui::Separator();
  solverLines(demo);
}

}  // namespace app
