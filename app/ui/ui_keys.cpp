// Keys, and the list of them that ? shows.
#include <imgui/imgui.h>

#include <algorithm>
#include <utility>

#include "app/scene/edit/groom_brush.h"
#include "app/scene/edit/mesh_change.h"
#include "app/ui/ui.h"
#include "app/ui/ui_panels.h"
#include "app/ui/ui_widgets.h"

namespace app {

namespace {

constexpr KeyHelp kKeyHelp[] = {
    {"Space", "pause or go on"},
    {".  ,", "one simulation step; back to the moment kept before"},
    {"I  O", "in and out point of the timeline, or off"},
    {"R", "hair to rest"},
    {"Home", "everything to the start"},
    {"C", "collapse the hair onto its roots"},
    {"1  2  3", "short, shoulder, long hair"},
    {"4  5  6", "low, medium, high resolution"},
    {"-  +", "playback slower, faster"},
    {"F  S  B  T  Q", "view from front, side, back, top, three quarters"},
    {"Z", "the view before; with Shift: the one after"},
    {"L", "camera follows the figure"},
    {"M  E  V  N", "hair mesh, ellipsoids, tetrahedra, contacts"},
    {"P", "screenshot"},
    {"K", "record a PNG sequence"},
    {"F5", "reload the shaders (also reloaded when saved)"},
    {"G  [  ]", "next brush or none; smaller, larger. Drag on the hair to use it"},
    {"X  arrows", "choose vertices, edges, columns, layers or none; move what is chosen, farther with Shift"},
    {"Ctrl Z", "undo; with Shift, or Ctrl Y: do again"},
    {"Ctrl O  Ctrl S", "open a file, save the scene"},
    {"Up  Down", "the keyboard goes to the panels: arrows, Space, Enter; Esc lets go"},
    {"Ctrl +  -  0", "larger or smaller texts, as they were"},
    {"Tab", "hide or show the panels"},
    {"?  F1", "this list"},
    {"Esc", "close what is open, let go of a brush, then ask whether to leave"},
    {"Ctrl Q", "leave; where something is not saved, pressed twice"},
    {"left drag", "orbit"},
    {"right drag", "pan"},
    {"Ctrl left drag", "turn the key light"},
    {"wheel", "zoom"},
    {"drop a file", "scene, preset, motion or hair mesh"},
};

constexpr int kBrushChoices = 1 + static_cast<int>(kBrushNames.size());  // with none
constexpr int kElementChoices = 1 + static_cast<int>(kElementNames.size());

struct KeyAction {
  int key;
  void (*press)(Demo&, UiState&);
};

void send(Ask what, const char* name, Demo& demo) {
  postRequest(demo, {what, name, ""});
}

void toggleView(const char* name, Demo& demo) {
  for (const DebugView& view : kDebugViews) {
    if (view.name == name) postRequest(demo, {Ask::kDebugView, name, "", demo.debug.*view.on ? 0.0 : 1.0});
  }
}

void toggle(Ask what, bool on, Demo& demo) {
  postRequest(demo, {what, "", "", on ? 0.0 : 1.0});
}

void changeSpeed(double factor, Demo& demo) {
  const double speed = demo.scene.playback.speed;
  postRequest(demo, {Ask::kSpeed, "", "", speed == 0 ? 0.25 : speed * factor});
}

// Puts brush and selection down. Returns whether there were any.
bool letGo(UiState& ui) {
  const bool held = ui.brush.tool >= 0 || ui.brush.field >= 0 || ui.select.element >= 0 || ui.brush.tie;
  ui.brush.tool = ui.brush.field = -1;
  ui.brush.tie = false;
  if (ui.select.element >= 0) chooseElement(-1, ui);
  return held;
}

// What a drag on the hair does from now on: the panels may be folded away.
void sayInHand(Demo& demo, const UiState& ui) {
  if (demo.message_is_fault && !demo.message.empty()) return;
  demo.message = "a drag turns the view";
  if (ui.brush.tool >= 0)
    demo.message = "brush: " + std::string(kBrushNames[static_cast<std::size_t>(ui.brush.tool)]) + "; drag on the hair";
  if (ui.select.element >= 0)
    demo.message = "hair mesh: click on one " +
                   std::string(kElementNames[static_cast<std::size_t>(ui.select.element)]) + "; with Shift on more";
  demo.message_is_fault = false;
}

// Closes what lies over the others, one thing at a press, the question whether to leave first. Then lets go of what is
// in hand; then asks that question.
void pressEscape(Demo& demo, UiState& ui) {
  if (std::exchange(ui.leaving, false)) return;
  if (std::exchange(ui.help, false)) return;
  if (std::exchange(ui.browser.what, BrowseFor::kNothing) != BrowseFor::kNothing) return;
  if (demo.message_is_fault && !demo.message.empty()) return demo.message.clear();
  if (std::exchange(ui.history, false)) return;
  if (letGo(ui)) return sayInHand(demo, ui);
  ui.leaving = true;
}

constexpr KeyAction kKeyActions[] = {
    {' ', [](Demo& demo, UiState&) { toggle(Ask::kPause, demo.paused, demo); }},
    {'.', [](Demo& demo, UiState&) { send(Ask::kSingleStep, "", demo); }},
    {',',
     [](Demo& demo, UiState&) {
       postRequest(demo, {Ask::kPause, "", "", 1});
       postRequest(demo, {Ask::kRewind, "", "", static_cast<double>(timelinePlace(demo) - 1)});
     }},
    {'I', [](Demo& demo, UiState&) { toggle(Ask::kMarkIn, demo.timeline.in >= 0, demo); }},
    {'O', [](Demo& demo, UiState&) { toggle(Ask::kMarkOut, demo.timeline.out >= 0, demo); }},
    {'R', [](Demo& demo, UiState&) { send(Ask::kReset, "", demo); }},
    {kKeyHome, [](Demo& demo, UiState&) { send(Ask::kRestart, "", demo); }},
    {'C', [](Demo& demo, UiState&) { send(Ask::kCollapse, "", demo); }},
    {'1', [](Demo& demo, UiState&) { send(Ask::kStyle, "short", demo); }},
    {'2', [](Demo& demo, UiState&) { send(Ask::kStyle, "shoulder", demo); }},
    {'3', [](Demo& demo, UiState&) { send(Ask::kStyle, "long", demo); }},
    {'4', [](Demo& demo, UiState&) { send(Ask::kResolution, "low", demo); }},
    {'5', [](Demo& demo, UiState&) { send(Ask::kResolution, "medium", demo); }},
    {'6', [](Demo& demo, UiState&) { send(Ask::kResolution, "high", demo); }},
    {'-', [](Demo& demo, UiState&) { changeSpeed(0.8, demo); }},
    {'=', [](Demo& demo, UiState&) { changeSpeed(1.25, demo); }},
    {'F', [](Demo& demo, UiState&) { send(Ask::kView, "front", demo); }},
    {'S', [](Demo& demo, UiState&) { send(Ask::kView, "side", demo); }},
    {'B', [](Demo& demo, UiState&) { send(Ask::kView, "back", demo); }},
    {'T', [](Demo& demo, UiState&) { send(Ask::kView, "top", demo); }},
    {'Q', [](Demo& demo, UiState&) { send(Ask::kView, "three-quarter", demo); }},
    {'L', [](Demo& demo, UiState&) { toggle(Ask::kFollow, demo.camera.follow, demo); }},
    {'M', [](Demo& demo, UiState&) { toggleView("mesh", demo); }},
    {'E', [](Demo& demo, UiState&) { toggleView("ellipsoids", demo); }},
    {'V', [](Demo& demo, UiState&) { toggleView("tets", demo); }},
    {'N', [](Demo& demo, UiState&) { toggleView("contacts", demo); }},
    {'P', [](Demo& demo, UiState&) { send(Ask::kScreenshot, "", demo); }},
    {kKeyF12, [](Demo& demo, UiState&) { send(Ask::kScreenshot, "", demo); }},
    {'K', [](Demo& demo, UiState&) { toggle(Ask::kRecord, demo.capture.recording, demo); }},
    {'G',
     [](Demo& demo, UiState& ui) {
       ui.brush.tool = (ui.brush.tool + 2) % kBrushChoices - 1, ui.brush.field = -1;
       ui.select.element = -1;
       sayInHand(demo, ui);
     }},
    {'X',
     [](Demo& demo, UiState& ui) {
       chooseElement((ui.select.element + 2) % kElementChoices - 1, ui);
       sayInHand(demo, ui);
     }},
    {'[', [](Demo&, UiState& ui) { ui.brush.radius = std::max(0.005, ui.brush.radius / 1.2); }},
    {']', [](Demo&, UiState& ui) { ui.brush.radius = std::min(0.2, ui.brush.radius * 1.2); }},
    {kKeyTab, [](Demo&, UiState& ui) { ui.visible = !ui.visible; }},
    {'/', [](Demo&, UiState& ui) { ui.help = !ui.help; }},
    {'?', [](Demo&, UiState& ui) { ui.help = !ui.help; }},
    {kKeyF1, [](Demo&, UiState& ui) { ui.help = !ui.help; }},
    {kKeyF5, [](Demo&, UiState& ui) { ui.reload_shaders = true; }},
    {kKeyDown, [](Demo&, UiState& ui) { ui.visible = ui.focus_panels = true; }},
    {kKeyUp, [](Demo&, UiState& ui) { ui.visible = ui.focus_panels = true; }},
    {kKeyEscape, pressEscape},
};

struct ChordAction {
  int key, modifiers;
  void (*press)(Demo&, UiState&);
};

constexpr ChordAction kChordActions[] = {
    {'Z', kControl,
     [](Demo& demo, UiState&) {
       postRequest(demo, {Ask::kUndo, "", "", 1});
     }},
    {'Z', kControl | kShift,
     [](Demo& demo, UiState&) {
       postRequest(demo, {Ask::kRedo, "", "", 1});
     }},
    {'Z', kNoModifier, [](Demo& demo, UiState& ui) { stepView(true, demo, ui); }},
    {'Z', kShift, [](Demo& demo, UiState& ui) { stepView(false, demo, ui); }},
    {'Y', kControl,
     [](Demo& demo, UiState&) {
       postRequest(demo, {Ask::kRedo, "", "", 1});
     }},
    {'O', kControl, [](Demo&, UiState& ui) { browseFor(BrowseFor::kOpen, ui); }},
    {'S', kControl, [](Demo& demo, UiState& ui) { browseToSave(demo, ui); }},
    {'Q', kControl, [](Demo& demo, UiState& ui) { ui.quit = mayClose(demo, ui); }},
    {'=', kControl, [](Demo&, UiState& ui) { ui.zoom_texts *= 1.1f; }},
    {'-', kControl, [](Demo&, UiState& ui) { ui.zoom_texts /= 1.1f; }},
    {'0', kControl, [](Demo&, UiState& ui) { ui.zoom_texts = 1; }},
};

}  // namespace

std::span<const KeyHelp> keyHelp() {
  return kKeyHelp;
}

bool panelsTakeKey(int key) {
  const ImGuiIO& io = ImGui::GetIO();
  const bool moves = key >= kKeyRight && key <= kKeyUp;
  // A list that is open is what Esc closes.
  if (key == kKeyEscape && ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopup)) return true;
  return io.WantTextInput || (io.NavVisible && (moves || key == ' ' || key == kKeyEnter || key == kKeyEscape));
}

bool mayClose(const Demo& demo, UiState& ui) {
  return !isUnsaved(demo.edits) || std::exchange(ui.leaving, true);
}

bool pressKey(int key, Demo& demo, UiState& ui, int modifiers) {
  // Whoever types a file's name means nothing else by it.
  if (ui.browser.what != BrowseFor::kNothing && key != kKeyEscape) return false;
  for (const ChordAction& row : kChordActions) {
    if (row.key != key || row.modifiers != modifiers) continue;
    row.press(demo, ui);
    return true;
  }
  if (modifiers & kControl) return false;
  if (nudgeChosen(key, modifiers & kShift, demo, ui)) return true;
  for (const KeyAction& row : kKeyActions) {
    if (row.key != key) continue;
    row.press(demo, ui);
    return true;
  }
  return false;
}

}  // namespace app
