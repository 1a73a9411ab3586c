// What the command line says.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace app {

struct Options {
  std::string scene;                       // scene.json, or empty
  bool headless = false;
  int frames = 120;
  int width = 1280, height = 720;
  bool size_given = false;
  std::string out = "frames";
  std::vector<std::pair<std::string, std::string>> set;  // --set name=value
  std::string style, resolution;           // empty: the scene's
  std::string hair, motion, parts;         // files
  double speed = -1, fps = -1;             // negative: the scene's
  int strands = -1;
  std::string camera;                      // front, side, back, top, three-quarter or "ex,ey,ez,tx,ty,tz"
  std::string report;                      // JSON file of timings and counters
  std::string strand_path;                 // geometry or pulling
  std::string preset;
  bool no_images = false;
};

// Parses argv with CLI11. Returns false and an exit code when the program should end (help, usage fault).
bool parseOptions(int argc, char** argv, Options& options, int& exit_code);

}  // namespace app
