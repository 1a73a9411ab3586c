// Simulated hair that a person records while the window runs: an export (.abc, .usda, .hair, .ply, .tfx, .glb) or a
// cache for the timeline (.hairmesh).
#pragma once

#include <optional>
#include <string>

#include "app/scene/demo.h"
#include "app/scene/record/hair_export.h"
#include "app/scene/record/sim_cache.h"

namespace app {

class HairRecorder {
 public:
  // fps: frames a second that the file tells of.
  explicit HairRecorder(double fps) : fps_(fps) {}

  // After a frame: takes it where demo.capture.hair asks for it, and begins and ends files. A finished cache is what
  // the timeline shows. Faults become the demo's message and end the recording; nothing is left of the file then.
  void frame(Demo& demo);
  // At the end of the run: what is open is finished. Throws OutputError.
  void close(Demo& demo);

 private:
  int numberOf(const Demo& demo) const;
  void begin(Demo& demo);
  void finish(Demo& demo);
  bool on() const { return export_ || cache_; }

  double fps_;
  std::optional<HairExport> export_;
  std::optional<SimCacheWriter> cache_;
  int first_ = 0, frames_ = 0;  // number of the first frame; how many there are
  std::string strands_;         // what they were when the recording began
};

}  // namespace app
