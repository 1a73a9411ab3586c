// Undo and redo of what requests change: parameters, presets, files, look, and what they do to hair and motion. Moves
// of the camera are none of these steps; scenes, projects, states and motions that bring a view with them give it back.
//
// A step holds the side of the edit that is not on the screen: what was before it while it is done, what was after it
// while it is undone. Settings, meshes and rest shapes come back. What moves belongs to the time that is shown:
// - While no time has gone on since the edit, what moves comes back too, to the bit.
// - Where time has gone on, undo is the opposite edit, made now: hair goes along with its rest shape and swings on;
//   another mesh begins at rest, as one that is chosen does.
// - Edits of what moves itself take it back whenever they are undone: hair that was put to rest or collapsed has the
//   shape that it had, carried to where the head is now; a motion goes on where it was left.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/files/scene_file.h"
#include "app/motion/playback.h"
#include "app/scene/request.h"
#include "app/scene/view/camera.h"
#include "app/scene/view/debug_views.h"
#include "sim/linear/vector3.h"
#include "sim/mesh/hair_mesh.h"
#include "sim/mesh/hair_state.h"

namespace app {

struct BackgroundLoad;
struct Demo;

// One character's hair, and its motion where the edit has changed it.
struct ActorMoment {
  Rigid head = Rigid::Identity();  // scalp frame to world
  sim::HairState hair;
  std::optional<Playback> playback;
  sim::HairMeshShape shape;  // of hair that brushes have reshaped or are about to; else without positions
  bool remeshed = false;     // that shape has a structure of its own
  std::vector<float> frozen;
  std::vector<sim::V3<double>> sag;  // Material::sag of that structure
};

// What an edit can change, as it is at one moment.
struct EditSide {
  Scene scene;
  std::vector<CharacterSpec> cast;  // the characters as they are played
  int selected = 0;
  DebugViews debug;
  std::optional<Camera> camera;      // of edits that bring a view with them
  std::vector<ActorMoment> moments;  // of edits of hair or motion, one a character
  long moment = 0;                   // EditHistory::moment, then
  std::size_t bytes() const;         // about as many as it takes
};

struct EditStep {
  std::string title;  // "Density 80"
  Request request;
  EditSide other;
  long number = 0;  // of the history's steps, in order
};

struct EditHistory {
  std::vector<EditStep> steps;  // the first `done` ones are done, the others undone
  std::size_t done = 0;
  bool forgot = false;   // steps before the first have been dropped
  bool gesture = false;  // the last step goes on: a slider that is dragged makes one step
  long next = 1;         // number of the step after all that there were
  long saved = 0;        // number of the last step done when a scene or project was saved or opened
  // Of what moves: the same number is the same state. The last that was given is `moments`.
  long moment = 0, moments = 0;
  // What was undone before the last step, while that is being loaded and may be taken out again.
  std::vector<EditStep> dropped;
};

inline constexpr long kNeverSaved = -1;  // as `saved`: what an earlier run has left

// Number of the last step that is done; 0: none ever was.
inline long lastDone(const EditHistory& history) {
  if (history.done > 0) return history.steps[history.done - 1].number;
  return history.steps.empty() ? 0 : history.steps.front().number - 1;
}
inline bool isUnsaved(const EditHistory& history) {
  return lastDone(history) != history.saved;
}

// Older steps are dropped beyond this.
inline constexpr std::size_t kMaxEditBytes = std::size_t{256} << 20;

// Before an edit is applied: what it will change, if it is one and begins a step of its own.
std::optional<EditStep> beginEdit(const Request& request, const Demo& demo);
// After it has been applied without a fault. What was undone before it is gone, unless what it asks for comes `later`
// and is refused then.
void commitEdit(EditStep step, bool later, EditHistory& history);

// What moves is no longer as it was: a step was simulated, or another moment has been gone to.
inline void noteMoment(EditHistory& history) {
  history.moment = ++history.moments;
}

// Whether the last step is a gesture of this kind that goes on: a stroke after its first sample.
bool goesOn(Ask what, const EditHistory& history);

// Takes a step out that has changed nothing after all: what it asked for could not be loaded.
void forgetEdit(long number, EditHistory& history);

// Edits that wait for what is being loaded: they become steps when it is there, and are undone before those.
int heldEdits(const BackgroundLoad& loading);

// Goes `count` steps back or on; where there are none, a notice says so. Files that a step names are read again: where
// that fails, it throws and the step stays as it is.
void undoEdits(int count, Demo& demo);
void redoEdits(int count, Demo& demo);

// A hash of all that undo brings back: settings, view, and stateHash.
std::string editHash(const Demo& demo);

}  // namespace app
