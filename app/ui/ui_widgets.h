// The panels' own widgets: rows of the parameter tables, icon buttons, segmented choices.
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>

#include "app/scene/edit/picking.h"
#include "app/scene/view/look_params.h"
#include "app/scene/view/row_words.h"
#include "app/ui/ui.h"

namespace app {

// Remembers where the last widget is.
void noteItem(const std::string& name, UiState& ui);

// The same of something drawn on the hair about a pixel.
void noteMark(const std::string& name, float x, float y, float radius, UiState& ui);

void postRequest(Demo& demo, Request request);

// The figure's picture in the window, pixels of the mouse; side by side with another the left one.
Picture shownPicture(const Demo& demo);

// A tooltip for the last widget, once the pointer has rested on it for a moment. A press ends it until the pointer
// comes anew, and what the keyboard has chosen has none.
void tip(const std::string& text);

// While it lives sliders are drawn with their marks along the lower edge, so that none lies behind the digits.
class MarksBelowDigits {
 public:
  MarksBelowDigits();
  ~MarksBelowDigits();
  MarksBelowDigits(const MarksBelowDigits&) = delete;
  MarksBelowDigits& operator=(const MarksBelowDigits&) = delete;

 private:
  int first_;  // vertex of the window's draw list
};

// A swatch, with its three numbers unless `flags` (of Dear ImGui) leave them out, of a linear colour: shown as pictures
// have it, by the curve of sRGB. Returns whether it was changed.
bool colorSwatch(const char* name, std::array<float, 3>& linear, int flags);

// A heading that folds; returns whether it is open.
bool section(const char* title, bool open_at_first);

// Name, control, and a reset mark while the value is not that of Scene::base; below, the value that is used where the
// hair cannot bear it. A change becomes a request.
void simRow(const sim::ParamField& field, Demo& demo, UiState& ui);
template <class Owner>
void lookRow(const LookField<Owner>& field, const Owner& owner, Demo& demo, UiState& ui);

// All rows of a group of the tables.
void simGroup(std::string_view group, Demo& demo, UiState& ui);
void hairGroup(std::string_view group, Demo& demo, UiState& ui);
void sceneGroup(std::string_view group, Demo& demo, UiState& ui);

// A combo of files by their stem. Returns the chosen path, or empty.
std::string fileCombo(const char* name, const std::string& shown, const std::vector<std::string>& files, UiState& ui);

// A row that tells a value and changes none.
void fact(const char* label, const std::string& value);

// A label in the left column; the control that follows fills the rest.
void rowLabel(const std::string& text, const std::string& help);

// The mark at the end of a row that takes it back to `default_text`; returns whether it was pressed. Its width, points.
bool resetMark(const char* name, const std::string& default_text, UiState& ui);
inline constexpr float kResetWidth = 20;

enum class Icon { kPlay, kPause, kStep, kReset, kRestart, kCollapse, kPhoto, kRecord, kHelp, kPanels, kBack };
bool iconButton(Icon icon, const char* name, const std::string& help, bool lit, UiState& ui);

struct Segment {
  const char* label;
  const char* help;  // shown over it
  bool enabled;      // else it is grey
  Segment(const char* shown, const char* said = "", bool works = true) : label(shown), help(said), enabled(works) {}
};

// Buttons side by side, one of them chosen. Returns the index pressed, or -1.
int segments(const char* name, std::initializer_list<Segment> row, int chosen, UiState& ui);

}  // namespace app
