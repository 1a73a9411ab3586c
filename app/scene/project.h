// Projects: a scene with all that moves in it and what brushes have made of the hair, to go on from as it was left: to
// the bit where no brush has reshaped the hair, else from the same bits and to rounding afterwards (what a step derives
// from the rest shape in advance is then made from another one).
//
// A project is a JSON file: {"hairmesh-project": 5, "scene": as scene_file.h says, "binary": name, "checksum": text}.
// The binary beside it holds what was brushed before hair was tied or covered (from version 4 on), reshaped rest
// positions, of hair meshes that were changed the structure (2), groom offsets (3) and how far gravity would draw them
// (5), and the state (demo_state.h); it is NAME-CHECKSUM.bin, so that a project that cannot be saved leaves the one
// that was there with its own. What is kept of a run by itself has "autosave_of" besides: the file of its scene, or "".
#pragma once

#include <string>

#include "app/scene/demo.h"

namespace app {

inline constexpr int kProjectVersion = 5;

// With `name` for the scene's; empty: it keeps its own. Throws OutputError; then the project that was there is whole.
void saveProject(const std::string& file, const Demo& demo, const std::string& name = "");

// The scene that it holds. Throws InputError as openProject does.
Scene projectScene(const std::string& file);

// Opens it for pictures of `aspect` (width over height), with its own scene or another one of the same figures and
// hair. `keep_view`: the camera is the scene's and not where it was left. Throws InputError as openProject does.
Demo readProject(const std::string& file, Scene scene, bool keep_view, double aspect);

// Whether a file is a project; not where it cannot be read.
bool holdsProject(const std::string& file);

// Opens it in the demo's place. Throws InputError (no project, of a newer version, its binary gone or changed); then
// nothing has changed.
void openProject(const std::string& file, Demo& demo);

// What is kept of a run while it goes on, so that a crash loses little.
class Autosave {
 public:
  // `kept_folder` empty: nothing is kept.
  explicit Autosave(const std::string& kept_folder);
  // Where the run has ended as it should nothing is kept of it; where it ends by an exception it is.
  ~Autosave();
  Autosave(const Autosave&) = delete;
  Autosave& operator=(const Autosave&) = delete;

  // Keeps the demo where it has changed and the last time is long ago, and as soon as its file has been saved. `now`:
  // s. A fault is no reason to disturb: it tries again later.
  void keep(double now, const Demo& demo);
  // The project of a run that has ended without leaving, of a process that is gone; empty: there is none.
  std::string left() const;
  // Forgets that one; a file that a person has saved in its place stays.
  void forget(const std::string& file) const;
  // Forgets that one as soon as this run, which goes on from it, is kept itself or ends.
  void replace(const std::string& file) { replaced_ = file; }

 private:
  std::string folder_, file_;
  double last_ = -1e9, look_at_ = -1e9;  // s: when it was kept, and when to look again
  std::string replaced_;
  std::string kept_, saved_;  // what of the demo was kept: its edits; of which saving of its file
};

}  // namespace app
