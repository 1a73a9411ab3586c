// A scene drawn with every setting: what a frame takes, and how far its picture is from the reference.
#pragma once

#include <string>
#include <vector>

#include "tests/bench/draw_scene.h"

namespace bench {

struct DrawPoint {
  DrawSetting setting;
  double wall = 0, processor = 0;  // ms a frame, medians
  double time = 0;  // ms that ranks: the least of the runs, of the processor where the driver has no GPU, else wall
  PictureError error;
  long strands = 0;
  bool on_front = false;
};

struct DrawSweep {
  DrawScene scene;
  DrawReference reference;
  std::vector<DrawPoint> points;  // the default first
};

// Draws every setting `runs` times, in turns, so that a disturbance of the machine does not fall on one alone. Those
// that take over three times the default's are timed once.
DrawSweep sweepDrawing(DrawStage& stage, const std::vector<DrawSetting>& settings, int runs);

// Whether a picture is no further off than another: in RMS by no more than what the reference's own error adds, in the
// blocks by no more than a tenth.
bool noWorse(const PictureError& error, const PictureError& than, const PictureError& own);

// How many times the fastest setting whose picture is no worse is faster than the default; that setting.
struct DrawLag {
  double ratio = 1;
  const DrawPoint* point = nullptr;
};
DrawLag lagOfDefault(const DrawSweep& sweep);

// The same with the ratio as it comes out in turns with the default: the median of so many rounds. Where the setting
// then is not faster, it is the default itself.
DrawLag confirmedLag(DrawStage& stage, const DrawSweep& sweep, int rounds);

// Time of `slow` over that of `fast`, in turns; the median of so many rounds.
double confirmedRatio(DrawStage& stage, const DrawSetting& slow, const DrawSetting& fast, int rounds);

}  // namespace bench
