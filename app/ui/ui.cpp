#include "app/ui/ui.h"

#include <imgui/imgui.h>
#include <imgui/imgui_internal.h>

#include <algorithm>
#include <cfloat>
#include <utility>

#include "app/files/data_path.h"
#include "app/ui/ui_panels.h"
#include "app/ui/ui_widgets.h"
#include "app/ui/window_words.h"

namespace app {

namespace {

constexpr float kMargin = 12, kSidebarWidth = 348, kTimingsWidth = 292;
constexpr float kMessageWidth = 520, kMinMessageWidth = 240;
constexpr float kMinFigure = 360;     // width beside the sidebar that hair and shoulders ask for
constexpr float kTextHeight = 15;     // of a row of buttons, see prepareUi
constexpr float kMinSheet = 176;      // height that rows of buttons and tabs ask for
constexpr float kSceneBoxFrom = 430;  // width of a sheet with room for the scenes beside its buttons
constexpr float kFilesFrom = 560;     // and with room for the row of files there, and the scenes beside its tabs
constexpr float kAmpleWidth = 340;    // between sidebar and timings; with less the timings begin folded
constexpr float kMinBetween = 240;    // the same; with less the timings are in the Debug tab
constexpr double kMessageTime = 6;    // s; faults stay until clicked
constexpr ImGuiWindowFlags kFixed = ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize |
                                    ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoBringToFrontOnFocus;

// Whether the figure has no room beside the sidebar. Then its tabs are folded away, and unfolded they stand in a sheet
// over the lower half of the window, below the figure.
bool narrow(const UiState& ui) {
  const float window = ImGui::GetIO().DisplaySize.x, sidebar = kSidebarWidth + 2 * kMargin;
  // Of two pictures the left one asks for half as much.
  return window < (sidebar + kMinFigure) * ui.text_scale ||
         (ui.halved && 0.5f * window < (sidebar + 0.5f * kMinFigure) * ui.text_scale);
}

// The scene's name, and what has been put into it since.
std::string sceneTitle(const Demo& demo) {
  std::string title = readable(demo.scene.name), other;
  for (std::size_t i = 0; i < demo.actors.size(); ++i) {
    const CharacterSpec &now = demo.actors[i].spec, &then = demo.scene.characters[i];
    if (now.motion != then.motion) other = readable(stem(now.motion));
  }
  return other.empty() ? title : title + ", with " + other;
}

void sceneBox(Demo& demo, UiState& ui) {
  ImGui::SetNextItemWidth(-1);
  const std::string title = sceneTitle(demo);
  const bool open = ImGui::BeginCombo("##scene", title.c_str());
  noteItem("scene", ui);
  noteItem("scene " + title, ui);
  if (open) {
    for (std::size_t k = 0; k < ui.scenes.size(); ++k) {
      const std::string& file = ui.scenes[k];
      const std::string label = readable(ui.scene_names[k]) + "##" + file;
      if (ImGui::Selectable(label.c_str(), file == demo.scene.file)) postRequest(demo, {Ask::kSceneFile, "", file});
      noteItem("scene " + stem(file), ui);
    }
    ImGui::EndCombo();
  }
}

void sceneRow(Demo& demo, UiState& ui) {
  ImGui::PushFont(ui.heading);
  ImGui::TextUnformatted("hairmesh");
  ImGui::PopFont();
  ImGui::SameLine(0, 12);
  sceneBox(demo, ui);
}

void fileRow(Demo& demo, UiState& ui) {
  const EditHistory& edits = demo.edits;
  const int pressed = segments("file",
                               {{"Open", "Opens a scene, a project, hair, a figure or a motion"},
                                {"Save", "Saves the scene, or a project with the hair as it is"},
                                {"Undo", "Takes the last change back (Ctrl+Z)", edits.done > 0},
                                {"Redo", "Makes it again (Ctrl+Y)", edits.done < edits.steps.size()},
                                {"History", "Lists all changes, to go to any of them"}},
                               ui.history ? 4 : -1, ui);
  if (pressed == 0) browseFor(BrowseFor::kOpen, ui);
  if (pressed == 1) browseToSave(demo, ui);
  if (pressed == 2) postRequest(demo, {Ask::kUndo, "", "", 1});
  if (pressed == 3) postRequest(demo, {Ask::kRedo, "", "", 1});
  if (pressed == 4) ui.history = !ui.history;
}

// Whether a sheet is so wide that its buttons and files stand in one row. Within its window.
bool filesBeside(const UiState& ui) {
  return narrow(ui) && ui.unfolded && ImGui::GetContentRegionMax().x >= kFilesFrom * ui.text_scale;
}

void transportRow(Demo& demo, UiState& ui) {
  const auto next = [&ui] { ImGui::SameLine(0, 4 * ui.text_scale); };
  if (iconButton(demo.paused ? Icon::kPlay : Icon::kPause, "pause", demo.paused ? "Go on (Space)" : "Pause (Space)",
                 demo.paused, ui)) {
    postRequest(demo, {Ask::kPause, "", "", demo.paused ? 0.0 : 1.0});
  }
  next();
  if (iconButton(Icon::kStep, "step", "One simulation step (.)", false, ui))
    postRequest(demo, {Ask::kSingleStep, "", ""});
  next();
  if (iconButton(Icon::kRestart, "restart", "Everything to the start (Home)", false, ui))
    postRequest(demo, {Ask::kRestart, "", ""});
  next();
  if (iconButton(Icon::kReset, "reset", "Hair to rest (R)", false, ui)) postRequest(demo, {Ask::kReset, "", ""});
  next();
  if (iconButton(Icon::kCollapse, "collapse", "Collapse the hair onto its roots and watch it recover (C)", false, ui)) {
    postRequest(demo, {Ask::kCollapse, "", ""});
  }
  next();
  if (iconButton(Icon::kPhoto, "screenshot", "Screenshot (P)", false, ui))
    postRequest(demo, {Ask::kScreenshot, "", ""});
  next();
  const bool recording = demo.capture.recording;
  if (iconButton(Icon::kRecord, "record", recording ? "Stop recording (K)" : "Record a PNG sequence (K)", recording,
                 ui)) {
    postRequest(demo, {Ask::kRecord, "", "", recording ? 0.0 : 1.0});
  }
  next();
  if (iconButton(Icon::kHelp, "help", "Keys (?)", ui.help, ui)) ui.help = !ui.help;
  if (!narrow(ui)) return;
  next();
  if (iconButton(Icon::kPanels, "panels", ui.unfolded ? "Fold the panels" : "All panels", ui.unfolded, ui))
    ui.unfolded = !ui.unfolded;
  if (!ui.unfolded || ImGui::GetContentRegionMax().x < kSceneBoxFrom * ui.text_scale) return;
  const float higher = ImGui::GetItemRectSize().y - ImGui::GetFrameHeight();
  next();
  ImGui::SetCursorPosY(ImGui::GetCursorPosY() + 0.5f * higher);
  filesBeside(ui) ? fileRow(demo, ui) : sceneBox(demo, ui);
}

// When a widget is let go that has asked for something, its gesture is over.
void endGesture(Demo& demo, UiState& ui) {
  ui.light_held = ui.light_held && ImGui::GetIO().MouseDown[0];
  const auto edits = [](const Request& request) { return request.what != Ask::kEndGesture; };
  ui.dragging = ui.dragging || std::ranges::any_of(demo.requests, edits);
  if (!ui.dragging || ImGui::IsAnyItemActive() || ui.brush.stroking || ui.line_held || ui.light_held) return;
  ui.dragging = false;
  postRequest(demo, {Ask::kEndGesture, "", ""});
}

void characterRow(Demo& demo, UiState& ui) {
  if (demo.actors.size() < 2) return;
  rowLabel("Character", "Which one the panels speak of");
  int selected = demo.selected;
  ImGui::SetNextItemWidth(-1);
  if (ImGui::SliderInt("##character", &selected, 0, static_cast<int>(demo.actors.size()) - 1, "%d")) {
    postRequest(demo, {Ask::kSelect, "", "", static_cast<double>(selected)});
  }
  noteItem("character", ui);
}

struct Tab {
  const char* label;
  void (*build)(Demo&, UiState&);
};
constexpr Tab kTabs[] = {
    {"Simulation", simulationTab}, {"Motion", motionTab}, {"Hair", hairTab}, {"Look", lookTab}, {"Debug", debugTab}};

// In a narrow window the row of buttons alone, unless a person has unfolded the tabs.
bool folded(const UiState& ui) {
  return narrow(ui) && !ui.unfolded;
}
bool sheet(const UiState& ui) {
  return narrow(ui) && ui.unfolded;
}

// Never wider than the window.
float sidebarWidth(const UiState& ui) {
  const float wanted = (sheet(ui) ? 2 : 1) * kSidebarWidth * ui.text_scale;
  return std::min(wanted, ImGui::GetIO().DisplaySize.x - 2 * kMargin * ui.text_scale);
}

float sidebarHeight(const UiState& ui) {
  const float window = ImGui::GetIO().DisplaySize.y, margin = kMargin * ui.text_scale;
  if (folded(ui)) return 0;  // as high as its row
  const float most = std::max(120.0f, window - 2 * margin);
  return sheet(ui) ? std::min(most, std::max(0.5f * window - margin, kMinSheet * ui.text_scale)) : most;
}

// Pixels at the left and right that panels take beside the figure.
float takenLeft(const UiState& ui) {
  return ui.visible && !narrow(ui) ? sidebarWidth(ui) + kMargin * ui.text_scale : 0;
}
// Pixels between sidebar and timings, and whether that is enough for the figure.
float timingsRoom(const UiState& ui) {
  return ImGui::GetIO().DisplaySize.x - sidebarWidth(ui) - (kTimingsWidth + 3 * kMargin) * ui.text_scale;
}
bool timingsBeside(const UiState& ui) {
  return timingsRoom(ui) >= kMinBetween * ui.text_scale;
}
float takenRight(const UiState& ui) {
  const float room = timingsRoom(ui);
  const bool shown_before = ui.timings_bottom > 0;
  const bool open = shown_before ? !ui.timings_folded : room >= kAmpleWidth * ui.text_scale;
  const bool timed = ui.visible && !folded(ui) && open && timingsBeside(ui);
  const float timings = timed ? (kTimingsWidth + kMargin) * ui.text_scale : 0;
  // A history that takes more than half of the window lies over the figure; one no higher than the sheet beside it.
  const bool history = ui.visible && ui.history && ui.history_width < 0.5f * ImGui::GetIO().DisplaySize.x &&
                       !(sheet(ui) && ui.history_height <= sidebarHeight(ui) + 2 * kMargin * ui.text_scale);
  return std::max(timings, history ? ui.history_width : 0);
}

// Of the row of buttons that is left of a folded sidebar, with its margin.
float rowHeight(const UiState& ui) {
  return (kTextHeight + 3 * kMargin) * ui.text_scale + 2 * ImGui::GetStyle().FramePadding.y;
}

// Pixels at the bottom that panels take below the figure.
float takenBelow(const Demo& demo, const UiState& ui) {
  if (!ui.visible) return 0;
  float taken = timelineHeight(demo, ui, takenLeft(ui)) + (folded(ui) ? rowHeight(ui) : 0);
  if (sheet(ui)) taken = sidebarHeight(ui) + kMargin * ui.text_scale;
  return std::max(taken, std::min(ui.fault_height, 0.8f * ImGui::GetIO().DisplaySize.y));
}

// At the right of the row of tabs.
void sceneBesideTabs(Demo& demo, UiState& ui) {
  constexpr float kShare = 0.5f;  // of the row
  const ImVec2 at = ImGui::GetCursorPos();
  ImGui::SetCursorPosX(at.x + kShare * ImGui::GetContentRegionAvail().x);
  sceneBox(demo, ui);
  ImGui::SetCursorPos(at);
}

void tabs(Demo& demo, UiState& ui) {
  if (filesBeside(ui)) sceneBesideTabs(demo, ui);
  if (!ImGui::BeginTabBar("tabs")) return;
  int index = 0;
  for (const Tab& tab : kTabs) {
    const bool wanted = ui.open_tab == index++;
    const bool open = ImGui::BeginTabItem(tab.label, nullptr, wanted ? ImGuiTabItemFlags_SetSelected : 0);
    noteItem(std::string("tab ") + tab.label, ui);
    if (!open) continue;
    if (ImGui::BeginChild(tab.label, {0, 0}, false, ImGuiWindowFlags_NavFlattened)) tab.build(demo, ui);
    ImGui::EndChild();
    ImGui::EndTabItem();
  }
  ui.open_tab = -1;
  ImGui::EndTabBar();
}

// In a narrow window it stands at the bottom, over the `below` pixels of the timeline, where no face is.
void sidebar(Demo& demo, UiState& ui, float below) {
  const ImGuiIO& io = ImGui::GetIO();
  const float margin = kMargin * ui.text_scale;
  if (narrow(ui)) {
    ImGui::SetNextWindowPos({margin, io.DisplaySize.y - margin - below}, ImGuiCond_Always, {0, 1});
  } else {
    ImGui::SetNextWindowPos({margin, margin});
  }
  ImGui::SetNextWindowSize({sidebarWidth(ui), sidebarHeight(ui)});
  if (std::exchange(ui.focus_panels, false)) ImGui::SetNextWindowFocus();
  if (ImGui::Begin("sidebar", nullptr, kFixed)) {
    if (!narrow(ui)) sceneRow(demo, ui);
    transportRow(demo, ui);
    if (!folded(ui)) {
      if (!filesBeside(ui)) fileRow(demo, ui);
      characterRow(demo, ui);
      if (ui.history && ui.history_in_sidebar) historyList(demo, ui);
      if (!sheet(ui)) ImGui::Spacing();
      tabs(demo, ui);
    }
  }
  ImGui::End();
}

void timings(Demo& demo, UiState& ui) {
  const float margin = kMargin * ui.text_scale;
  // Panels cover neither one another nor the face: without room beside the sidebar this one is in the Debug tab, and in
  // a narrow window it is left out until the panels are unfolded.
  const float room = timingsRoom(ui), history = historyLeast(ui), height = ImGui::GetIO().DisplaySize.y;
  const float below = history > 0 ? history : timelineHeight(demo, ui, takenLeft(ui));
  ui.timings_bottom = 0;
  ui.timings_in_tab = !timingsBeside(ui);
  if (ui.timings_in_tab || folded(ui)) return;
  ImGui::SetNextWindowPos({ImGui::GetIO().DisplaySize.x - margin, margin}, ImGuiCond_Always, {1, 0});
  ImGui::SetNextWindowSize({kTimingsWidth * ui.text_scale, 0});
  ImGui::SetNextWindowSizeConstraints({0, 0}, {FLT_MAX, height - 2 * margin - below});  // then it scrolls
  ImGui::SetNextWindowCollapsed(room < kAmpleWidth * ui.text_scale, ImGuiCond_FirstUseEver);
  const ImGuiWindowFlags flags =
      ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_AlwaysAutoResize;
  ImGui::Begin("Timings", nullptr, flags);
  ui.timings_folded = ImGui::IsWindowCollapsed();  // Begin says so only of a window that was open before
  if (!ui.timings_folded) timingsPanel(demo, ui);
  ui.timings_bottom = ImGui::GetWindowPos().y + ImGui::GetWindowSize().y;
  ImGui::End();
}

// What is shown below the figure: the message, and what is being loaded as long as it is.
std::string messageText(const Demo& demo) {
  const std::string loading = loadingNote(demo), said = windowWords(demo.message);
  if (loading.empty() || demo.message == loading) return said;
  return demo.message_is_fault ? said + "\n" + loading : loading;
}

// Where notices stand: in the middle of what sidebar, timings and history leave free, above the history where that is
// too narrow to read, and above what else lies at the bottom. `below`: the pixels that this takes.
NoticePlace noticePlace(const UiState& ui, float below) {
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  const float margin = kMargin * ui.text_scale;
  const bool beside = size.x - takenLeft(ui) - ui.history_width > (kMinMessageWidth + 2 * kMargin) * ui.text_scale;
  if (!beside) below = std::max(below, ui.history_height);
  const bool timed = ui.timings_bottom > 0 && !ui.timings_folded;
  const float left = takenLeft(ui) + margin, timings = timed ? kTimingsWidth * ui.text_scale + margin : 0;
  const float right = std::max(timings, beside ? ui.history_width : 0);
  return {left, size.x - left - right - margin, size.y - 2 * margin - below};
}

constexpr float kFaceShare = 0.3f;  // of the window's height, from its top: there is a face

// Takes the height of the message off the place.
void message(NoticePlace& place, Demo& demo, UiState& ui) {
  const std::string text = messageText(demo);
  ui.fault_height = 0;
  if (demo.message != ui.shown_message) {
    ui.shown_message = demo.message;
    ui.message_since = ImGui::GetTime();
  }
  if (text.empty()) return;
  // What is no fault waits until the file panel, whose buttons it might cover, is closed.
  if (ui.browser.what != BrowseFor::kNothing && !demo.message_is_fault) {
    ui.message_since = ImGui::GetTime();
    return;
  }
  if (text == windowWords(demo.message) && !demo.message_is_fault &&
      ImGui::GetTime() - ui.message_since > kMessageTime) {
    demo.message.clear();
    return;
  }
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  const float margin = kMargin * ui.text_scale;
  const bool fault = demo.message_is_fault;
  const float wrap = std::min(kMessageWidth * ui.text_scale, place.width - 2 * margin);
  // From its first frame on: by itself a window takes its size from the frame before.
  const ImVec2 words = ImGui::CalcTextSize(text.c_str(), nullptr, false, wrap);
  const ImVec2 content(words.x, words.y + (fault ? ImGui::GetFrameHeightWithSpacing() : 0));
  // Above the panels of a low window a fault would lie over the face: until it is closed it lies over the panels.
  const float top = place.bottom - content.y - 2 * ImGui::GetStyle().WindowPadding.y;
  if (fault && top < kFaceShare * size.y && ui.history_height == 0) place.bottom = size.y - 2 * margin;
  ImGui::SetNextWindowPos({place.left + 0.5f * place.width, place.bottom}, ImGuiCond_Always, {0.5f, 1});
  ImGui::SetNextWindowSizeConstraints({0, 0}, {place.width, 0.8f * size.y});
  ImGui::SetNextWindowContentSize(content);
  if (fault) ImGui::PushStyleColor(ImGuiCol_WindowBg, ImVec4(0.30f, 0.10f, 0.09f, 0.96f));
  const ImGuiWindowFlags flags = kFixed | ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoFocusOnAppearing;
  // The sidebar and the timings stay where they are in the order of windows; this one comes to the front.
  if (ImGui::Begin("message", nullptr, flags & ~ImGuiWindowFlags_NoBringToFrontOnFocus)) {
    ImGui::BringWindowToDisplayFront(ImGui::GetCurrentWindow());
    noteItem("message", ui);
    ImGui::PushTextWrapPos(ImGui::GetCursorPosX() + wrap);  // counted from the window's edge
    ImGui::TextUnformatted(text.c_str());
    ImGui::PopTextWrapPos();
    if (fault) {
      const bool closed = ImGui::Button("Close");
      noteItem("close_message", ui);
      if (closed) demo.message.clear();
      ui.fault_height = size.y - ImGui::GetWindowPos().y;
    }
  }
  place.bottom = ImGui::GetWindowPos().y - margin;
  ImGui::End();
  if (fault) ImGui::PopStyleColor();
}

void help(UiState& ui) {
  if (!ui.help) return;
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({0.5f * size.x, 0.5f * size.y}, ImGuiCond_Always, {0.5f, 0.5f});
  // In a small window it scrolls.
  const float margin = kMargin * ui.text_scale;
  ImGui::SetNextWindowSizeConstraints({0, 0}, {std::max(1.0f, size.x - margin), std::max(1.0f, size.y - margin)});
  const ImGuiWindowFlags flags =
      ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_AlwaysAutoResize;
  ImGui::SetNextWindowBgAlpha(1);
  if (ImGui::Begin("keys", nullptr, flags)) {
    ImGui::PushFont(ui.heading);
    ImGui::TextUnformatted("Keys and mouse");
    ImGui::PopFont();
    ImGui::Separator();
    if (ImGui::BeginTable("keys", 2)) {
      float widest = 0;
      for (const KeyHelp& key : keyHelp()) widest = std::max(widest, ImGui::CalcTextSize(key.what).x);
      const float first = 110 * ui.text_scale, room = size.x - margin - first - 60 * ui.text_scale;
      ImGui::TableSetupColumn("key", ImGuiTableColumnFlags_WidthFixed, first);
      ImGui::TableSetupColumn("what", ImGuiTableColumnFlags_WidthFixed, std::max(80.0f, std::min(widest, room)));
      for (const KeyHelp& key : keyHelp()) {
        ImGui::TableNextRow();
        ImGui::TableNextColumn();
        ImGui::TextColored(ImGui::GetStyleColorVec4(ImGuiCol_CheckMark), "%s", key.keys);
        ImGui::TableNextColumn();
        ImGui::TextWrapped("%s", key.what);
      }
      ImGui::EndTable();
    }
  }
  ImGui::End();
}

}  // namespace

int tabIndex(std::string_view name) {
  int index = 0;
  for (const Tab& tab : kTabs) {
    if (readable(name) == tab.label) return index;
    ++index;
  }
  return -1;
}

PicturePart freePart(const Demo& demo, const UiState& ui) {
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  if (size.x < 1 || size.y < 1) return {};
  PicturePart part;
  part.left = static_cast<double>(takenLeft(ui) / size.x);
  part.right = 1 - static_cast<double>(takenRight(ui) / size.x);
  part.bottom = 1 - static_cast<double>(takenBelow(demo, ui) / size.y);
  return part;
}

void buildUi(Demo& demo, UiState& ui) {
  noteFiles(demo, ui);
  noteView(demo, ui);
  ui.presets_in_sight.clear();
  ui.items.clear();
  ui.halved = demo.comparison.on() && demo.comparison.side_by_side;
  ui.history_in_sidebar = !narrow(ui) && timingsRoom(ui) < kMinFigure * ui.text_scale;
  compareLine(demo, ui);
  if (!ui.line_held) brushFrame(demo, ui);
  count(!ui.visible, demo.stats.always[kHiddenPanels]);
  float below = sheet(ui) ? 0 : timelineHeight(demo, ui, takenLeft(ui));
  if (below > 0) timelinePanel(demo, ui, takenLeft(ui));
  if (ui.visible) {
    sidebar(demo, ui, below);
    timings(demo, ui);
    if (folded(ui)) below += rowHeight(ui);
  }
  historyPanel(demo, ui);
  filePanel(demo, ui);
  if (ui.visible && sheet(ui)) below = sidebarHeight(ui) + kMargin * ui.text_scale;
  NoticePlace place = noticePlace(ui, below);
  message(place, demo, ui);
  offerPanel(place, demo, ui);
  leavePanel(place, demo, ui);
  help(ui);
  endGesture(demo, ui);
}

}  // namespace app
