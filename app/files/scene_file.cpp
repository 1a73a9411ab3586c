#include "app/files/scene_file.h"

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "app/files/data_path.h"
#include "app/files/json_kind.h"
#include "app/files/json_reader.h"
#include "app/files/presets.h"
#include "app/files/text_file.h"
#include "app/files/told_body.h"
#include "app/groom/inspect/certain_mends.h"

namespace app {

namespace {

using nlohmann::json;

constexpr std::size_t kLargestScene = std::size_t{16} << 20;
constexpr double kFarthestPlace = 1000;  // m
constexpr double kTurn = 2 * 3.14159265358979323846;

Vec3 toVec3(const std::array<double, 3>& values) {
  return {values[0], values[1], values[2]};
}
json fromVec3(const Vec3& v) {
  return json{v.x(), v.y(), v.z()};
}

std::string readFileName(const JsonPlace& place, const std::string& kind) {
  const std::string name = place.text();
  if (name.empty()) return name;
  const std::string file = findFile(name, place.file(), kind);
  const std::string beside = (std::filesystem::path(place.file()).parent_path() / name).string();
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored))
    place.refuse("names '" + name.substr(0, 200) + "', which is not there",
                 missingMend(beside) + "; it is looked for beside the scene");
  return file;
}

FieldFiles readMaps(const JsonPlace& place) {
  place.expectObject(kFieldNames);
  FieldFiles maps;
  for (const std::string_view name : kFieldNames) {
    if (!place.has(std::string(name))) continue;
    const JsonPlace picture = place.at(std::string(name));
    const std::string text = picture.text();
    *findMap(name, maps) = isPictureText(text) ? text : readFileName(picture, "maps");
  }
  return maps;
}

json writeMaps(FieldFiles maps) {
  json written = json::object();
  for (const std::string_view name : kFieldNames) written[std::string(name)] = *findMap(name, maps);
  return written;
}

// Hairdos, which `--style` takes too, are scenes.
Style readStyle(const JsonPlace& place) {
  const std::string name = place.value().is_string() ? place.text() : "";
  const std::string scene = "assets/scenes/" + name + ".json";
  std::error_code ignored;
  if (!parseStyle(name) && name.size() < 64 && name.find_first_of("./\\") == std::string::npos &&
      std::filesystem::is_regular_file(dataPath(scene), ignored))
    place.refuse("is \"" + name + "\", a scene of its own", "open " + scene + ", or take its character");
  return *parseStyle(place.choice(kStyleNames));
}

CharacterSpec readCharacter(const JsonPlace& place, const CharacterLook& look) {
  expectKeys(place, kCharacterKeys);
  CharacterSpec spec;
  spec.look = look;
  spec.motion =
      place.has("motion") ? readFileName(place.at("motion"), "clips") : findFile(spec.motion, place.file(), "clips");
  if (spec.motion.empty()) place.refuse("names no motion", "give \"motion\" a BVH, glTF, FBX or .mot file");
  if (place.has("parts")) spec.parts = readFileName(place.at("parts"), "clips");
  if (place.has("body")) {
    spec.body = place.at("body").text();
    ToldBody told;
    if (const std::string fault = readToldBody(spec.body, told); !fault.empty()) place.at("body").refuse(fault, "");
  }
  if (place.has("clip")) spec.clip = place.at("clip").text();
  if (place.has("style")) spec.style = readStyle(place.at("style"));
  if (place.has("resolution")) {
    spec.resolution = *parseResolution(place.at("resolution").choice({"low", "medium", "high", "ultra"}));
  }
  if (place.has("hair")) spec.hair = readFileName(place.at("hair"), "hair");
  if (place.has("reverse_faces")) spec.reverse_faces = place.at("reverse_faces").flag();
  if (place.has("fit")) spec.fit = place.at("fit").flag();
  if (place.has("mends")) {
    spec.mends = place.at("mends").text();
    GroomMends mends;
    if (const std::string fault = readMends(spec.mends, mends); !fault.empty()) place.at("mends").refuse(fault, "");
  }
  if (place.has("position")) spec.position = toVec3(place.at("position").vector(-kFarthestPlace, kFarthestPlace));
  if (place.has("heading"))
    spec.heading = place.at("heading").number(-kTurn, kTurn, " (radians: 180 degrees are 3.14159)");
  if (place.has("clip_offset")) spec.clip_offset = place.at("clip_offset").number(0, 1e5);
  if (place.has("loop")) spec.loop = *parseLoop(place.at("loop").choice(kLoopNames));
  if (place.has("look")) readHairRows(place.at("look"), spec.look);
  if (place.has("pins")) spec.pins = readPins(place.at("pins"));
  if (place.has("maps")) spec.maps = readMaps(place.at("maps"));
  if (place.has("curves")) spec.curves = readCurves(place.at("curves"));
  if (place.has("ties")) spec.ties = readTies(place.at("ties"));
  if (place.has("attachments")) spec.attachments = readAttachments(place.at("attachments"));
  return spec;
}

CameraSpec readCamera(const JsonPlace& place) {
  expectKeys(place, kCameraKeys);
  CameraSpec camera;
  if (place.has("view")) camera.view = place.at("view").choice({"front", "three-quarter", "side", "back", "top"});
  if (place.has("framing")) camera.framing = place.at("framing").choice({"head", "bust", "figure"});
  if (place.has("eye") != place.has("target")) place.refuse("has only one of eye and target", "give both or neither");
  if (place.has("eye")) {
    camera.eye = toVec3(place.at("eye").vector(-kFarthestPlace, kFarthestPlace));
    camera.target = toVec3(place.at("target").vector(-kFarthestPlace, kFarthestPlace));
    if ((*camera.eye - *camera.target).norm() < 1e-3) place.refuse("has its eye in its target", "move them apart");
  }
  if (place.has("fov")) camera.fov = place.at("fov").number(0.05, 2.5);
  if (place.has("follow")) camera.follow = place.at("follow").flag();
  if (place.has("of_head")) camera.of_head = place.at("of_head").flag();
  if (camera.of_head && !camera.eye) place.refuse("has no eye for of_head", "give eye and target, from the head");
  return camera;
}

Bookmarks readBookmarks(const JsonPlace& place) {
  Bookmarks bookmarks;
  for (std::size_t i = 0; i < place.arraySize(bookmarks.size()); ++i)
    if (const JsonPlace one = place.at(i); !one.value().is_null()) bookmarks[i] = readCamera(one);
  return bookmarks;
}

json writeCamera(const CameraSpec& camera) {
  json text = {{"view", camera.view}, {"framing", camera.framing}, {"fov", camera.fov}, {"follow", camera.follow}};
  if (camera.eye && camera.target) {
    text["eye"] = fromVec3(*camera.eye);
    text["target"] = fromVec3(*camera.target);
    text["of_head"] = camera.of_head;
  }
  return text;
}

PlaybackSpec readPlayback(const JsonPlace& place) {
  expectKeys(place, kPlaybackKeys);
  PlaybackSpec playback;
  if (place.has("speed")) playback.speed = place.at("speed").number(0, kFastestPlayback);
  if (place.has("fps")) playback.fps = place.at("fps").number(kSlowestFps, kFastestFps);
  if (place.has("settle")) playback.settle = place.at("settle").number(0, 10);
  if (place.has("budget_ms")) playback.budget_ms = place.at("budget_ms").number(0, kLargestBudget);
  if (place.has("deadline_ms")) playback.deadline_ms = place.at("deadline_ms").number(0, kLargestBudget);
  if (place.has("draw_budget_ms")) playback.draw_budget_ms = place.at("draw_budget_ms").number(0, kLargestBudget);
  return playback;
}

json writeCharacter(const CharacterSpec& spec, const CharacterLook& base) {
  return {{"motion", spec.motion},
          {"parts", spec.parts},
          {"body", spec.body},
          {"clip", spec.clip},
          {"style", styleName(spec.style)},
          {"resolution", resolutionName(spec.resolution)},
          {"hair", spec.hair},
          {"reverse_faces", spec.reverse_faces},
          {"fit", spec.fit},
          {"mends", spec.mends},
          {"position", fromVec3(spec.position)},
          {"heading", spec.heading},
          {"clip_offset", spec.clip_offset},
          {"loop", loopName(spec.loop)},
          {"look", writeHairRows(spec.look, base)},
          {"pins", writePins(spec.pins)},
          {"ties", writeTies(spec.ties)},
          {"attachments", writeAttachments(spec.attachments)},
          {"maps", writeMaps(spec.maps)},
          {"curves", writeCurves(spec.curves)}};
}

}  // namespace

std::optional<Resolution> parseResolution(std::string_view name) {
  for (const Resolution resolution : {Resolution::kLow, Resolution::kMedium, Resolution::kHigh, Resolution::kUltra}) {
    if (name == resolutionName(resolution)) return resolution;
  }
  return {};
}

namespace {

std::string namedPreset(const JsonPlace& place, const std::string& scene_file) {
  const std::string name = place.text();
  try {
    return presetFile(name, scene_file);
  } catch (const InputError& fault) {
    throw InputError(scene_file, place.pointer(), fault.what(), "");
  }
}

// The name of a preset that the program brings along; empty for another, whose file may be gone when the scene is read.
std::string shippedPreset(const std::string& file) {
  const std::vector<std::string> shipped = listAssets("presets", {".json"});
  return std::ranges::find(shipped, file) == shipped.end() ? "" : stem(file);
}

}  // namespace

Scene readScene(std::string_view text, const std::string& file) {
  const json parsed = parseJson(text, file);
  const JsonPlace place(parsed, file);
  expectTopKeys(place, JsonKind::kScene);
  Scene scene;
  scene.file = file;
  scene.name = place.has("name") ? place.at("name").text() : stem(file);
  if (!place.has("characters")) place.refuse("has no characters", "add \"characters\": [{ \"motion\": \"walk.bvh\" }]");
  const JsonPlace characters = place.at("characters");
  const std::size_t count = characters.arraySize(kMaxCharacters);
  if (count == 0) characters.refuse("is empty", "add a character, for instance { \"motion\": \"walk.bvh\" }");
  // The preset comes first, so that the scene's own rows win over it.
  CharacterLook preset_look;
  if (place.has("preset")) {
    std::array<CharacterLook*, 1> looks{&preset_look};
    scene.preset = namedPreset(place.at("preset"), file);
    loadPreset(scene.preset, {&scene.sim, &scene.look, looks});
  }
  for (std::size_t i = 0; i < count; ++i) {
    scene.characters.push_back(readCharacter(characters.at(i), preset_look));
  }
  if (place.has("camera")) scene.camera = readCamera(place.at("camera"));
  if (place.has("bookmarks")) scene.bookmarks = readBookmarks(place.at("bookmarks"));
  if (place.has("light")) readSceneRows(place.at("light"), scene.look, true);
  if (place.has("view")) readSceneRows(place.at("view"), scene.look, false);
  if (place.has("sim")) readSimRows(place.at("sim"), scene.sim);
  if (place.has("playback")) scene.playback = readPlayback(place.at("playback"));
  return scene;
}

Scene loadScene(const std::string& file) {
  return readScene(readText(file, kLargestScene), file);
}

std::string writeScene(const Scene& scene) {
  const std::string preset = shippedPreset(scene.preset);
  Scene base;
  CharacterLook base_look;
  std::array<CharacterLook*, 1> looks{&base_look};
  if (!preset.empty()) loadPreset(scene.preset, {&base.sim, &base.look, looks});
  json characters = json::array();
  for (const CharacterSpec& spec : scene.characters) characters.push_back(writeCharacter(spec, base_look));
  json bookmarks = json::array();
  for (const std::optional<CameraSpec>& one : scene.bookmarks) bookmarks.push_back(one ? writeCamera(*one) : json());
  while (!bookmarks.empty() && bookmarks.back().is_null()) bookmarks.erase(bookmarks.size() - 1);
  json text = {{"name", scene.name},
               {"characters", characters},
               {"camera", writeCamera(scene.camera)},
               {"light", writeSceneRows(scene.look, true, base.look)},
               {"view", writeSceneRows(scene.look, false, base.look)},
               {"sim", writeSimRows(scene.sim, base.sim)},
               {"playback",
                {{"speed", scene.playback.speed},
                 {"fps", scene.playback.fps},
                 {"settle", scene.playback.settle},
                 {"budget_ms", scene.playback.budget_ms},
                 {"deadline_ms", scene.playback.deadline_ms},
                 {"draw_budget_ms", scene.playback.draw_budget_ms}}}};
  if (!bookmarks.empty()) text["bookmarks"] = bookmarks;
  if (!preset.empty()) text["preset"] = preset;
  return text.dump(2, ' ', false, json::error_handler_t::replace) + "\n";
}

}  // namespace app
