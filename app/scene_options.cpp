#include <filesystem>

#include "app/data_path.h"
#include "app/errors.h"
#include "app/options.h"
#include "app/presets.h"
#include "app/scene_file.h"
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
  camera.eye = Vec3(numbers[0], numbers[1], numbers[2]);
  camera.target = Vec3(numbers[3], numbers[4], numbers[5]);
  const double reach = std::max(camera.eye->norm(), camera.target->norm());
  if ((*camera.eye - *camera.target).norm() < 1e-3 || reach > 1e4) {
    throw UsageError("--camera cannot be '" + text + "'; keep eye and target apart and within 10 km");
  }
}

void checkHairAndStyle(const Options& options) {
  if (!options.hair.empty() && !options.style.empty()) {
    throw UsageError("--hair and --style exclude each other; give one of them");
  }
}

}  // namespace

Scene sceneFromOptions(const Options& options) {
  checkHairAndStyle(options);
  Scene scene =
      loadScene(options.scene.empty() ? dataPath("assets/scenes/default.json") : findFile(options.scene, "", "scenes"));
  std::vector<CharacterLook*> looks;
  for (CharacterSpec& spec : scene.characters) {
    if (!options.style.empty()) {
      spec.style = *parseStyle(options.style);
      spec.hair.clear();
    }
    if (!options.resolution.empty()) spec.resolution = *parseResolution(options.resolution);
    if (!options.hair.empty()) spec.hair = findFile(options.hair, "", "hair");
    if (!options.motion.empty()) {
      spec.motion = findFile(options.motion, "", "clips");
      spec.clip.clear();
      spec.parts.clear();
      spec.clip_offset = 0;
    }
    if (!options.parts.empty()) spec.parts = findFile(options.parts, "", "clips");
    if (!options.clip.empty()) spec.clip = options.clip;
    if (options.start >= 0) spec.clip_offset = options.start;
    if (options.travel) spec.in_place = false;
    looks.push_back(&spec.look);
  }
  if (!options.preset.empty()) loadPreset(presetFile(options.preset, ""), {&scene.sim, &scene.look, looks});
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
  if (options.strand_path == "pulling") scene.look.view.strand_path = render::StrandPath::kPulling;
  if (options.strand_path == "geometry") scene.look.view.strand_path = render::StrandPath::kGeometry;
  if (options.speed >= 0) scene.playback.speed = options.speed;
  if (options.budget_ms >= 0) scene.playback.budget_ms = options.budget_ms;
  if (options.fps > 0) scene.playback.fps = options.fps;
  if (!options.camera.empty()) setCamera(options.camera, scene.camera);
  if (!options.framing.empty()) scene.camera.framing = options.framing;
  return scene;
}

}  // namespace app
