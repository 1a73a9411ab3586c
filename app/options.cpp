#include "app/options.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iostream>

#include "app/files/errors.h"
#include "app/files/scene_file.h"
#include "app/groom/formats/tfx_file.h"
#include "app/groom/groom_writer.h"
#include "app/groom/inspect/certain_mends.h"
#include "app/output_names.h"
#include "app/parse_fault.h"
#include "app/scene/detail/skips.h"
#include "app/scene/hairdo.h"
#include "app/scene/parameter_table.h"
#include "app/scene/view/look_params.h"
#include "sim/field_text.h"

namespace app {

namespace {

std::vector<std::string> choicesOf(const char* parameter) {
  const auto names = sim::findParam(parameter)->choices;
  return {names.begin(), names.end()};
}

constexpr int kSmallestSide = 16, kLargestSide = 8192, kMaxFrames = 1000000;
constexpr int kMaxExportPoints = 1024, kMaxExportSamples = 32;

// "1280x720".
bool parseSize(const std::string& text, int& width, int& height) {
  const std::size_t cross = text.find('x');
  double w = 0, h = 0;
  if (cross == std::string::npos || !sim::parseNumber(text.substr(0, cross), w) ||
      !sim::parseNumber(text.substr(cross + 1), h)) {
    return false;
  }
  const auto fits = [](double side) {
    return side == static_cast<int>(side) && side >= kSmallestSide && side <= kLargestSide;
  };
  if (!(w >= kSmallestSide && w <= kLargestSide && h >= kSmallestSide && h <= kLargestSide && fits(w) && fits(h))) {
    return false;
  }
  width = static_cast<int>(w);
  height = static_cast<int>(h);
  return true;
}

// One of some names; for another one the nearest is suggested.
CLI::Validator oneOf(std::vector<std::string> names) {
  return CLI::Validator(
      [names = std::move(names)](std::string& text) {
        if (std::ranges::find(names, text) != names.end()) return std::string();
        const std::vector<std::string_view> candidates(names.begin(), names.end());
        std::string known;
        for (const std::string& name : names) known += (known.empty() ? "" : ", ") + name;
        const std::string_view near = sim::nearestName(text, candidates);
        return "there is no '" + text.substr(0, 40) + "'; " +
               (near.empty() ? "choose one of " : "did you mean '" + std::string(near) + "'? Choose one of ") + known;
      },
      "");
}

// What an unset variable of a script leaves.
CLI::Validator notEmpty(const std::string& placeholder) {
  return CLI::Validator(
      [=](std::string& text) { return text.empty() ? "is empty; write " + placeholder : std::string(); }, "");
}

const char* const kExamples = R"(Examples:
  hairmesh                                        the default scene in a window
  hairmesh assets/scenes/head_shake.json          another scene
  hairmesh walk.bvh                               a motion; a hair mesh (.obj) or preset likewise
  hairmesh --style long --resolution high --motion walk.bvh
  hairmesh --headless --frames 240 --size 1280x720 --out frames --style short
  hairmesh --headless --frames 600 --no-images --report timings.json
  hairmesh --no-images --frames 240 --strands 10000 --export walk.abc    (.usda, .hair, .ply, .glb)
  hairmesh --motion dance.mot --parts female-objs --speed 2 --set friction=0.6 --set solver=paper

Of an option that is given twice the last counts, of --export too; --set, --skip, --pin, --map, --curve and --attach add up.

Exit codes: 0 fine, 1 OpenGL or numerical fault or a file that cannot be written, 2 usage, 3 no OpenGL context,
4 a file that cannot be used, 130 interrupted.)";

// What is read as text and checked once all of the line is read.
struct Unchecked {
  std::string size;
  std::vector<std::string> sets;
  std::string collider;
  std::string export_what, export_frames, export_unit;
  bool list_parameters = false, list_skips = false;
};

// A heading of --help and the options under it.
struct OptionGroup {
  CLI::App& parser;
  const char* heading;

  template <class Value>
  CLI::Option* value(const char* name, Value& value, const char* placeholder, const char* help) {
    CLI::Option* option = parser.add_option(name, value, help)->group(heading)->option_text(placeholder);
    if constexpr (std::is_same_v<Value, std::string>) option->check(notEmpty(placeholder));
    return option;
  }
  // May be given many times, one value each.
  void values(const char* name, std::vector<std::string>& values, const char* placeholder, const char* help) {
    value(name, values, placeholder, help)
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
        ->allow_extra_args(false);
  }
  void flag(const char* name, bool& on, const char* help) { parser.add_flag(name, on, help)->group(heading); }
};

void addSceneOptions(CLI::App& parser, Options& options, Unchecked& unchecked) {
  OptionGroup group{parser, "What is shown"};
  group
      .value("--style", options.style, "NAME",
             "Hair style: short, shoulder, long, bob, pixie or shaved; or a hairdo, with its look and ties (curly ...)")
      ->check(oneOf(styleChoices()));
  group.value("--resolution", options.resolution, "NAME", "Hair mesh resolution: low, medium, high or ultra")
      ->check(oneOf({"low", "medium", "high", "ultra"}));
  group.value(
      "--hair", options.hair, "FILE",
      "Hair in place of a style: a hair mesh (OBJ, one group a layer), curves (.hair, .abc, .usda, .tfx, .ply), or "
      "strips and tubes (.obj, .fbx, .glb, .gltf, .vrm)");
  group.value("--mends", options.mends, "TEXT", kMendsHelp);
  group.flag("--reverse-faces", options.reverse_faces,
             "Turn round the faces of a hair mesh file that is wound inwards");
  group
      .value("--fit", options.fit, "on|off",
             "Whether unit, axes and size of a hair mesh file are inferred where its roots are far from the scalp (on)")
      ->check(oneOf({"on", "off"}));
  group.value("--motion", options.motion, "FILE", "Motion or body: BVH, glTF, FBX, OBJ, or ARCSim .mot with --parts");
  group.value("--body", options.body, "TEXT",
              "Of a body without bones, in place of what is inferred: \"unit=cm up=z face=-x\", or some of that");
  group.value("--parts", options.parts, "DIR", "Folder of body0000.obj ... for a .mot motion");
  group.value("--clip", options.clip, "NAME", "Clip of a motion file that holds several");
  group.value("--preset", options.preset, "NAME", "Preset by name or file");
  group.value("--environment", options.environment, "FILE.hdr",
              "Light by a panorama (Radiance picture, twice as wide as high, its middle in front of the figure) in "
              "place of the scene's; the backdrop stays");
  group.values("--set", unchecked.sets, "NAME=VALUE", "Set a parameter of the tables; may be given many times");
  group.value(
      "--solver", options.solver, "NAME",
      "default, or paper: all of the published setting, as --preset paper: one linearized step of 1/60 s by "
      "block-diagonal PCG without safety nets (--set solver=paper leaves integrator and time step as they are)");
  group
      .value("--collider", unchecked.collider, "NAME",
             "What the hair collides with: ellipsoids fitted to the body, or signed distances of its skin (sdf)")
      ->check(oneOf(choicesOf("collider")));
  group.values(
      "--pin", options.pins, "JSON",
      "Hold a vertex of the hair, for instance {\"column\": 3, \"to\": \"scalp\"}; keys as in a scene's \"pins\"");
  group.value("--tie", options.tie, "NAME|JSON",
              "Tie the hair: back, high, low, left, right, two, plait, plaits, bun, buns, none, or JSON as a scene's "
              "\"ties\"");
  group.values(
      "--attach", options.attachments, "FILE@JOINT",
      "Wear a mesh that the hair collides with (hat, glasses, collar; OBJ, FBX, glTF): a joint's name, or head, "
      "neck, chest; JSON as in a scene's \"attachments\"; none; may be given many times");
  group.values(
      "--map", options.maps, "FIELD=FILE",
      "Paint stiffness, length, density, mass, bend, width, clump, curl, frizz, color, roughness or damping: a PNG of "
      "the head unrolled, its front in the middle, white for the parameter's own value, or a mesh of the head with "
      "coloured vertices (OBJ, PLY, glTF, FBX); may be given many times");
  group.values("--curve", options.curves, "FIELD=SHARES",
               "Shares from root to tip of what --map paints, but length, density and frizz, with commas: "
               "stiffness=1,0.5,0.2, or color=#ffffff,#a04020; may be given many times");
  group.values("--skip", options.skips, "NAME=on|off",
               "Switch a skip of the table, or all=off; may be given many times; --skips lists them");
  group.flag("--skips", unchecked.list_skips, "Print the table of skips and end");
  group.flag("--parameters", unchecked.list_parameters, "Print the parameter tables and end");
}

void addPlaybackOptions(CLI::App& parser, Options& options) {
  OptionGroup group{parser, "Playback"};
  group.value("--speed", options.speed, "X", "Playback speed of the motion, 0 to 100")
      ->check(within(0, kFastestPlayback));
  group.value("--fps", options.fps, "N", "Frames per second of a headless run")
      ->check(within(kSlowestFps, kFastestFps));
  group.value("--start", options.start, "S", "Where in the clip to begin, seconds")->check(within(0, 1e5));
  group
      .value("--budget-ms", options.budget_ms, "X",
             "Hold the simulation to so many milliseconds a frame: integrator, time step and tolerance are then "
             "chosen by the governor; 0: off")
      ->check(within(0, kLargestBudget));
  group
      .value("--draw-budget-ms", options.draw_budget_ms, "X",
             "Hold the drawing of a frame to so many milliseconds, measured: strands and segments are then thinned by "
             "the drawing governor, and pictures do not repeat to the bit; 0: off")
      ->check(within(0, kLargestBudget));
  group
      .value("--deadline-ms", options.deadline_ms, "X",
             "Let the simulation of no frame take more than so many milliseconds, by counted work: steps, iterations "
             "and corrections beyond are left out, but for what contacts need; 0: no deadline")
      ->check(within(0, kLargestBudget));
  group
      .value("--loop", options.loop, "NAME",
             "At the clip's end: go-on (from where the figure is), in-place, stop, none (begin again without a blend), "
             "or auto: whichever of the first two suits the clip")
      ->check(oneOf(std::vector<std::string>(kLoopNames.begin(), kLoopNames.end())));
}

void addPictureOptions(CLI::App& parser, Options& options, Unchecked& unchecked) {
  OptionGroup group{parser, "Picture"};
  group.value("--size", unchecked.size, "WxH", "Picture or window size in pixels, for instance 1280x720");
  group.value("--camera", options.camera, "VIEW",
              "front, three-quarter, side, back, top, or eye and target in metres: ex,ey,ez,tx,ty,tz");
  group.value("--framing", options.framing, "NAME", "How much is in the picture: head, bust or figure")
      ->check(oneOf({"head", "bust", "figure"}));
  group.value("--turntable", options.turntable, "X", "Degrees a second that the camera goes round the figure (0)")
      ->check(within(-360, 360));
  group.value("--strands", options.strands, "N", "Strands to draw over a whole head")
      ->check(within(0, findHairField("strands")->maximum));
  group
      .value("--strand-path", options.strand_path, "NAME",
             "What draws strands: geometry, compute, software, or auto: what suits the driver (auto)")
      ->check(oneOf({"geometry", "compute", "software", "auto"}));
  group.value("--debug", options.debug, "LIST",
              "Debug views, comma separated: mesh, external, tets, ellipsoids, contacts, velocities, pins");
  group.value("--compare", options.compare, "WITH",
              "Simulate beside it the same with a preset, a scene, a hair file or NAME=VALUE,... and show both; the "
              "summary says by how many millimetres and milliseconds they differ");
  group
      .value("--compare-view", options.compare_view, "NAME", "split by a line, or side by side: split or side (split)")
      ->check(oneOf({"split", "side"}));
}

void addRunOptions(CLI::App& parser, Options& options) {
  OptionGroup group{parser, "Running"};
  group.flag("--headless", options.headless, "No window: render frames to PNG files (EGL, needs no display)");
  group.value("--frames", options.frames, "N", "Frames of a headless run (120); a window ends after as many")
      ->check(within(1, kMaxFrames));
  group.value("--out", options.out, "DIR", "Folder for headless frames (frames)");
  group.flag("--no-images", options.no_images, "Headless: simulate only, create no OpenGL context");
  group.flag("--gl-debug", options.gl_debug,
             "Headless: let the driver check every OpenGL call (KHR_debug); exit code 1 when it has anything to say");
  group.value("--report", options.report, "FILE.json", "Write timings per stage and counters of every frame as JSON");
  group.value("--record", options.record, "FILE", "Write the run's inputs, so that --replay repeats it to the bit");
  group.value("--write-hair", options.write_hair, "FILE.obj", "Write the hair mesh that is shown as OBJ and end");
  group.value("--replay", options.replay, "FILE",
              "Repeat a recorded run; exit code 1 when it ends in another state. Without a window pictures are kept "
              "with --out, --video or --screenshot alone");
  group.value("--save-state", options.save_state, "FILE",
              "Write the state after the last frame (of every character: motion, hair, sleep, level of detail)");
  group.value("--save-state-at", options.save_state_at, "N", "Write it after so many frames instead; the run goes on")
      ->check(within(1, kMaxFrames));
  group.value(
      "--load-state", options.load_state, "FILE",
      "Go on from a saved state, or the last of a cache: the same scene and options simulate on to the bit, with the "
      "next frame's number; pictures of small figures differ as far as skips may");
  group.value(
      "--cache", options.cache, "FILE.hairmesh",
      "Without a window: keep every frame of the run; dropped on the window, its timeline shows them to and fro");
  group.value("--video", options.video, "FILE.mp4",
              "Without a window: a film of the frames, by ffmpeg where it is installed; PNG files as well with --out");
  group.value("--screenshot", options.screenshot, "FILE.png",
              "Write the last frame, panels included, when the run ends");
  group.value("--panel", options.panel, "NAME", "Tab that is open at first: simulation, motion, hair, look or debug")
      ->check(oneOf({"simulation", "motion", "hair", "look", "debug"}));
  group.value("--ui-scale", options.ui_scale, "X", "Size of texts and panels, 0.5 to 3")->check(within(0.5, 3));
  group.flag("--hide-panels", options.hide_panels, "Start the window without panels");
  parser.set_version_flag("--version", "hairmesh 0.1")->group(group.heading);
}

void addExportOptions(CLI::App& parser, Options& options, Unchecked& unchecked) {
  OptionGroup group{parser, "Export"};
  ExportSpec& spec = options.hair_export;
  group.value(
      "--export", spec.file, "FILE",
      "Without a window: write the simulated hair: .abc or .usda (a clip), .hair, .ply or .tfx (a file a frame, its "
      "number before the dot), .glb (the hair mesh, or cards, with a morph target a frame)");
  group
      .value("--export-what", unchecked.export_what, "NAME",
             "strands as drawn, guides (the hair mesh's columns), or of .glb alone mesh (its default) or cards")
      ->check(oneOf({"strands", "guides", "mesh", "cards"}));
  group.value("--export-points", spec.points, "N", "Points a strand, evenly from root to tip (as drawn)")
      ->check(within(2, kMaxExportPoints));
  group.value("--export-frames", unchecked.export_frames, "A-B", "Frames of the run, from 0; N: no numbers (all)");
  group.value("--export-every", spec.every, "N", "Every nth of them (1)")->check(within(1, kMaxFrames));
  group.value("--export-samples", spec.samples, "N", "Moments a frame, for motion blur: .abc, .usda, .glb (1)")
      ->check(within(1, kMaxExportSamples));
  group.value("--export-shutter", spec.shutter, "X", "Of a frame's length, from its first moment to its last (0.5)")
      ->check(within(0.01, 1));
  group.value("--export-unit", unchecked.export_unit, "NAME", "Unit of the file's numbers: m, cm, mm or in (m)")
      ->check(oneOf({"m", "cm", "mm", "in"}));
}

// "12-47", "12-" or "12".
bool parseFrames(const std::string& text, ExportSpec& spec) {
  const std::size_t dash = text.find('-');
  double first = 0, last = -1;
  if (!sim::parseNumber(text.substr(0, dash), first)) return false;
  if (dash == std::string::npos) last = first;
  if (dash != std::string::npos && dash + 1 < text.size() && !sim::parseNumber(text.substr(dash + 1), last))
    return false;
  if (first != std::floor(first) || last != std::floor(last)) return false;
  if (!(first >= 0 && first <= kMaxFrames && last <= kMaxFrames) || (last >= 0 && last < first)) return false;
  spec.first = static_cast<int>(first), spec.last = static_cast<int>(last);
  spec.range = dash != std::string::npos;
  return true;
}

// Of a run that draws only when told to: an export, a cache.
bool picturesAsked(const Options& options) {
  return options.headless || options.out_given || !options.screenshot.empty();
}

// Throws UsageError for what the export cannot do.
void finishExport(const Unchecked& unchecked, Options& options) {
  ExportSpec& spec = options.hair_export;
  if (spec.file.empty()) {
    if (!(unchecked.export_what + unchecked.export_frames + unchecked.export_unit).empty() || spec.samples > 1 ||
        spec.every > 1 || spec.points > 0)
      throw UsageError("--export-... says how; add --export FILE");
    return;
  }
  const bool mesh = std::filesystem::path(spec.file).extension() == ".glb";
  if (!mesh && !isGroomOutput(spec.file))
    throw UsageError("--export cannot be '" + spec.file + "'; name it .abc, .usda, .hair, .ply, .tfx or .glb");
  const bool cards = unchecked.export_what == "cards";
  if (mesh != (cards || unchecked.export_what == "mesh") && !(mesh && unchecked.export_what.empty()))
    throw UsageError("a .glb file takes mesh or cards, and these go into a .glb file alone; glTF has no curves");
  spec.what = cards                               ? ExportWhat::kCards
              : mesh                              ? ExportWhat::kMesh
              : unchecked.export_what == "guides" ? ExportWhat::kGuides
                                                  : ExportWhat::kStrands;
  if (!unchecked.export_frames.empty() && !parseFrames(unchecked.export_frames, spec))
    throw UsageError("--export-frames cannot be '" + unchecked.export_frames +
                     "'; write FIRST-LAST, for instance 0-119");
  if (spec.what != ExportWhat::kStrands && spec.points > 0)
    throw UsageError(
        std::string("--export-points goes with strands; ") +
        (mesh
             ? "a .glb file has the hair mesh or cards: leave it out, or name the file .abc, .usda, .hair, .ply or .tfx"
             : "guides have a point a layer: leave it out"));
  if (spec.file.ends_with(".tfx") && spec.points > 0 && !isTfxPoints(static_cast<std::size_t>(spec.points)))
    throw UsageError("--export-points cannot be " + std::to_string(spec.points) +
                     " for a .tfx file; give 4, 8, 16, 32 or 64");
  if (spec.samples == 1 && spec.shutter != ExportSpec{}.shutter)
    throw UsageError("--export-shutter would do nothing: a frame has one moment; add --export-samples 3");
  if (spec.samples > 1 && !takesClip(spec.file))
    throw UsageError("--export-samples needs a file that takes a clip; name it .abc, .usda or .glb");
  if (spec.samples > 1 && !(options.record + options.replay + options.save_state + options.load_state).empty())
    throw UsageError("--export-samples does not go with recordings and states, whose frames have one moment");
  if (unchecked.export_unit == "cm") spec.unit = 0.01;
  if (unchecked.export_unit == "mm") spec.unit = 0.001;
  if (unchecked.export_unit == "in") spec.unit = 0.0254;
  if (!picturesAsked(options)) options.no_images = true;
  options.headless = true;
}

// Throws UsageError for what needs pictures.
void refuseBesideNoImages(const Options& options) {
  if (!options.no_images) return;
  const std::pair<const char*, bool> given[] = {{"--screenshot", !options.screenshot.empty()},
                                                {"--video", !options.video.empty()},
                                                {"--out", options.out_given},
                                                {"--turntable", options.turntable != 0},
                                                {"--draw-budget-ms", options.draw_budget_ms > 0}};
  for (const auto& [name, is_given] : given)
    if (is_given)
      throw UsageError(std::string("--no-images draws nothing that ") + name + " could use; leave one of them out");
}

// A run without a window leaves frames behind where they are what it was started for: told by --out, or by nothing else
// that it could be for.
void choosePictures(Options& options) {
  const bool others = !(options.video + options.screenshot + options.replay).empty();
  options.keep_frames = !options.no_images && (options.out_given || !others);
  const bool drawn = options.keep_frames || options.gl_debug || !(options.video + options.screenshot).empty();
  if (options.headless && !drawn) options.no_images = true;
}

// Checks what the parser cannot and moves it into the options. Throws UsageError.
void finish(const Unchecked& unchecked, Options& options) {
  options.size_given = !unchecked.size.empty();
  if (options.size_given && !parseSize(unchecked.size, options.width, options.height)) {
    throw UsageError("--size cannot be '" + unchecked.size + "'; write WIDTHxHEIGHT with sides from " +
                     std::to_string(kSmallestSide) + " to " + std::to_string(kLargestSide) + ", for instance 1280x720");
  }
  if (!unchecked.collider.empty()) options.set.emplace_back("collider", unchecked.collider);
  for (const std::string& text : unchecked.sets) {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos || equals == 0) {
      throw UsageError("--set cannot be '" + text + "'; write NAME=VALUE, for instance --set friction=0.5");
    }
    options.set.emplace_back(text.substr(0, equals), text.substr(equals + 1));
  }
  if (!options.compare_view.empty() && options.compare.empty()) {
    throw UsageError("--compare-view says how; add --compare WITH");
  }
  refuseBesideNoImages(options);
  expectEnding("--video", options.video, {".mp4", ".webm", ".mkv", ".mov", ".avi", ".gif"});
  expectEnding("--screenshot", options.screenshot, {".png"});
  expectEnding("--write-hair", options.write_hair, {".obj"});
  expectEnding("--cache", options.cache, {".hairmesh"});
  if (!options.video.empty()) options.headless = true;
  if (!options.load_state.empty() && !(options.record + options.replay).empty()) {
    throw UsageError("--load-state does not go with --record and --replay, which begin with the scene; leave one out");
  }
  if (!options.load_state.empty() && options.start >= 0) {
    throw UsageError(
        "--load-state goes on at the moment that was saved, to which --start would do nothing; leave one out");
  }
  if (options.save_state_at > options.frames && options.replay.empty()) {
    throw UsageError("--save-state-at " + std::to_string(options.save_state_at) + " lies beyond the run's " +
                     std::to_string(options.frames) + " frames; give a smaller number, or more --frames");
  }
  if (options.save_state_at > 0 && options.save_state.empty()) {
    throw UsageError("--save-state-at says when; add --save-state FILE");
  }
  if (!options.cache.empty() && !picturesAsked(options)) options.no_images = true;
  if (!options.cache.empty() || options.no_images) options.headless = true;
  finishExport(unchecked, options);
  refuseOutputsOverFiles(options);
  choosePictures(options);
  if (!options.parts.empty() && options.motion.empty() && options.scene.empty()) {
    throw UsageError("--parts needs a .mot motion; add --motion FILE.mot");
  }
}

}  // namespace

Options withoutWindow(Options options) {
  options.headless = true;
  choosePictures(options);
  return options;
}

namespace {

// A replay has its scene and its frames from the recording: what would choose others is refused rather than left
// unused.
void refuseBesideReplay(const CLI::App& parser, const Options& options) {
  if (options.replay.empty()) return;
  std::string unused;
  for (const CLI::Option* option : parser.get_options()) {
    const std::string name = option->get_single_name(), group = option->get_group();
    const bool of_scene = group == "What is shown" || group == "Playback" || name == "scene" || name == "frames" ||
                          name == "camera" || name == "framing" || name == "turntable" || name == "strands" ||
                          name == "strand-path" || name == "write-hair";
    if (option->count() > 0 && of_scene) unused += (unused.empty() ? "" : ", ") + option->get_name();
  }
  if (!unused.empty()) {
    throw UsageError("--replay plays the recorded scene and its frames, to which " + unused +
                     " would do nothing; leave out what stands beside it, or record anew");
  }
}

}  // namespace

bool parseOptions(int argc, char** argv, Options& options, int& exit_code) {
  CLI::App parser{"Real-time hair mesh simulation and rendering (Wu and Yuksel 2016), in a window or headless."};
  parser.name("hairmesh");
  parser.footer(kExamples);
  parser.get_formatter()->column_width(34);
  // So that ./run and scripts can put their own before a person's.
  parser.option_defaults()->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
  parser
      .add_option("scene", options.scene, "Scene, preset, motion or hair mesh; without one the default scene is shown")
      ->option_text("[FILE]")
      ->multi_option_policy(CLI::MultiOptionPolicy::Throw);
  Unchecked unchecked;
  addSceneOptions(parser, options, unchecked);
  addPlaybackOptions(parser, options);
  addPictureOptions(parser, options, unchecked);
  addRunOptions(parser, options);
  addExportOptions(parser, options, unchecked);
  exit_code = kExitFine;
  try {
    parser.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success)) {
      exit_code = parser.exit(error);
      return false;
    }
    throw UsageError(parseFault(error, parser, "name others by --motion, --hair, --preset"));
  }
  if (unchecked.list_parameters || unchecked.list_skips) {
    std::cout << (unchecked.list_parameters ? parameterTable() : skipTableText());
    return false;
  }
  options.frames_given = parser.count("--frames") > 0;
  options.out_given = parser.count("--out") > 0;
  refuseBesideReplay(parser, options);
  finish(unchecked, options);
  return true;
}

}  // namespace app
