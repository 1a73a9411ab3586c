#include <filesystem>
#include <utility>

#include "app/debug_option.h"
#include "app/files/data_path.h"
#include "app/files/errors.h"
#include "app/files/file_kind.h"
#include "app/files/presets.h"
#include "app/files/scene_file.h"
#include "app/files/told_body.h"
#include "app/groom/inspect/certain_mends.h"
#include "app/options.h"
#include "app/scene/comparison.h"
#include "app/scene/hair_from_file.h"
#include "app/scene/hairdo.h"
#include "app/scene/project.h"
#include "app/scene/view/environment_light.h"
#include "sim/field_text.h"

namespace app {

namespace {

// "front" or "ex,ey,ez,tx,ty,tz".
void setCamera(const std::string& text, CameraSpec& camera) {
  for (const std::string_view view : {"front", "three-quarter", "side", "back", "top"}) {
    if (text == view) {
      camera.view = text;
      camera.eye.reset();
      camera.target.reset();
      return;
    }
  }
  double numbers[6];
  std::size_t begin = 0;
  for (int i = 0; i < 6; ++i) {
    const std::size_t end = i < 5 ? text.find(',', begin) : text.size();
    if (end == std::string::npos || !sim::parseNumber(std::string_view(text).substr(begin, end - begin), numbers[i])) {
      throw UsageError("--camera cannot be '" + text +
                       "'; write front, three-quarter, side, back, top, or six numbers ex,ey,ez,tx,ty,tz");
    }
    begin = end + 1;
  }
  camera.of_head = false;
  camera.eye = Vec3(numbers[0], numbers[1], numbers[2]);
  camera.target = Vec3(numbers[3], numbers[4], numbers[5]);
  const double reach = std::max(camera.eye->norm(), camera.target->norm());
  if ((*camera.eye - *camera.target).norm() < 1e-3 || reach > 1e4) {
    throw UsageError("--camera cannot be '" + text + "'; keep eye and target apart and within 10 km");
  }
}

void fill(const char* option, std::string& value, const std::string& file) {
  if (!value.empty()) throw UsageError(file + " and " + option + " " + value + " exclude each other; give one of them");
  value = file;
}

void checkHairAndStyle(const Options& options) {
  if (!options.hair.empty() && !options.style.empty()) {
    throw UsageError("--hair and --style exclude each other; give one of them");
  }
  if (options.reverse_faces && options.hair.empty()) {
    throw UsageError("--reverse-faces is about a hair mesh file; add --hair FILE");
  }
  if (!options.mends.empty() && options.hair.empty()) throw UsageError("--mends is about a hair file; add --hair FILE");
  GroomMends mends;
  if (const std::string fault = readMends(options.mends, mends); !fault.empty()) throw UsageError("--mends: " + fault);
  ToldBody told;
  if (const std::string fault = readToldBody(options.body, told); !fault.empty()) throw UsageError("--body: " + fault);
}

// Reads what an option was given. A fault of the value is a mistake of the command line, one of a file that it names is
// that file's: both messages begin with the option.
template <class Read>
void readValue(const std::string& option, const Read& read) {
  try {
    read();
  } catch (const InputError& fault) {
    const std::string words = fault.what();
    if (!fault.of_file) throw UsageError(option + ": " + words);
    throw InputError(option, "", words.substr(0, words.find("; ")),
                     words.find("; ") == std::string::npos ? "" : words.substr(words.find("; ") + 2));
  }
}

// NAME and VALUE of "NAME=VALUE"; either is empty where it is missing.
std::pair<std::string, std::string> assigned(const std::string& text) {
  const std::size_t equals = std::min(text.find('='), text.size());
  return {text.substr(0, equals), text.substr(std::min(text.size(), equals + 1))};
}

void overrideFields(const Options& options, CharacterSpec& spec) {
  for (const std::string& text : options.maps) {
    const auto [field, file] = assigned(text);
    const std::string fault = field.empty() || file.empty()
                                  ? "write FIELD=FILE, for instance length=assets/maps/bob_length.png"
                                  : setMap(field, findFile(file, "", "maps"), spec.maps);
    if (!fault.empty()) throw UsageError("--map cannot be '" + text + "'; " + fault);
  }
  for (const std::string& text : options.curves) {
    const auto [field, shares] = assigned(text);
    if (field.empty() || shares.empty())
      throw UsageError("--curve cannot be '" + text +
                       "'; write FIELD=SHARES, for instance stiffness=1,0.5,0.2, or FIELD=none");
    readValue("--curve " + field, [&] { setCurve(field, shares, spec.curves); });
  }
}

void overrideCharacter(const Options& options, CharacterSpec& spec) {
  if (!options.style.empty()) {
    chooseStyle(options.style, spec);
  }
  if (!options.resolution.empty()) spec.resolution = *parseResolution(options.resolution);
  if (!options.hair.empty()) {
    chooseHair(foundFile(options.hair, "", "hair"), spec);
    spec.reverse_faces = options.reverse_faces;
    spec.mends = options.mends;
  }
  if (!options.fit.empty()) spec.fit = options.fit == "on";
  if (!options.motion.empty()) {
    spec.motion = foundFile(options.motion, "", "clips");
    spec.clip.clear();
    spec.parts.clear();
    spec.body.clear();
    spec.clip_offset = 0;
  }
  if (!options.body.empty()) spec.body = options.body;
  if (!options.parts.empty()) spec.parts = findFile(options.parts, "", "clips");
  if (!options.clip.empty()) spec.clip = options.clip;
  if (options.start >= 0) spec.clip_offset = options.start;
  if (!options.loop.empty()) spec.loop = *parseLoop(options.loop);
  overrideFields(options, spec);
  if (!options.tie.empty()) readValue("--tie", [&] { spec.ties = tiesFromText(options.tie); });
  for (const std::string& text : options.attachments) {
    std::vector<AttachmentSpec> given;
    readValue("--attach", [&] { given = attachmentsFromText(text); });
    if (given.empty()) spec.attachments.clear();
    spec.attachments.insert(spec.attachments.end(), given.begin(), given.end());
  }
  if (spec.attachments.size() > kMaxAttachments)
    throw UsageError("--attach: the figure would wear " + std::to_string(spec.attachments.size()) +
                     " things; at most " + std::to_string(kMaxAttachments) +
                     " are allowed, and --attach none takes off the scene's");
  for (const std::string& text : options.pins) {
    readValue("--pin", [&] { spec.pins.push_back(pinFromText(text)); });
    spec.pins.back().file = "--pin";  // for what only figure and hair can tell of it
  }
}

// A scene's name speaks of its motion: with another one it is another's.
void nameAfterMotion(const Options& options, Scene& scene) {
  if (options.motion.empty()) return;
  const std::string motion = std::filesystem::path(options.motion).stem().string();
  scene.name = options.scene.empty() ? motion : scene.name + ", with " + motion;
}

// A project's hair and motion are as they were left: options that would give others are refused.
void refuseBesideProject(const Options& options) {
  const std::pair<const char*, bool> given[] = {
      {"--style", !options.style.empty()},        {"--resolution", !options.resolution.empty()},
      {"--hair", !options.hair.empty()},          {"--fit", !options.fit.empty()},
      {"--motion", !options.motion.empty()},      {"--parts", !options.parts.empty()},
      {"--clip", !options.clip.empty()},          {"--start", options.start >= 0},
      {"--loop", !options.loop.empty()},          {"--tie", !options.tie.empty()},
      {"--attach", !options.attachments.empty()}, {"--pin", !options.pins.empty()},
      {"--map", !options.maps.empty()},           {"--curve", !options.curves.empty()}};
  std::string others;
  for (const auto& [name, is_given] : given)
    if (is_given) others += (others.empty() ? "" : ", ") + std::string(name);
  if (!others.empty())
    throw UsageError(options.project + " is a project, which brings its own hair and motion; leave out " + others);
}

// What the options start from.
Scene firstScene(const Options& options) {
  if (options.project.empty())
    return loadScene(options.scene.empty() ? dataPath("assets/scenes/default.json")
                                           : findFile(options.scene, "", "scenes"));
  refuseBesideProject(options);
  return projectScene(options.project);
}

// "paper" is the preset of that name.
void chooseSolver(const std::string& name, sim::SimParams& params) {
  if (name.empty()) return;
  if (const sim::ParamText answer = sim::setParam(params, "solver", name); !answer.ok)
    throw UsageError("--solver: " + answer.fault);
  SceneLook look;
  if (params.solver == sim::Solver::kPaper) loadPreset(presetFile(name, ""), {&params, &look, {}});
}

}  // namespace

Options sortedOut(Options options) {
  if (!options.replay.empty()) requireRecording(options.replay);
  if (options.scene.empty()) return options;
  std::string file = options.scene;
  for (const char* kind : {"hair", "clips", "presets", "scenes"}) file = findFile(file, "", kind);
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored))
    throw InputError(options.scene, "", "there is no such file", missingMend(options.scene));
  options.scene.clear();
  switch (fileKind(file)) {
    case FileKind::kScene:
      options.scene = file;
      break;
    case FileKind::kPreset:
      fill("--preset", options.preset, file);
      break;
    case FileKind::kRigidMotion:
      if (options.parts.empty()) options.parts = partsBeside(file);
      [[fallthrough]];
    case FileKind::kMotion:
      fill("--motion", options.motion, file);
      break;
    case FileKind::kHairMesh:
      fill("--hair", options.hair, file);
      break;
    case FileKind::kAttachment:
      options.attachments.push_back(file);
      break;
    case FileKind::kProject:
      options.project = file;
      break;
    case FileKind::kEnvironment:
      fill("--environment", options.environment, file);
      break;
    case FileKind::kCache:
      throw UsageError(file + " is a cache of simulated hair; name its scene, and it with --load-state");
    case FileKind::kState:
      throw UsageError(file + " is a saved state; name its scene, and it with --load-state");
  }
  return options;
}

Scene sceneFromOptions(const Options& given) {
  const Options options = sortedOut(given);
  checkHairAndStyle(options);
  Scene scene = firstScene(options);
  std::vector<CharacterLook*> looks;
  for (CharacterSpec& spec : scene.characters) {
    overrideCharacter(options, spec);
    looks.push_back(&spec.look);
  }
  nameAfterMotion(options, scene);
  if (!options.preset.empty()) {
    std::string file;
    readValue("--preset", [&] { file = presetFile(options.preset, ""); });
    loadPreset(file, {&scene.sim, &scene.look, looks});
    scene.preset = file;
  }
  if (!options.environment.empty()) setEnvironment(options.environment, scene);
  // Before the sets: --set overrides a part of what --solver sets.
  chooseSolver(options.solver, scene.sim);
  for (const auto& [name, text] : options.set) {
    if (std::string fault = setAnywhere(name, text, scene.sim, looks, scene.look); !fault.empty()) {
      throw UsageError("--set " + name + ": " + fault);
    }
  }
  for (const std::string& text : options.skips) {
    if (const std::string fault = setSkip(text, scene.skips); !fault.empty()) throw UsageError("--skip " + fault);
  }
  if (options.strands >= 0) {
    for (CharacterLook* look : looks) look->strands = options.strands;
  }
  if (!options.strand_path.empty()) setAnywhere("strand_path", options.strand_path, scene.sim, looks, scene.look);
  if (options.speed >= 0) scene.playback.speed = options.speed;
  if (options.budget_ms >= 0) scene.playback.budget_ms = options.budget_ms;
  if (options.draw_budget_ms >= 0) scene.playback.draw_budget_ms = options.draw_budget_ms;
  if (options.deadline_ms >= 0) scene.playback.deadline_ms = options.deadline_ms;
  if (options.fps > 0) scene.playback.fps = options.fps;
  if (!options.camera.empty()) setCamera(options.camera, scene.camera);
  if (!options.framing.empty()) scene.camera.framing = options.framing;
  DebugViews checked;
  setDebugViews(options.debug, checked);
  if (!options.compare.empty()) readValue("--compare", [&] { comparedScene(options.compare, scene); });
  if (!(options.project.empty() || options.record.empty()) &&
      writeScene(scene) != writeScene(projectScene(options.project)))
    throw UsageError("--record takes " + options.project +
                     " as it was saved: leave out the options that change it, or save it with the changes first");
  return scene;
}

}  // namespace app
