// What a person asks of the demo, as plain values: panels, keys, dropped files and tests all speak through these, and a
// recording of a run is a list of them.
#pragma once

#include <string>
#include <vector>

namespace app {

enum class Ask {
  kSetParam,     // name, text: a row of any of the three tables
  kPause,        // value: 1 pauses simulation and motion, 0 goes on
  kPauseMotion,  // value: 1 holds the clip while the hair goes on
  kSingleStep,   // one simulation step while paused
  kReset,        // hair to rest at the present pose
  kRestart,      // all clips and hair to the start
  kCollapse,     // every vertex onto its column's root (figure 8 of the paper)
  kCarryAlong,   // value: s in the clip; the hair is carried along rigidly
  kSpeed,        // value: clip seconds per second
  kLoop,         // name: go-on, in-place, ...
  kClip,         // name
  kStyle,        // name
  kResolution,   // name
  kMotionFile,   // text: file
  kBody,         // text: what is told of a body without bones, in place of what was
  kHairFile,     // text: file
  kHairMends,    // text: options of hairmesh-inspect that the hair file is read with, in place of those before
  kSceneFile,    // text: file
  kPresetFile,   // text: file
  kSavePreset,   // text: file
  kSaveScene,    // text: file
  kSaveState,    // text: file
  kLoadState,    // text: file
  kOpenFile,     // text: any of the above, told apart by ending and content
  kSelect,       // value: which character the panels speak of
  kView,         // name: front, three-quarter, ...
  kFollow,       // value
  kDebugView,    // name, value
  kBudget,       // value: ms of simulation a frame; 0: the person's own settings hold
  kDrawBudget,   // value: ms of drawing a frame; 0: all is drawn as it is set
  kDeadline,     // value: ms that the simulation of a frame takes at most; 0: none
  kSkip,         // name, value
  kScreenshot,   // text: file, empty for the next free name
  kRecord,       // value: 1 starts, 0 ends
  kRecordHair,   // value: 1 starts, 0 ends; text: file, or an ending alone for the next free name; empty: a cache
  kOpenCache,    // text: file; the timeline shows it. Empty: it shows what is kept in memory again
  kBrush,        // name: tool, text: a sample of a stroke on the selected character's hair; see groom_brush.h
  kMove,         // name: element, text: a sample of a drag of what is chosen; see mesh_change.h
  kMesh,         // name: change of the hair mesh's structure, text: what it is given; see mesh_change.h
  kSaveProject,  // text: file
  kOpenProject,  // text: file; value 1: a run begins with it, and it is no step of the history
  kRewind,       // value: number of the frame to go back to; see timeline.h
  kKeepView,     // value: bookmark 0 to 3 takes the present view
  kGoToView,     // value: bookmark whose view is taken
  kLens,         // value: rad, the camera's vertical angle
  kTurntable,    // value: rad/s that the camera goes round the figure
  kUndo,         // value: so many steps back
  kRedo,         // value: so many steps on
  kEndGesture,   // a drag is over: what follows is a step of its own
  kCompare,      // text: what to compare with, see comparison.h; value: 0 ends it
  kCompareView,  // name: split or side; value: share of the picture left of the line
  kMarkIn,       // value: 1 sets the timeline's in point at the present frame, 0 clears it
  kMarkOut,      // likewise the out point
  kBake,         // value: s to simulate ahead where there is no out point; see timeline.h
  kClearBake,    // what the timeline keeps is forgotten
  kMap,          // name: of a field, see field_map.h; text: the picture it is painted by, empty for none
  kTie,          // text: ties of the selected character, see tiesFromText
  kPin,          // text: pins of the selected character in place of those before, see pinsFromText
  kAttach,       // text: attachments of the selected character in place of those before, see attachmentsFromText;
                 // name: add, beside those before
  kDragWorn,     // text: the same attachments; where they are drawn until the next frame, or while they are loaded
  kPaint,        // name: field, text: a sample of a stroke; see paint_brush.h
  kCurve,        // name: field, text: shares from root to tip; see setCurve
  kVary,         // value: seed; text: how far, see varyMaterial
  kEnvironment,  // text: panorama that the lights are taken from; empty: those before it
  kCount
};

struct Request {
  Ask what;
  std::string name, text;
  double value = 0;
};

// What became of a file that a request named: it was opened or saved, or it was refused.
struct FileEnd {
  std::string file;
  bool done = false;
};

}  // namespace app
