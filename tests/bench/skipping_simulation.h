// Runs the simulation of one shared scene with one set of skips: what a frame costs and what shapes it shows.
#pragma once

#include <functional>
#include <vector>

#include "app/scene/demo.h"
#include "tests/bench/skipping_scene.h"

namespace bench {

// Shown positions (m, x y z of each vertex), per drawn frame and actor.
using Shown = std::vector<std::vector<std::vector<float>>>;

struct Simulated {
  SkipRow row;  // its simulation and character part
  Shown shown;
  std::vector<double> metre;  // pixels, per actor
  std::vector<bool> seen;     // per actor
};

app::SkipSet noSkips();

// `draw` is called after each frame that is to be drawn. Throws InputError where the scene cannot be loaded.
Simulated simulate(const SceneRun& run, const app::SkipSet& skips, const std::function<void(app::Demo&)>& draw = {});

// Into the row: how far the shapes of those that are seen are off from the reference's.
void compareShapes(const Simulated& reference, const Simulated& other, SkipRow& row);

}  // namespace bench
