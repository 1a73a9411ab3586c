// Drawing time against the picture's error, over the settings that a scene can be drawn with.
#pragma once

#include <string>
#include <vector>

namespace bench {

struct DrawParetoOptions {
  std::vector<std::string> scenes;  // empty: all
  std::string folder;               // of docs
  int runs = 3;                     // timed frames a setting
  bool quick = false;               // those settings alone that came near a front
};

// Writes <folder>/data/draw_pareto.csv, draw_scenes.csv, draw_settings.csv, where gnuplot is installed
// draw_<scene>.svg and .png, and the measured parts of drawing.md where the folder has it. Scenes that are not asked
// for keep what was measured of them. Prints each scene's front and where the default stands. Throws app::InputError
// and app::ContextError.
void runDrawPareto(const DrawParetoOptions& options);

}  // namespace bench
