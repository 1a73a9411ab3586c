// The two budget governors' and the deadline's corner of the timings panel.
#include <imgui/imgui.h>

#include <algorithm>
#include <cstdio>

#include "app/ui/ui_panels.h"
#include "app/ui/ui_widgets.h"

namespace app {

namespace {

constexpr float kSmallest = 0.05f, kLargest = 50;  // ms, of the slider; --budget-ms takes more
constexpr float kLargestDrawing = 500;             // ms, of the drawing's slider
constexpr double kUsualDeadline = 8;               // ms: half a frame of 60 a second
constexpr double kHeadroom = 1.5;                  // of the present cost, when the governor is switched on

void line(const char* name, const char* text) {
  ImGui::TextDisabled("%s", name);
  ImGui::SameLine(0.46f * ImGui::GetWindowWidth());
  ImGui::TextUnformatted(text);
}

double recentSimulation(const Demo& demo) {
  double sum = 0;
  for (const FrameStats& frame : demo.history) sum += frame.simulation();
  return demo.history.empty() ? 0 : sum / static_cast<double>(demo.history.size());
}

// What the deadline left out over the last frames.
void leftOutLine(const Demo& demo) {
  int solves = 0, corrections = 0;
  double lost = demo.stats.lost;
  for (const FrameStats& frame : demo.history) {
    solves += frame.solves_cut;
    corrections += frame.corrections_cut;
    lost = std::min(lost, frame.lost);
  }
  char text[96];
  std::snprintf(text, sizeof text, "%.0f ms, %d solves, %d corrections", 1e3 * (demo.stats.lost - lost), solves,
                corrections);
  line("left out", text);
  tip("Over the frames of the plot: motion that was not simulated, steps whose solve or corrections ended early");
}

double recentDrawing(const Demo& demo) {
  double sum = 0;
  for (const FrameStats& frame : demo.history) sum += frame.seconds[kTimeDraw];
  return demo.history.empty() ? 0 : sum / static_cast<double>(demo.history.size());
}

void deadlineLines(Demo& demo, UiState& ui) {
  bool on = demo.deadline.seconds > 0;
  if (ImGui::Checkbox("Never over", &on)) postRequest(demo, {Ask::kDeadline, "", "", on ? kUsualDeadline : 0.0});
  noteItem("deadline on", ui);
  tip("No frame's simulation takes longer, by counted work: steps, iterations and corrections beyond are left out, but "
      "for what contacts need");
  if (!on) return;
  ImGui::SameLine(0.46f * ImGui::GetWindowWidth());
  ImGui::SetNextItemWidth(-1);
  float deadline = static_cast<float>(1e3 * demo.deadline.seconds);
  {
    const MarksBelowDigits marks;
    if (ImGui::SliderFloat("##deadline", &deadline, kSmallest, kLargest, "%.2f ms", ImGuiSliderFlags_Logarithmic))
      postRequest(demo, {Ask::kDeadline, "", "", deadline});
  }
  noteItem("deadline", ui);
  leftOutLine(demo);
}

void governorLines(Demo& demo, UiState& ui) {
  const Governor& governor = demo.governor;
  bool on = governor.budget > 0;
  if (ImGui::Checkbox("Hold to", &on)) {
    const double start = std::clamp(1e3 * kHeadroom * recentSimulation(demo), double(kSmallest), double(kLargest));
    postRequest(demo, {Ask::kBudget, "", "", on ? start : 0.0});
  }
  noteItem("budget on", ui);
  tip("Picks integrator, time step and tolerance so that the simulation takes so long a frame, and no longer");
  if (!on) return;
  ImGui::SameLine(0.46f * ImGui::GetWindowWidth());
  ImGui::SetNextItemWidth(-1);
  float budget = static_cast<float>(1e3 * governor.budget);
  {
    const MarksBelowDigits marks;
    if (ImGui::SliderFloat("##budget", &budget, kSmallest, kLargest, "%.2f ms a frame", ImGuiSliderFlags_Logarithmic))
      postRequest(demo, {Ask::kBudget, "", "", budget});
  }
  noteItem("budget", ui);
  const Rung& rung = ladder()[governor.rung];
  char text[96];
  std::snprintf(text, sizeof text, "%s 1/%.0f, %.0e", rung.integrator == sim::Integrator::kBdf2 ? "BDF2" : "Euler",
                rung.steps_per_second, rung.tolerance);
  line("runs", text);
  std::snprintf(text, sizeof text, "%.2f, expected %.2f", 1e3 * governor.measured_cost, 1e3 * governor.predicted_cost);
  line("ms a frame", text);
  std::snprintf(text, sizeof text, "%.1e, expected %.1e", governor.measured_error, predictedError(governor));
  line("error / length", text);
  tip("Expected: the mean over the styles and motions that the setting was measured on");
  if (governor.over_budget) ImGui::TextDisabled("the coarsest setting takes longer");
}

}  // namespace

void drawBudgetLines(Demo& demo, UiState& ui) {
  const DrawGovernor& governor = demo.draw_governor;
  bool on = governor.budget > 0;
  if (ImGui::Checkbox("Draw within", &on)) {
    const double start = std::clamp(1e3 * recentDrawing(demo), double(kSmallest), double(kLargestDrawing));
    postRequest(demo, {Ask::kDrawBudget, "", "", on ? start : 0.0});
  }
  noteItem("draw budget on", ui);
  tip("Thins strands and segments so that the drawing takes so long a frame, and no longer");
  if (!on) return;
  ImGui::SameLine(0.46f * ImGui::GetWindowWidth());
  ImGui::SetNextItemWidth(-1);
  float budget = static_cast<float>(1e3 * governor.budget);
  {
    const MarksBelowDigits marks;
    if (ImGui::SliderFloat("##draw_budget", &budget, kSmallest, kLargestDrawing, "%.1f ms a frame",
                           ImGuiSliderFlags_Logarithmic))
      postRequest(demo, {Ask::kDrawBudget, "", "", budget});
  }
  noteItem("draw budget", ui);
  char text[96];
  std::snprintf(text, sizeof text, "%d of %d", governor.rung, static_cast<int>(drawLadder().size()) - 1);
  line("rung", text);
  line("draws", drawRungName(governor).c_str());
  std::snprintf(text, sizeof text, "%.2f", 1e3 * governor.measured_cost);
  line("ms a frame", text);
  if (governor.over_budget) ImGui::TextDisabled("the cheapest setting takes longer");
}

void budgetLines(Demo& demo, UiState& ui) {
  governorLines(demo, ui);
  deadlineLines(demo, ui);
}

}  // namespace app
