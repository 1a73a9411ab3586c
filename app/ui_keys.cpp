// Keys, and the list of them that ? shows.
#include "app/ui.h"
#include "app/ui_widgets.h"

namespace app {

namespace {

constexpr KeyHelp kKeyHelp[] = {
    {"Space", "pause or go on"},
    {".", "one simulation step"},
    {"R", "hair to rest"},
    {"Home", "everything to the start"},
    {"C", "collapse the hair onto its roots"},
    {"1  2  3", "short, shoulder, long hair"},
    {"4  5  6", "low, medium, high resolution"},
    {"-  +", "playback slower, faster"},
    {"F  S  B  T  Q", "view from front, side, back, top, three quarters"},
    {"L", "camera follows the figure"},
    {"M  E  V  N", "hair mesh, ellipsoids, tetrahedra, contacts"},
    {"P", "screenshot"},
    {"K", "record a PNG sequence"},
    {"Tab", "hide or show the panels"},
    {"?  F1", "this list"},
    {"Esc", "close this list; then leave"},
    {"left drag", "orbit"},
    {"right drag", "pan"},
    {"wheel", "zoom"},
    {"drop a file", "scene, preset, motion or hair mesh"},
};

bool toggleView(const char* name, Demo& demo) {
  for (const DebugView& view : kDebugViews) {
    if (view.name == name) ask(demo, {Ask::kDebugView, name, "", demo.debug.*view.on ? 0.0 : 1.0});
  }
  return true;
}

bool send(Ask what, const char* name, Demo& demo) {
  ask(demo, {what, name, ""});
  return true;
}

bool turnView(const char* view, Demo& demo) {
  return send(Ask::kView, view, demo);
}

bool changeSpeed(double factor, Demo& demo) {
  const double speed = demo.scene.playback.speed;
  ask(demo, {Ask::kSpeed, "", "", speed == 0 ? 0.25 : speed * factor});
  return true;
}

}  // namespace

std::span<const KeyHelp> keyHelp() {
  return kKeyHelp;
}

bool pressKey(int key, Demo& demo, UiState& ui) {
  switch (key) {
    case ' ':
      ask(demo, {Ask::kPause, "", "", demo.paused ? 0.0 : 1.0});
      return true;
    case '.':
      return send(Ask::kSingleStep, "", demo);
    case 'R':
      return send(Ask::kReset, "", demo);
    case kKeyHome:
      return send(Ask::kRestart, "", demo);
    case 'C':
      return send(Ask::kCollapse, "", demo);
    case '1':
      return send(Ask::kStyle, "short", demo);
    case '2':
      return send(Ask::kStyle, "shoulder", demo);
    case '3':
      return send(Ask::kStyle, "long", demo);
    case '4':
      return send(Ask::kResolution, "low", demo);
    case '5':
      return send(Ask::kResolution, "medium", demo);
    case '6':
      return send(Ask::kResolution, "high", demo);
    case '-':
      return changeSpeed(0.8, demo);
    case '=':
      return changeSpeed(1.25, demo);
    case 'F':
      return turnView("front", demo);
    case 'S':
      return turnView("side", demo);
    case 'B':
      return turnView("back", demo);
    case 'T':
      return turnView("top", demo);
    case 'Q':
      return turnView("three-quarter", demo);
    case 'L':
      ask(demo, {Ask::kFollow, "", "", demo.camera.follow ? 0.0 : 1.0});
      return true;
    case 'M':
      return toggleView("mesh", demo);
    case 'E':
      return toggleView("ellipsoids", demo);
    case 'V':
      return toggleView("tets", demo);
    case 'N':
      return toggleView("contacts", demo);
    case 'P':
    case kKeyF12:
      return send(Ask::kScreenshot, "", demo);
    case 'K':
      ask(demo, {Ask::kRecord, "", "", demo.capture.recording ? 0.0 : 1.0});
      return true;
    case kKeyTab:
      ui.visible = !ui.visible;
      return true;
    case '/':
    case '?':
    case kKeyF1:
      ui.help = !ui.help;
      return true;
    case kKeyEscape:
      ui.quit = ui.quit || !ui.help;
      ui.help = false;
      return true;
    default:
      return false;
  }
}

}  // namespace app
