// The tabs of the sidebar and the timings panel.
#pragma once

#include "app/scene/demo.h"
#include "app/ui/ui.h"

namespace app {

void simulationTab(Demo& demo, UiState& ui);
void motionTab(Demo& demo, UiState& ui);
void hairTab(Demo& demo, UiState& ui);
void lookTab(Demo& demo, UiState& ui);
void debugTab(Demo& demo, UiState& ui);

// The table of skips: a switch and a count for each.
void skipsSection(Demo& demo, UiState& ui);

// Stages as a stacked bar and their history (figure 6 of the paper), solver iterations and residual.
void timingsPanel(Demo& demo, UiState& ui);

// The timeline right of `left` (pixels), and the height that it takes of the window; 0: it is not shown. Lens,
// turntable and kept views.
float timelineHeight(const Demo& demo, const UiState& ui, float left);
void timelinePanel(Demo& demo, UiState& ui, float left);
void cameraRows(Demo& demo, UiState& ui);

// Where notices stand, px: their lower edge, and the room that they have across.
struct NoticePlace {
  float left, width, bottom;
};
// Offers what an earlier run has left; asks whether to leave.
void offerPanel(const NoticePlace& place, Demo& demo, UiState& ui);
void leavePanel(const NoticePlace& place, Demo& demo, UiState& ui);

// The brushes' settings; and, before the panels, their ring on the hair and what a drag asks for.
void brushSection(Demo& demo, UiState& ui);
void brushFrame(Demo& demo, UiState& ui);

// Elements of the hair mesh: the row that chooses them and changes the mesh; before the panels, what is chosen and what
// a drag asks for (`begins`: the button has gone down); another kind of them; and what an arrow key does, if it does.
void selectRow(Demo& demo, UiState& ui);
void selectFrame(bool begins, Demo& demo, UiState& ui);
void chooseElement(int element, UiState& ui);
bool nudgeChosen(int key, bool far, Demo& demo, UiState& ui);

// Curves of stiffness and mass from root to tip.
void curveRows(Demo& demo, UiState& ui);

// The hair's ties: sets of them by name, and a list of which one is picked, changed and taken away.
void tieRows(Demo& demo, UiState& ui);

// What the character wears.
void attachmentSection(Demo& demo, UiState& ui);
void pinSection(Demo& demo, UiState& ui);

// Presets as pictures and as a list, and the row that saves one.
void presetRows(Demo& demo, UiState& ui);

// What the scene is compared with; and, before the panels, the line between the two, which a drag moves.
void compareRows(Demo& demo, UiState& ui);
void compareLine(Demo& demo, UiState& ui);

// The steps that can be undone and done again, by name; a press goes there.
void historyPanel(Demo& demo, UiState& ui);
// Pixels of its least height, with its margin; 0: it is not shown.
float historyLeast(const UiState& ui);
// The same within the sidebar.
void historyList(Demo& demo, UiState& ui);

// The file panel, while it is open; opening it; and what a file that was chosen or dropped asks for.
void filePanel(Demo& demo, UiState& ui);
void browseFor(BrowseFor what, UiState& ui);
// The same to save the scene, with the name and folder that it was saved or opened by.
void browseToSave(const Demo& demo, UiState& ui);
void openFile(const std::string& file, Demo& demo, UiState& ui);

// Notes a view that the camera has come to, once the mouse is let go. While a turntable turns it notes none.
void noteView(const Demo& demo, UiState& ui);
// Back to the view before, or on to the one after.
void stepView(bool back, Demo& demo, UiState& ui);

// Puts files that have been opened or saved since the last frame among the recent ones, and takes refused ones out.
void noteFiles(Demo& demo, UiState& ui);

// The frame budget: a switch, its milliseconds, and what the governor makes of them.
void budgetLines(Demo& demo, UiState& ui);
// The same of the drawing's budget.
void drawBudgetLines(Demo& demo, UiState& ui);

}  // namespace app
