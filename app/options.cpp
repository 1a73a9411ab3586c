#include "app/options.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <iostream>

#include "app/errors.h"
#include "app/look_params.h"
#include "app/parameter_table.h"
#include "app/scene_file.h"
#include "app/skips.h"
#include "sim/field_text.h"

namespace app {

namespace {

std::vector<std::string> choicesOf(const char* parameter) {
  const auto names = sim::findParam(parameter)->choices;
  return {names.begin(), names.end()};
}

constexpr int kSmallestSide = 16, kLargestSide = 8192, kMostFrames = 1000000;

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

// CLI::Range lets NaN through, because NaN is neither below nor above.
CLI::Validator within(double low, double high) {
  const std::string range = sim::numberText(low) + " to " + sim::numberText(high);
  return CLI::Validator(
      [=](std::string& text) {
        double value = 0;
        const bool fine = sim::parseNumber(text, value) && value >= low && value <= high;
        return fine ? std::string() : "'" + text.substr(0, 40) + "' is not a number from " + range;
      },
      "");
}

const char* const kExamples = R"(Examples:
  hairmesh                                        the default scene in a window
  hairmesh assets/scenes/head_shake.json          another scene
  hairmesh --style long --resolution high --motion walk.bvh
  hairmesh --headless --frames 240 --size 1280x720 --out frames --style short
  hairmesh --headless --frames 600 --no-images --report timings.json
  hairmesh --motion dance.mot --parts female-objs --speed 2 --set friction=0.6 --set solver=paper

Exit codes: 0 fine, 1 OpenGL or numerical fault, 2 usage, 3 no OpenGL context, 4 a file that cannot be used.)";

}  // namespace

bool parseOptions(int argc, char** argv, Options& options, int& exit_code) {
  CLI::App parser{"Real-time hair mesh simulation and rendering (Wu and Yuksel 2016), in a window or headless."};
  parser.name("hairmesh");
  parser.footer(kExamples);
  parser.get_formatter()->column_width(34);
  // The last of two wins, so that ./run and scripts can put their own before a person's.
  parser.option_defaults()->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
  std::string size;
  std::vector<std::string> sets;
  std::string solver, collider;
  bool list_parameters = false, list_skips = false;

  parser.add_option("scene", options.scene, "Scene file (JSON); without one the default scene is shown")
      ->option_text("[SCENE.json]")
      ->multi_option_policy(CLI::MultiOptionPolicy::Throw);

  const char* what = "What is shown";
  parser.add_option("--style", options.style, "Hair style: short, shoulder or long")
      ->group(what)
      ->option_text("NAME")
      ->check(CLI::IsMember({"short", "shoulder", "long"}));
  parser.add_option("--resolution", options.resolution, "Hair mesh resolution: low, medium, high or ultra")
      ->group(what)
      ->option_text("NAME")
      ->check(CLI::IsMember({"low", "medium", "high", "ultra"}));
  parser.add_option("--hair", options.hair, "Hair mesh file (OBJ, one group a layer) in place of a style")
      ->group(what)
      ->option_text("FILE");
  parser.add_option("--motion", options.motion, "Motion: BVH, glTF, FBX, or ARCSim .mot with --parts")
      ->group(what)
      ->option_text("FILE");
  parser.add_option("--parts", options.parts, "Folder of body0000.obj ... for a .mot motion")
      ->group(what)
      ->option_text("DIR");
  parser.add_option("--clip", options.clip, "Clip of a motion file that holds several")
      ->group(what)
      ->option_text("NAME");
  parser.add_option("--preset", options.preset, "Preset by name or file")->group(what)->option_text("NAME");
  parser.add_option("--set", sets, "Set a parameter of the tables; may be given many times")
      ->group(what)
      ->option_text("NAME=VALUE")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->allow_extra_args(false);
  parser
      .add_option("--solver", solver,
                  "Linear solver; paper: the paper's own setting, one linearized step of 1/60 s by block-diagonal PCG")
      ->group(what)
      ->option_text("NAME")
      ->check(CLI::IsMember(choicesOf("solver")));
  parser
      .add_option("--collider", collider,
                  "What the hair collides with: ellipsoids fitted to the body, or signed distances of its skin (sdf)")
      ->group(what)
      ->option_text("NAME")
      ->check(CLI::IsMember({"ellipsoids", "sdf"}));
  parser
      .add_option("--skip", options.skips,
                  "Switch a skip of the ledger, or all=off; may be given many times; --skips lists them")
      ->group(what)
      ->option_text("NAME=on|off")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->allow_extra_args(false);
  parser.add_flag("--skips", list_skips, "Print the ledger of skips and end")->group(what);
  parser.add_flag("--parameters", list_parameters, "Print the parameter tables and end")->group(what);

  const char* motion = "Playback";
  parser.add_option("--speed", options.speed, "Playback speed of the motion, 0 to 100")
      ->group(motion)
      ->option_text("X")
      ->check(within(0, kFastestPlayback));
  parser.add_option("--fps", options.fps, "Frames per second of a headless run")
      ->group(motion)
      ->option_text("N")
      ->check(within(kSlowestFps, kFastestFps));
  parser.add_option("--start", options.start, "Where in the clip to begin, seconds")
      ->group(motion)
      ->option_text("S")
      ->check(within(0, 1e5));
  parser
      .add_option("--budget-ms", options.budget_ms,
                  "Hold the simulation to so many milliseconds a frame: integrator, time step and tolerance are then "
                  "chosen by the governor; 0: off")
      ->group(motion)
      ->option_text("X")
      ->check(within(0, kLargestBudget));
  parser.add_flag("--travel", options.travel, "Let the figure travel over the ground as the clip does")->group(motion);

  const char* picture = "Picture";
  parser.add_option("--size", size, "Picture or window size in pixels, for instance 1280x720")
      ->group(picture)
      ->option_text("WxH");
  parser
      .add_option("--camera", options.camera,
                  "front, three-quarter, side, back, top, or eye and target in metres: ex,ey,ez,tx,ty,tz")
      ->group(picture)
      ->option_text("VIEW");
  parser.add_option("--framing", options.framing, "How much is in the picture: head, bust or figure")
      ->group(picture)
      ->option_text("NAME")
      ->check(CLI::IsMember({"head", "bust", "figure"}));
  parser.add_option("--strands", options.strands, "Strands to draw over a whole head")
      ->group(picture)
      ->option_text("N")
      ->check(within(0, findHairField("strands")->maximum));
  parser.add_option("--strand-path", options.strand_path, "Shader stage that grows strands: geometry or pulling")
      ->group(picture)
      ->option_text("NAME")
      ->check(CLI::IsMember({"geometry", "pulling"}));
  parser
      .add_option("--debug", options.debug,
                  "Debug views, comma separated: mesh, external, tets, ellipsoids, contacts, velocities")
      ->group(picture)
      ->option_text("LIST");

  const char* output = "Running";
  parser.add_flag("--headless", options.headless, "No window: render frames to PNG files (EGL, needs no display)")
      ->group(output);
  CLI::Option* frames =
      parser.add_option("--frames", options.frames, "Frames of a headless run (120); a window ends after as many")
          ->group(output)
          ->option_text("N")
          ->check(within(1, kMostFrames));
  parser.add_option("--out", options.out, "Folder for headless frames (frames)")->group(output)->option_text("DIR");
  parser.add_flag("--no-images", options.no_images, "Headless: simulate only, create no OpenGL context")->group(output);
  parser.add_option("--report", options.report, "Write timings per stage and counters of every frame as JSON")
      ->group(output)
      ->option_text("FILE.json");
  parser.add_option("--record", options.record, "Write the run's inputs, so that --replay repeats it to the bit")
      ->group(output)
      ->option_text("FILE");
  parser.add_option("--replay", options.replay, "Repeat a recorded run; exit code 1 when it ends in another state")
      ->group(output)
      ->option_text("FILE");
  parser.add_option("--screenshot", options.screenshot, "Write the last frame, panels included, when the run ends")
      ->group(output)
      ->option_text("FILE.png");
  parser.add_option("--panel", options.panel, "Tab that is open at first: simulation, motion, hair, look or debug")
      ->group(output)
      ->option_text("NAME")
      ->check(CLI::IsMember({"simulation", "motion", "hair", "look", "debug"}));
  parser.add_flag("--hide-panels", options.hide_panels, "Start the window without panels")->group(output);
  parser.set_version_flag("--version", "hairmesh 0.1")->group(output);

  try {
    parser.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success)) {
      exit_code = parser.exit(error);
      return false;
    }
    std::cerr << "hairmesh: " << error.what() << "; hairmesh --help lists the options\n";
    exit_code = kExitUsage;
    return false;
  }
  const auto fail = [&](const std::string& message) {
    std::cerr << "hairmesh: " << message << "\n";
    exit_code = kExitUsage;
    return false;
  };
  if (list_parameters || list_skips) {
    std::cout << (list_parameters ? parameterTable() : skipLedger());
    exit_code = kExitFine;
    return false;
  }
  options.frames_given = frames->count() > 0;
  options.size_given = !size.empty();
  if (options.size_given && !parseSize(size, options.width, options.height)) {
    return fail("--size cannot be '" + size + "'; write WIDTHxHEIGHT with sides from " + std::to_string(kSmallestSide) +
                " to " + std::to_string(kLargestSide) + ", for instance 1280x720");
  }
  if (!collider.empty()) options.set.emplace_back("collider", collider);
  // Before the sets, which may still turn a part of it.
  if (!solver.empty()) options.set.emplace_back("solver", solver);
  if (solver == "paper") {
    options.set.emplace_back("integrator", "linearized-euler");
    options.set.emplace_back("time_step", "0.016666666666666666");
  }
  for (const std::string& text : sets) {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos || equals == 0) {
      return fail("--set cannot be '" + text + "'; write NAME=VALUE, for instance --set friction=0.5");
    }
    options.set.emplace_back(text.substr(0, equals), text.substr(equals + 1));
  }
  if (!options.record.empty() && options.record == options.replay) {
    return fail("--record and --replay name one file; a recording cannot be read and written at once");
  }
  if (options.no_images && !options.headless) options.headless = true;
  if (!options.parts.empty() && options.motion.empty() && options.scene.empty()) {
    return fail("--parts needs a .mot motion; add --motion FILE.mot");
  }
  return true;
}

}  // namespace app
