// The timeline along the bottom.
#include <imgui/imgui.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <tuple>
#include <utility>

#include "app/ui/ui_panels.h"
#include "app/ui/ui_widgets.h"

namespace app {

namespace {

constexpr float kTimelineHeight = 50, kMinWidth = 280, kOneRowWidth = 560, kTimelineMargin = 12;
constexpr float kButtonRow = 28, kMinWindow = 290;  // points; of a second row, of the window
constexpr float kSayMargin = 8;                     // px, beside words on the strip
constexpr double kAnewTime = 6;                     // s, as notices
constexpr double kWorst = 3;                        // of the mean cost: a step to look at

// The kept moment at a share of the strip.
long frameAt(float share, long first, long last) {
  return first + std::lround(std::clamp(share, 0.0f, 1.0f) * static_cast<double>(last - first));
}

void drawMarks(const Timeline& timeline, ImVec2 at, ImVec2 size, float scale) {
  ImDrawList* list = ImGui::GetWindowDrawList();
  double mean = 0;
  for (const TimelineFrame& frame : timeline.frames) mean += frame.cost / static_cast<double>(timeline.frames.size());
  const double first = static_cast<double>(timeline.frames.front().frame);
  const double span = std::max(1.0, static_cast<double>(timeline.frames.back().frame) - first);
  for (const TimelineFrame& frame : timeline.frames) {
    const float x = at.x + size.x * static_cast<float>((static_cast<double>(frame.frame) - first) / span);
    const auto mark = [&](float share, ImU32 color) {
      list->AddRectFilled({x - 0.8f * scale, at.y + size.y * (1 - share)}, {x + 0.8f * scale, at.y + size.y}, color);
    };
    if (frame.contact) mark(0.25f, IM_COL32(118, 178, 130, 200));
    if (frame.cost > kWorst * mean) mark(0.6f, IM_COL32(240, 196, 110, 230));
    if (frame.loop) mark(0.45f, IM_COL32(200, 150, 230, 255));
    if (frame.jump) mark(0.8f, IM_COL32(86, 156, 190, 255));
    if (frame.recovery) mark(1, IM_COL32(235, 70, 60, 255));
  }
}

// Between in and out the strip is lighter; each point has its bracket.
void drawRange(const Timeline& timeline, ImVec2 at, ImVec2 size) {
  ImDrawList* list = ImGui::GetWindowDrawList();
  const double first = static_cast<double>(timeline.frames.front().frame);
  const double span = std::max(1.0, static_cast<double>(timeline.frames.back().frame) - first);
  const auto place = [&](long frame) {
    return at.x + size.x * static_cast<float>(std::clamp((static_cast<double>(frame) - first) / span, 0.0, 1.0));
  };
  const float low = timeline.in >= 0 ? place(timeline.in) : at.x;
  const float high = timeline.out >= 0 ? place(timeline.out) : at.x + size.x;
  if (timeline.in >= 0 || timeline.out >= 0)
    list->AddRectFilled({low, at.y}, {high, at.y + size.y}, IM_COL32(255, 255, 255, 20));
  const ImU32 ink = ImGui::GetColorU32(ImGuiCol_Text);
  for (const auto& [set, x, side] :
       {std::tuple(timeline.in >= 0, low, 5.0f), std::tuple(timeline.out >= 0, high, -5.0f)}) {
    if (!set) continue;
    list->AddLine({x, at.y}, {x, at.y + size.y}, ink, 1.5f);
    for (const float y : {at.y, at.y + size.y - 1}) list->AddLine({x, y}, {x + side, y}, ink, 1.5f);
  }
}

// In, out, bake, clear.
void rangeButtons(Demo& demo, UiState& ui) {
  constexpr double kBakeSeconds = 5;
  const Timeline& timeline = demo.timeline;
  const auto button = [&](const char* label, const char* help, bool lit, Request request) {
    if (lit) ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetStyleColorVec4(ImGuiCol_CheckMark));
    if (ImGui::Button(label)) postRequest(demo, std::move(request));
    if (lit) ImGui::PopStyleColor();
    noteItem(std::string("range ") + label, ui);
    tip(help);
    ImGui::SameLine(0, 4);
  };
  button("In", "Playing goes on from here when it comes to the out point (I); again: off", timeline.in >= 0,
         {Ask::kMarkIn, "", "", timeline.in >= 0 ? 0.0 : 1.0});
  button("Out", "Playing goes back to the in point from here (O); again: off", timeline.out >= 0,
         {Ask::kMarkOut, "", "", timeline.out >= 0 ? 0.0 : 1.0});
  button("Bake", "Simulates from in to out, or five seconds on, faster than shown; then scrub", timeline.baking,
         {Ask::kBake, "", "", kBakeSeconds});
  button("Clear", "Forgets what was simulated, and both points", false, {Ask::kClearBake, "", ""});
}

// Why the strip has so little on it, as long as there is nothing on it and some seconds after; short where `room` (px)
// is. Empty: nothing to say.
const char* anewWords(const Timeline& timeline, float room, UiState& ui) {
  const double now = ImGui::GetTime();
  if (!timeline.anew || timeline.frames.empty()) ui.anew_since = now;
  if (!timeline.anew || now - ui.anew_since > kAnewTime) return "";
  constexpr const char *kWhole = "begins anew: another hair mesh", *kShort = "begins anew";
  return ImGui::CalcTextSize(kWhole).x + 2 * kSayMargin < room ? kWhole : kShort;
}

void strip(Demo& demo, UiState& ui) {
  const Timeline& timeline = demo.timeline;
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const ImVec2 size(ImGui::GetContentRegionAvail().x, ImGui::GetFrameHeight());
  ImGui::InvisibleButton("strip", size);
  noteItem("timeline", ui);
  ImDrawList* list = ImGui::GetWindowDrawList();
  list->AddRectFilled(at, {at.x + size.x, at.y + size.y}, ImGui::GetColorU32(ImGuiCol_FrameBg), 4);
  const auto say = [&](const char* words) {
    list->AddText({at.x + kSayMargin, at.y + 4}, ImGui::GetColorU32(ImGuiCol_TextDisabled), words);
  };
  const char* const anew = anewWords(timeline, size.x, ui);
  if (*anew) noteItem("timeline anew", ui);
  long first_frame = 0, last_frame = 0;
  if (!timelineSpan(timeline, first_frame, last_frame)) {
    say(*anew ? anew : "fills while the hair moves");
    return;
  }
  if (!timeline.cache) drawMarks(timeline, at, size, ui.text_scale);
  say(anew);
  const auto first = static_cast<double>(first_frame);
  const double span = std::max(1.0, static_cast<double>(last_frame) - first);
  if (!timeline.cache) drawRange(timeline, at, size);
  const double here = std::clamp((static_cast<double>(timelinePlace(demo)) - first) / span, 0.0, 1.0);
  const float x = at.x + size.x * static_cast<float>(here);
  list->AddRectFilled({x - 1.5f, at.y - 2}, {x + 1.5f, at.y + size.y + 2}, ImGui::GetColorU32(ImGuiCol_CheckMark));
  const float share = (ImGui::GetIO().MousePos.x - at.x) / std::max(1.0f, size.x);
  if (ImGui::IsItemActive()) {
    const long frame = frameAt(share, first_frame, last_frame);
    if (!demo.paused) postRequest(demo, {Ask::kPause, "", "", 1});
    if (frame != ui.scrubbed) postRequest(demo, {Ask::kRewind, "", "", static_cast<double>(frame)});
    ui.scrubbed = frame;
  } else {
    ui.scrubbed = -1;
    tip(timeline.cache ? "A cache: drag to see any of its frames; Space goes on from the last whole state before it"
                       : "Drag to see what was simulated; Space goes on from there. Green: contact, yellow: a slow "
                         "step, violet: the clip begins anew, blue: the head jumped, red: recovery");
  }
}

// Writes a cache, and shows it when it ends; leaves the one that is shown.
void cacheButton(Demo& demo, UiState& ui) {
  const bool writing =
      demo.capture.hair && (demo.capture.hair_file.empty() || demo.capture.hair_file.ends_with(".hairmesh"));
  const char* const label = writing ? "End##cache" : demo.timeline.cache ? "Leave##cache" : "Cache##cache";
  if (ImGui::Button(label)) {
    if (!writing && demo.timeline.cache) {
      postRequest(demo, {Ask::kOpenCache, "", ""});
    } else {
      postRequest(demo, {Ask::kRecordHair, "", "", writing ? 0.0 : 1.0});
    }
  }
  noteItem("cache", ui);
  tip("Writes every frame from now on into a .hairmesh file, which the timeline then shows to and fro at once");
  ImGui::SameLine(0, 8);
}

// Pixels of the timeline, beside the history.
float widthRightOf(float left, const UiState& ui) {
  const float margin = kTimelineMargin * ui.text_scale;
  const float right = ui.history && !ui.history_in_sidebar ? 292 * ui.text_scale + margin : 0;
  return ImGui::GetIO().DisplaySize.x - left - right - 2 * margin;
}
bool inOneRow(float width, const UiState& ui) {
  return width > kOneRowWidth * ui.text_scale;
}

}  // namespace

float timelineHeight(const Demo& demo, const UiState& ui, float left) {
  if (!ui.visible || !demo.timeline.on) return 0;
  const float scale = ui.text_scale, width = widthRightOf(left, ui);
  if (width < kMinWidth * scale || ImGui::GetIO().DisplaySize.y < kMinWindow * scale) return 0;
  return (kTimelineHeight + (inOneRow(width, ui) ? 0 : kButtonRow) + kTimelineMargin) * scale;
}

void timelinePanel(Demo& demo, UiState& ui, float left) {
  const float taken = timelineHeight(demo, ui, left);
  if (taken == 0) return;
  const float margin = kTimelineMargin * ui.text_scale, width = widthRightOf(left, ui);
  const bool one_row = inOneRow(width, ui);
  ImGui::SetNextWindowPos({left + margin, ImGui::GetIO().DisplaySize.y - margin}, ImGuiCond_Always, {0, 1});
  ImGui::SetNextWindowSize({width, taken - margin});
  const ImGuiWindowFlags flags = ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize |
                                 ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoBringToFrontOnFocus;
  if (ImGui::Begin("timeline", nullptr, flags)) {
    if (iconButton(Icon::kBack, "step_back", "Back to the moment kept before (,)", false, ui))
      postRequest(demo, {Ask::kRewind, "", "", static_cast<double>(timelinePlace(demo) - 1)});
    ImGui::SameLine(0, 6);
    char text[48];
    std::snprintf(text, sizeof text, "%7.2f s", demo.shown_time);
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted(text);
    ImGui::SameLine(0, 10);
    if (one_row) cacheButton(demo, ui), rangeButtons(demo, ui);
    strip(demo, ui);
    if (!one_row) cacheButton(demo, ui), rangeButtons(demo, ui);
  }
  ImGui::End();
}

void cameraRows(Demo& demo, UiState& ui) {
  rowLabel("Lens", "Focal length over a picture 24 mm high");
  ImGui::SetNextItemWidth(-1);
  float lens = static_cast<float>(12 / std::tan(0.5 * demo.camera.fov));
  constexpr ImGuiSliderFlags kFlags = ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp;
  {
    const MarksBelowDigits marks;
    if (ImGui::SliderFloat("##lens", &lens, 12, 200, "%.0f mm", kFlags))
      postRequest(demo, {Ask::kLens, "", "", 2 * std::atan(12.0 / lens)});
  }
  noteItem("lens", ui);
  rowLabel("Turntable", "The camera goes round the figure");
  ImGui::SetNextItemWidth(-1);
  constexpr double kDegree = 3.14159265358979 / 180;
  float turn = static_cast<float>(demo.turntable / kDegree);
  {
    const MarksBelowDigits marks;
    if (ImGui::SliderFloat("##turntable", &turn, -90, 90, "%.0f deg/s"))
      postRequest(demo, {Ask::kTurntable, "", "", kDegree * turn});
  }
  noteItem("turntable", ui);
  rowLabel("Keep view", "Four places for views");
  const int keep = segments("keep", {"1", "2", "3", "4"}, -1, ui);
  if (keep >= 0) postRequest(demo, {Ask::kKeepView, "", "", static_cast<double>(keep)});
  rowLabel("Go to view", "A kept view, about where the figure is now");
  const int go = segments("go", {"1", "2", "3", "4"}, -1, ui);
  if (go >= 0) postRequest(demo, {Ask::kGoToView, "", "", static_cast<double>(go)});
}

}  // namespace app
