// What of a run is exported, and into which file.
#pragma once

#include <string>

namespace app {

enum class ExportWhat { kStrands, kGuides, kMesh, kCards };

struct ExportSpec {
  std::string file;  // .abc, .usda, .hair, .ply, .tfx or .glb; empty: nothing is exported
  ExportWhat what = ExportWhat::kStrands;
  int points = 0;            // a strand, evenly from root to tip; 0: as drawn
  int first = 0, last = -1;  // frames of the run; last -1: its last
  bool range = false;        // asked as one: files a frame are numbered though it holds one frame
  int every = 1;             // of them, every nth
  int samples = 1;           // moments a frame, for motion blur
  double shutter = 0.5;      // of a frame's length: from its first moment to its last
  double unit = 1;           // m that a unit of the file stands for

  bool takes(int frame) const { return frame >= first && (last < 0 || frame <= last) && (frame - first) % every == 0; }
};

}  // namespace app
