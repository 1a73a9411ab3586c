// The hair that is simulated, handed out frame by frame: strands as they are drawn, guides, or the hair mesh as a cage.
// No OpenGL is needed.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "app/groom/clip_settings.h"
#include "app/groom/groom.h"
#include "app/scene/demo.h"
#include "app/scene/record/export_spec.h"

namespace app {

// Strands of every character of the scene as the next frame shows them, in the world: metres, y up, root first. The
// same strands in every frame of a scene; those without length are left out. Groups are characters, ids go through
// them.
class StrandExport {
 public:
  // points: a strand, or 0 for as many as drawn.
  StrandExport(const Demo& demo, ExportWhat what, int points);
  ~StrandExport();

  // Valid until the next call. `unit`: m that a unit of the result stands for.
  const Groom& groom(const Demo& demo, double unit);
  // The same as the last time.
  const Groom& last() const { return groom_; }

 private:
  struct Grown;
  std::vector<std::unique_ptr<Grown>> grown_;  // per character
  ExportWhat what_;
  int points_;
  Groom groom_;
};

// One export of a run: opened before its first frame, so that what cannot be written is known then.
class HairExport {
 public:
  // fps: frames of the run a second. The run has frames `begin` to `end` - 1; the largest number: until it is stopped.
  // Throws OutputError.
  HairExport(const ExportSpec& spec, const Demo& demo, double fps, int begin, int end);
  ~HairExport();

  // Takes what the demo shows now as a moment of frame `frame`. Throws OutputError.
  void add(const Demo& demo, int frame);
  // Without a moment no file is touched. Returns what was written, and what the figures wear that was not, for the
  // terminal. Throws OutputError.
  std::string finish(const Demo& demo);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// What an export cannot do without: everyone is simulated whether seen or not, on their own hair mesh.
void simulateAll(SkipSet& skips);

}  // namespace app
