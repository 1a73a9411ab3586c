// Pins as a scene file has them: hair mesh vertices fastened to joints, to the scalp or to the scene.
//
//   "pins": [{ "vertex": 41, or "column": 3 and "layer": -1 (the tip), or "near": [x, y, z],
//              "to": "LeftHand", "scalp" or "scene", "at": [x, y, z], "stiffness": 40 or "infinite", "from": 0,
//              "until": 5 }]
// "near" is in metres in the scalp's frame and means the vertex that is nearest at rest, whatever the resolution. "at"
// is in metres in the frame of what the vertex is fastened to; left out, it is where the vertex is at rest. Every key
// but the vertex may be left out: then the pin is firm, to the scalp, for all the time.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "app/files/json_reader.h"
#include "sim/mesh/hair_mesh.h"

namespace app {

struct PinSpec {
  static constexpr double kForever = std::numeric_limits<double>::infinity();
  int vertex = -1;                    // or a column and a layer of it, or the nearest
  int column = -1, layer = -1;        // layer -1: the tip
  std::optional<sim::Vec3> near;      // m, scalp frame
  std::string to = "scalp";           // a joint's name, "scalp" or "scene"
  std::optional<sim::Vec3> at;        // m
  double stiffness = kForever;        // N/m
  double from = 0, until = kForever;  // s of simulated time
  std::string file, place;            // that it was read from, for messages
};

inline constexpr std::size_t kMaxPins = 256;
inline constexpr double kStiffestPin = 1e5;  // N/m; beyond it a pin is as good as firm

// Throws InputError. Whether vertex and joint exist is known only where hair and figure are (app/scene/pins.h).
std::vector<PinSpec> readPins(const JsonPlace& place);
nlohmann::json writePins(const std::vector<PinSpec>& pins);

// One pin from the command line, as JSON; a list of them, as a request has them.
PinSpec pinFromText(std::string_view text);
std::vector<PinSpec> pinsFromText(std::string_view text);

}  // namespace app
