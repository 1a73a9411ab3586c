// What the command line says.
#pragma once

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "app/scene/record/export_spec.h"

namespace app {

// An option's value that cannot be used; what() is the whole message. Exit code kExitUsage.
struct UsageError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

struct Options {
  std::string scene;    // scene.json, or any other file that is opened; or empty
  std::string project;  // opened in the scene's place
  bool headless = false;
  int frames = 120;
  bool frames_given = false;  // a window runs on when not
  int width = 1280, height = 720;
  bool size_given = false;
  std::string out = "frames";
  std::vector<std::pair<std::string, std::string>> set;  // --set name=value
  std::vector<std::string> skips;                        // --skip name=on|off
  std::vector<std::string> pins;                         // --pin JSON, see files/pin_spec.h
  std::vector<std::string> maps;                         // --map FIELD=FILE, see files/field_map.h
  std::vector<std::string> attachments;                  // --attach FILE@JOINT, see files/attachment_spec.h
  std::vector<std::string> curves;                       // --curve FIELD=ROOT,...,TIP, see files/field_map.h
  std::string tie;                                       // see files/tie_spec.h; empty: the scene's
  std::string style, resolution;                         // empty: the scene's
  std::string hair, motion, parts, clip;                 // files; name of a clip
  std::string mends;                                     // of the hair file, curves
  std::string body;                                      // of a body without bones: see readToldBody
  bool reverse_faces = false;                            // of the hair file
  std::string fit;                                       // of the hair file: on or off; empty: the scene's
  std::string write_hair;                                // OBJ of the first character's hair mesh, in place of a run
  double budget_ms = -1, deadline_ms = -1, draw_budget_ms = -1;  // negative: the scene's
  double speed = -1, fps = -1;                                   // negative: the scene's
  double start = -1;                                             // s into the clip; negative: the scene's
  double turntable = 0;                                          // degrees a second that the camera goes round
  int strands = -1;
  std::string camera;       // front, side, back, top, three-quarter or "ex,ey,ez,tx,ty,tz"
  std::string framing;      // head, bust or figure
  std::string report;       // JSON file of timings and counters
  std::string strand_path;  // geometry, compute, software or auto
  std::string preset;
  std::string environment;  // panorama whose light replaces the scene's; empty: none
  std::string solver;       // default or paper; empty: the scene's
  std::string debug;        // debug views, comma separated
  std::string video;        // film of a headless run
  bool out_given = false;
  bool keep_frames = true;  // as PNG files, of a headless run
  std::string screenshot;   // PNG of the last frame, panels included
  bool no_images = false;
  bool gl_debug = false;  // headless: the driver checks every OpenGL call
  bool hide_panels = false;
  double ui_scale = 1;         // of texts and panels, over the display's own
  std::string panel;           // the tab that is open at first; empty: the first
  std::string record, replay;  // recordings of a run's inputs
  std::string save_state, load_state, cache;
  int save_state_at = 0;     // frames of this run after which the state is saved; 0: the last
  std::string compare;       // what to compare with, see scene/comparison.h; empty: nothing
  std::string compare_view;  // split or side
  std::string loop;          // what a clip does at its end; empty: the scene's
  ExportSpec hair_export;
};

// The same run without a window, as where none can be opened.
Options withoutWindow(Options options);

// Parses argv with CLI11. Returns false and an exit code when the program has done what was asked (help, a listing).
// Throws UsageError.
bool parseOptions(int argc, char** argv, Options& options, int& exit_code);

}  // namespace app
