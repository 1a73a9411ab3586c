// A scene: its characters, their motion, and everything a person may have turned. Read from JSON, written back as JSON.
//
// {
//   "name": "Walk",
//   "characters": [{
//     "motion": "walk.bvh", "parts": "", "body": "", "clip": "", "style": "shoulder", "resolution": "medium", "hair":
//     "", "reverse_faces": false, "fit": true, "mends": "", "position": [0, 0, 0], "heading": 0, "clip_offset": 0,
//     "loop": "auto", "look": { a row of the hair table: value
//     }, "pins": [ as pin_spec.h says ], "ties": [ as tie_spec.h says ],
//     "attachments": [ as attachment_spec.h says ],
//     "maps": { "stiffness": "a.png", "length": "b.png", "density": "c.png", "mass": "d.png" },
//     "curves": { "stiffness": [1, 0.5] }, both as field_map.h says
//   }],
//   "camera": { "view": "three-quarter", "framing": "bust", "eye": [..], "target": [..], "fov": 0.5, "follow": true,
//              "of_head": false },
//   "light": { row: value }, "view": { row: value }, "sim": { row: value },
//   "playback": { "speed": 1, "fps": 60, "settle": 0.5, "budget_ms": 0, "deadline_ms": 0, "draw_budget_ms": 0 },
//   "preset": "soft"
// }
// Every key but "characters" may be left out. Files are searched as findFile says.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "app/figure/character.h"
#include "app/files/attachment_spec.h"
#include "app/files/field_map.h"
#include "app/files/pin_spec.h"
#include "app/files/tie_spec.h"
#include "app/motion/playback.h"
#include "app/scene/detail/skips.h"
#include "app/scene/view/look_params.h"
#include "app/styles/hair_styles.h"
#include "sim/sim_params.h"

namespace app {

struct Options;

// One character of a scene, before anything is loaded.
struct CharacterSpec {
  std::string motion = "idle_turns.bvh";  // BVH, glTF, FBX, .mot
  std::string parts;                      // folder of body0000.obj ..., for .mot
  std::string body;                       // of a body without bones, what is told of it (app/files/told_body.h)
  std::string clip;                       // name within a file of several clips; empty: the first
  Style style = Style::kShoulder;
  Resolution resolution = Resolution::kMedium;
  std::string hair;              // hair mesh OBJ in place of the built-in style; empty: the style
  bool reverse_faces = false;    // of that file: they are wound inwards
  bool fit = true;               // of that file: unit, axes and size are inferred where it does not fit the head
  std::string mends;             // of curves: options of hairmesh-inspect, beside what is mended by itself
  Vec3 position = Vec3::Zero();  // m, added to the motion
  double heading = 0;            // rad about y, counter-clockwise from above
  double clip_offset = 0;        // s, where in the clip it begins
  LoopKind loop = LoopKind::kAuto;
  CharacterLook look;
  // That of the hair whose place a file took; what the file tells of its strands goes over it. None: the scene's own.
  std::optional<render::HairLook> look_before;
  FieldFiles maps_before;  // likewise
  std::string fields_of;   // the file whose fields `maps` has
  std::vector<PinSpec> pins;
  std::vector<TieSpec> ties;
  std::vector<AttachmentSpec> attachments;
  FieldFiles maps;
  FieldCurves curves;
  std::vector<std::byte> brushed;  // what brushes made of the hair (app/scene/edit/brushed_hair.h); scenes name a file
};

// Where the camera stands at the first frame. With an eye and a target given the named view is not used.
struct CameraSpec {
  std::string view = "three-quarter";  // front, three-quarter, side, back, top
  std::string framing = "bust";        // head, bust, figure: how much is in the picture
  std::optional<Vec3> eye, target;     // m
  double fov = 0.5;                    // rad, vertical
  bool follow = true;                  // goes along with the first character
  bool of_head = false;                // eye and target count from that character's head
};

// Views that a person kept, of the keys 1 to 4.
using Bookmarks = std::array<std::optional<CameraSpec>, 4>;

struct PlaybackSpec {
  double speed = 1;           // clip seconds per second
  double fps = 60;            // frames per second of a headless run
  double settle = 0.5;        // s of simulation before the first frame
  double budget_ms = 0;       // of simulation a frame that the governor holds to; 0: it is off
  double deadline_ms = 0;     // of simulation that no frame exceeds; 0: none
  double draw_budget_ms = 0;  // of drawing a frame that the drawing governor holds to; 0: it is off
};

// Values of the tables' rows.
struct RowValues {
  sim::SimParams sim;
  std::vector<CharacterLook> hairs;  // one a character
  SceneLook scene;
};

struct Scene {
  std::string file;  // empty: not from a file
  std::string name = "untitled";
  std::vector<CharacterSpec> characters;
  CameraSpec camera;
  Bookmarks bookmarks;
  SceneLook look;
  sim::SimParams sim;
  PlaybackSpec playback;
  SkipSet skips;       // not of the file: a scene means the same whatever is skipped
  std::string preset;  // a file's name: the scene's, or that a person chose last; empty: none
  // Not of the file, which has the lights alone: the panorama that they were taken from, and those before; empty: none.
  std::string environment;
  render::LightInput own_light;
  RowValues base;  // not of the file: as it was opened, or as the preset that was chosen last has left them
};

// Bounds that a scene is held to.
inline constexpr std::size_t kMaxCharacters = 256;
inline constexpr double kFastestPlayback = 100, kSlowestFps = 1, kFastestFps = 1000, kLargestBudget = 1000;

// Reads a scene. Throws InputError naming file and place; the files that it names are only looked for.
Scene readScene(std::string_view text, const std::string& file);
Scene loadScene(const std::string& file);

// The scene as text that readScene reads back to the same scene. File names are written as they were found.
std::string writeScene(const Scene& scene);

// The options with the file that stands alone where its kind belongs. Throws InputError, or UsageError for a kind that
// cannot be opened so.
Options sortedOut(Options options);

// The scene that the command line asks for: its scene file or the default one, then the overrides of the options.
// Throws InputError, or UsageError for an option's value.
Scene sceneFromOptions(const Options& options);

// "low" -> Resolution::kLow; empty when unknown.
std::optional<Resolution> parseResolution(std::string_view name);

}  // namespace app
