// The panels: Dear ImGui only, no window system and no OpenGL, so that they can be tested by feeding mouse events. What
// a person asks for goes into demo.requests; the panels change nothing themselves.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "app/files/folder_list.h"
#include "app/scene/demo.h"

struct ImFont;

namespace app {

// A widget of the last drawn frame, for tests and scripted tours.
struct UiItem {
  std::string name;
  float x = 0, y = 0, width = 0, height = 0;  // pixels
};

// What the file panel is open for.
enum class BrowseFor { kNothing, kOpen, kMotion, kParts, kHair, kEnvironment, kWorn, kMap, kSaveScene };

struct FileBrowser {
  BrowseFor what = BrowseFor::kNothing;
  std::string folder;  // shown; kept from one time to the next
  std::vector<FolderEntry> entries;
  std::array<char, 512> name{};
  std::string to_replace;  // is there already and is written on the second press
  bool project = false;    // what is saved: all that moves as well
  std::string last;        // scene or project that was saved or opened last
  std::string saving;      // scene or project that is being written; its name is asked for again where that fails
  bool opened = false;     // since the last frame: the name is ready to be typed
};

// The brush in a person's hand.
struct BrushState {
  int tool = -1;                                      // of BrushTool; -1: none
  int field = -1;                                     // of kFieldNames, that is painted in place of a tool; -1: none
  double value = 0.2;                                 // that it is painted with
  std::array<float, 3> color{0.75f, 0.25f, 0.2f};     // in its place for the field "color"
  double radius = 0.04, strength = 0.5, falloff = 1;  // m
  bool mirror = false;
  bool over_hair = false, stroking = false;  // then a drag is the brush's, not the camera's
  bool held = false;                         // the button, in the frame before
  bool off_hair_said = false;                // since the window was opened
  bool tie = false;                          // in place of a tool: a tie's ring, put down where the button is let go
  double tie_radius = 0.02;                  // m
  bool tie_held = false;                     // its slider
  int tie_picked = -1;                       // of the character's ties, that the rows speak of; -1: of all
  bool tie_moves = false;                    // the ring that is put down is the picked one
  Vec3 last = Vec3::Zero();                  // m, scalp frame: where combing has come to
};

// The elements of the hair mesh in a person's hand; radius, falloff and mirror are the brush's.
struct SelectState {
  int element = -1;           // of kElementNames; -1: none are chosen
  std::vector<int> chosen;    // as MoveSample has them
  std::uint64_t haircut = 0;  // whose they are
  // While they are dragged: where the pointer was (m, scalp frame); vertices, and where they were at rest.
  Vec3 from = Vec3::Zero();
  std::vector<int> led;
  std::vector<Vec3> led_from;
  std::string said;  // of how far they fall short of the pointer
};

// The picture of a preset, as whoever draws them has come to.
struct PresetPicture {
  std::string file;
  std::uintptr_t texture = 0;  // of the graphics system, bottom row first; 0: there is none yet
  bool faulty = false;         // the file cannot be read
};

// Where the camera looked from, step by step; apart from the history of edits, so that Ctrl+Z gives hair back and not a
// view. A drag is one step, and so is a turn of the wheel.
struct ViewHistory {
  std::vector<Camera> past, future;  // the latest last
  std::optional<Camera> now;         // as it was last noted
  double zoomed = -1;                // s of ImGui's clock, when the wheel last turned
};

// The field that is being painted, as it was read last.
struct ShownField {
  std::string picture;
  ColorMap map;
};

// What the next vertices are pinned to, and how.
struct PinState {
  std::string to = "scalp";    // a joint's name, "scalp" or "scene"
  bool firm = true;            // else by `stiffness`
  double stiffness = 40;       // N/m
  double from = 0, until = 0;  // s of simulated time; until 0: for ever
  std::vector<int> read_of;    // the choice that a pin's settings were last looked for in
};

// Variations of the material that are tried one after another.
struct VaryState {
  double amount = 0.3;   // decades
  int seed = 0;          // of the last one
  std::size_t kept = 0;  // steps of the history after the one that was kept
};

struct UiState {
  bool visible = true;
  bool unfolded = false;  // in a window too narrow for sidebar and figure: the tabs are shown all the same
  bool help = false;
  bool history = false;
  std::size_t history_shows = 0;  // the moment that its list was last scrolled to
  bool dragging = false;          // a widget is held that has asked for something
  bool quit = false;
  bool focus_panels = false;                    // asked for by an arrow key: the keyboard goes to the sidebar
  float zoom_texts = 1;                         // asked for by a key: texts of that size, over the display's
  bool reload_shaders = false;                  // asked for by a key
  int open_tab = -1;                            // asked for by a key or a test; -1: leave
  float timings_bottom = 0;                     // px; 0: they are not shown
  bool history_in_sidebar = false;              // for want of room beside it
  float history_width = 0, history_height = 0;  // px with its margin; 0: it is not shown
  float fault_height = 0;                       // px from the window's bottom to a fault's upper edge; 0: there is none
  bool line_placed = false;                     // the line of a comparison stands there, or where a person has drawn it
  bool halved = false;                          // two pictures stand side by side
  bool timings_folded = false;                  // to their title
  bool timings_in_tab = false;                  // for want of room beside the sidebar they are in the Debug tab
  float text_scale = 1;                         // of a dense display
  ImFont* heading = nullptr;
  std::array<char, 512> motion_path{}, parts_path{}, hair_path{}, scene_path{};
  std::array<char, 64> preset_name{}, search{};
  std::vector<std::string> presets_in_sight;  // files whose pictures the last frame has shown, or would have
  std::vector<PresetPicture> preset_pictures;
  std::string scoped_preset, preset_scope;  // the preset under the pointer, and what it changes, in words
  std::string to_replace;                   // a file that is there already and is written on the second press
  FileBrowser browser;
  // Project that an earlier run has left; one that a person does not want; one that this run is to go on from; and
  // does.
  std::string offered, to_forget, to_go_on_from, gone_on_from;
  long scrubbed = -1;  // frame that the timeline is dragged to
  BrushState brush;
  SelectState select;
  PinState pin;
  ShownField field;
  VaryState vary;
  ViewHistory views;
  std::vector<AttachmentSpec> worn;  // as their colours are being edited
  bool worn_edited = false;
  bool light_held = false;          // the key light is turned by a drag
  bool line_held = false;           // the line of a comparison is dragged
  std::string kept_folder;          // where the list of recent files is kept; empty: nowhere
  std::vector<std::string> recent;  // files opened last
  std::vector<std::string> asked;   // files whose opening or saving has been asked for
  bool leaving = false;             // it is asked whether to leave
  std::string shown_message;
  double anew_since = 0;                 // s of ImGui's clock: the timeline had nothing on it then
  double message_since = 0;              // s of ImGui's clock
  std::vector<std::string> scene_names;  // of `scenes`
  std::vector<std::string> scenes, presets, clips, hairs, attachments;  // files on offer
  std::vector<UiItem> items;
};

// Sets fonts and colours of the current ImGui context, and looks up the files on offer.
void prepareUi(float text_scale, UiState& ui);

// The text scale that is wanted or, in a window of so many pixels, the largest with which the panels have room: 400 by
// 300 points. 0.5 to 4, below what is wanted in steps of an eighth.
float fittingTextScale(float wanted, int width, int height);

// Number of the tab of that name ("motion"), for UiState::open_tab; -1 when there is none.
int tabIndex(std::string_view name);

// What the panels leave of the window to the figure. Boxes that wait for an answer (files, keys, an offer) lie over it,
// and so do messages that go by themselves.
PicturePart freePart(const Demo& demo, const UiState& ui);

// Builds all panels of one frame, between ImGui::NewFrame and ImGui::Render.
void buildUi(Demo& demo, UiState& ui);

// A key as its character in upper case, or one of these (the numbers are those of GLFW).
enum UiKey {
  kKeyEscape = 256,
  kKeyEnter = 257,
  kKeyTab = 258,
  kKeyRight = 262,
  kKeyLeft = 263,
  kKeyDown = 264,
  kKeyUp = 265,
  kKeyHome = 268,
  kKeyF1 = 290,
  kKeyF5 = 294,
  kKeyF12 = 301
};

// Held while a key is pressed.
enum UiModifier { kNoModifier = 0, kShift = 1, kControl = 2 };

// What closing the window does: where something is not saved it asks at first, and closes while the question stands.
bool mayClose(const Demo& demo, UiState& ui);

// What a key does. Returns whether it did something.
bool pressKey(int key, Demo& demo, UiState& ui, int modifiers = kNoModifier);

// Whether a key goes to the widget that the keyboard has chosen, rather than to pressKey.
bool panelsTakeKey(int key);

struct KeyHelp {
  const char* keys;
  const char* what;
};
std::span<const KeyHelp> keyHelp();

}  // namespace app
