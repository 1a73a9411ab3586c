// A/B: a second demo with other settings, simulated in step with the first one, and what the two differ by.
//
// What moves both (pause, steps, clip, speed, rewind, reset) is asked of both; parameters, presets, styles and brushes
// are asked of the first one alone.
#pragma once

#include <string>
#include <vector>

#include "app/files/scene_file.h"
#include "app/scene/request.h"

namespace app {

struct Demo;

// Of the same vertices of both, m. Hair of another cut, on another figure or in another place has none.
struct HairDifference {
  bool known = false;
  double rms = 0, worst = 0;
};

struct Comparison {
  std::vector<Demo> other;  // one while it is on, else none
  std::string with;         // what it was asked for by
  bool side_by_side = false;
  double line = 0.5;              // share of the picture's width that is the first demo's
  HairDifference now;             // of this frame
  double rms_sum = 0, worst = 0;  // over the frames so far in which it is known, m
  double seconds[2] = {0, 0};     // of simulation so far: the first one's, the other's
  long frames = 0;
  bool on() const { return !other.empty(); }
};

// The scene under other settings, see startComparison. Throws InputError.
Scene comparedScene(const std::string& with, Scene scene);

// Starts a comparison of `demo`, as it is now, with the same under other settings. `with`: a preset's name; a preset,
// scene, hair mesh or groom file; settings as NAME=VALUE,NAME=VALUE; or nothing: the very same, to be changed beside
// it. Throws InputError; then nothing has changed. Other hair begins at rest where the figure is.
void startComparison(const std::string& with, Demo& demo);

// Those of a frame's requests that the other one is asked as well.
std::vector<Request> sharedRequests(const std::vector<Request>& requests);

// Advances the other one by what the first one has been advanced by, and measures.
void advanceCompared(double seconds, std::vector<Request> requests, Demo& demo);

// "hair apart by 3.1 mm RMS, 14 mm at most; 0.41 ms a frame against 0.38 ms", or "other hair; ..."; empty without a
// comparison.
std::string comparisonText(const Demo& demo);

}  // namespace app
