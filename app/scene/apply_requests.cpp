// What each request does. A fault becomes the demo's message and changes nothing else.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <utility>

#include "app/data_path.h"
#include "app/demo.h"
#include "app/errors.h"
#include "app/presets.h"
#include "sim/field_text.h"

namespace app {

namespace {

void tell(const std::string& text, Demo& demo) {
  demo.message = text;
  demo.message_is_fault = false;
}

void changePreset(const std::string& name, Demo& demo) {
  std::vector<CharacterLook*> looks;
  for (Actor& actor : demo.actors) looks.push_back(&actor.spec.look);
  loadPreset(presetFile(name, ""), {&demo.scene.sim, &demo.scene.look, looks});
  tell("preset " + stem(name), demo);
}

// Replaces the selected actor by one of another spec; loads first, so that a fault leaves the old one standing.
void recast(const CharacterSpec& spec, bool same_motion, const std::string& title, Demo& demo) {
  Actor& old = selectedActor(demo);
  if (demo.loading.on) {
    LoadOrder order{title, {}, demo.aspect, spec, demo.selected, same_motion, old.playback};
    order.scene.sim = demo.scene.sim;
    order.scene.playback = demo.scene.playback;
    return loadLater(std::move(order), demo);
  }
  Actor fresh = makeActor(spec, demo.scene.playback, demo.wardrobe);
  fresh.playback.speed = old.playback.speed;
  fresh.playback.paused = old.playback.paused;
  if (same_motion) keepMotion(old, fresh);
  settleActor(demo.scene.sim, demo.scene.playback.settle, fresh);
  fresh.context->refreshGradually(true);
  old = std::move(fresh);
  tidy(demo.actors, demo.wardrobe);
  tell(title, demo);
}

void changeStyle(const Request& request, Demo& demo) {
  CharacterSpec spec = selectedActor(demo).spec;
  if (request.what == Ask::kStyle) {
    const auto style = parseStyle(request.name);
    if (!style) throw InputError("", "style '" + request.name + "'", "is unknown", "choose short, shoulder or long");
    spec.style = *style;
  } else {
    const auto resolution = parseResolution(request.name);
    if (!resolution)
      throw InputError("", "resolution '" + request.name + "'", "is unknown", "choose low, medium, high or ultra");
    spec.resolution = *resolution;
  }
  spec.hair.clear();
  recast(spec, true, std::string(sim::styleName(spec.style)) + " " + std::string(sim::resolutionName(spec.resolution)),
         demo);
}

void changeHairFile(const std::string& file, Demo& demo) {
  CharacterSpec spec = selectedActor(demo).spec;
  spec.hair = findFile(file, "", "hair");
  recast(spec, true, "hair mesh " + stem(file), demo);
}

void changeMotion(const Request& request, Demo& demo) {
  CharacterSpec spec = selectedActor(demo).spec;
  if (request.what == Ask::kClip) {
    spec.clip = request.name;
  } else {
    spec.motion = findFile(request.text, "", "clips");
    spec.clip.clear();
    spec.parts = request.name;
  }
  spec.clip_offset = 0;
  recast(spec, false, "motion " + (request.what == Ask::kClip ? request.name : stem(request.text)), demo);
}

void changeScene(const std::string& file, Demo& demo) {
  Scene scene = loadScene(findFile(file, "", "scenes"));
  scene.skips = demo.scene.skips;
  if (demo.loading.on) {
    const std::string title = "scene " + scene.name;
    return loadLater({title, std::move(scene), demo.aspect, {}, 0, false, {}}, demo);
  }
  replaceScene(openScene(std::move(scene), demo.aspect), demo);
}

void scrub(double time, Demo& demo) {
  Actor& actor = selectedActor(demo);
  actor.playback.time = std::clamp(time, 0.0, actor.playedClip().duration());
  placeActor(actor, false);
}

void writeText(const std::string& file, const std::string& text) {
  std::ofstream stream(file, std::ios::binary);
  stream << text;
  stream.close();
  if (!stream) throw InputError(file, "", "cannot be written", "choose a folder that exists and may be written to");
}

Scene presentScene(const Demo& demo) {
  Scene scene = demo.scene;
  for (std::size_t i = 0; i < demo.actors.size(); ++i) scene.characters[i] = demo.actors[i].spec;
  return scene;
}

void openAnyFile(const std::string& file, Demo& demo) {
  std::string ending = std::filesystem::path(file).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(), [](unsigned char c) { return std::tolower(c); });
  if (ending == ".obj") return changeHairFile(file, demo);
  if (ending == ".mot") {
    // The paper's data keeps the body parts in a folder beside the motion.
    const auto parts = std::filesystem::path(file).parent_path() / "female-objs";
    return changeMotion({Ask::kMotionFile, parts.string(), file}, demo);
  }
  if (ending == ".json") {
    const bool is_scene = parseJson(readText(file), file).contains("characters");
    demo.requests.push_back({is_scene ? Ask::kSceneFile : Ask::kPresetFile, "", file});
    return;
  }
  for (const char* known : {".bvh", ".glb", ".gltf", ".fbx", ".dae"}) {
    if (ending == known) return changeMotion({Ask::kMotionFile, "", file}, demo);
  }
  throw InputError(file, "", "is no kind of file that this program reads",
                   "give a scene or preset (.json), a motion (.bvh, .glb, .gltf, .fbx, .mot) or a hair mesh (.obj)");
}

void setParameter(const Request& request, Demo& demo) {
  // Hair rows speak of the selected character, the others of the scene.
  std::array<CharacterLook*, 1> look{&selectedActor(demo).spec.look};
  const std::string fault = setAnywhere(request.name, request.text, demo.scene.sim, look, demo.scene.look);
  if (!fault.empty()) throw InputError("", "", fault, "");
}

void setDebugView(const Request& request, Demo& demo) {
  for (const DebugView& view : kDebugViews) {
    if (view.name == request.name) demo.debug.*view.on = request.value != 0;
  }
}

template <class Change>
void forAll(Demo& demo, Change&& change) {
  for (Actor& actor : demo.actors) change(actor);
}

void apply(const Request& request, Demo& demo) {
  const bool on = request.value != 0;
  PlaybackSpec& playback = demo.scene.playback;
  switch (request.what) {
    case Ask::kSetParam:
      return setParameter(request, demo);
    case Ask::kPause:
      demo.paused = on;
      return;
    case Ask::kPauseMotion:
      return forAll(demo, [&](Actor& actor) { actor.playback.paused = on; });
    case Ask::kSingleStep:
      demo.paused = true;
      demo.single_steps += 1;
      return;
    case Ask::kReset:
      return forAll(demo, [](Actor& actor) { placeActor(actor, true); });
    case Ask::kRestart:
      return forAll(demo, [&](Actor& actor) {
        actor.playback.time = actor.spec.clip_offset;
        placeActor(actor, true);
        settleActor(demo.scene.sim, playback.settle, actor);
      });
    case Ask::kCollapse:
      return forAll(demo, [](Actor& actor) {
        sim::collapseOntoRoots(actor.haircut->mesh, actor.hair);
        actor.previous_positions = actor.hair.positions;
        actor.coarse.active = false;
      });
    case Ask::kCarryAlong:
      return scrub(request.value, demo);
    case Ask::kSpeed:
      playback.speed = std::clamp(request.value, 0.0, kFastestPlayback);
      return forAll(demo, [&](Actor& actor) { actor.playback.speed = playback.speed; });
    case Ask::kLoop:
      playback.loop = on;
      return forAll(demo, [&](Actor& actor) { actor.playback.loop = on; });
    case Ask::kBlend:
      playback.blend = std::clamp(request.value, 0.0, 10.0);
      return forAll(demo, [&](Actor& actor) { actor.playback.blend = playback.blend; });
    case Ask::kInPlace:
      selectedActor(demo).spec.in_place = on;
      selectedActor(demo).playback.in_place = on;
      return placeActor(selectedActor(demo), false);
    case Ask::kClip:
    case Ask::kMotionFile:
      return changeMotion(request, demo);
    case Ask::kStyle:
    case Ask::kResolution:
      return changeStyle(request, demo);
    case Ask::kHairFile:
      return changeHairFile(request.text, demo);
    case Ask::kSceneFile:
      return changeScene(request.text, demo);
    case Ask::kPresetFile:
      return changePreset(request.text, demo);
    case Ask::kSavePreset:
      writeText(request.text,
                writePreset(stem(request.text), demo.scene.sim, selectedActor(demo).spec.look, demo.scene.look));
      return tell("saved " + request.text, demo);
    case Ask::kSaveScene:
      writeText(request.text, writeScene(presentScene(demo)));
      return tell("saved " + request.text, demo);
    case Ask::kOpenFile:
      return openAnyFile(request.text, demo);
    case Ask::kSelect:
      demo.selected = std::clamp(static_cast<int>(request.value), 0, static_cast<int>(demo.actors.size()) - 1);
      return;
    case Ask::kView:
      return turnTo(request.name, demo.actors.front(), demo.camera);
    case Ask::kFollow:
      demo.camera.follow = on;
      return;
    case Ask::kDebugView:
      return setDebugView(request, demo);
    case Ask::kSkip:
      if (const std::string fault = setSkip(request.name + (on ? "=on" : "=off"), demo.scene.skips); !fault.empty())
        throw InputError("", "", fault, "");
      return;
    case Ask::kScreenshot:
      demo.capture.screenshot = true;
      demo.capture.screenshot_file = request.text;
      return;
    case Ask::kBudget:
      playback.budget_ms = std::isfinite(request.value) ? std::clamp(request.value, 0.0, kLargestBudget) : 0;
      return setBudget(1e-3 * playback.budget_ms, demo.governor);
    case Ask::kRecord:
      demo.capture.recording = on;
      demo.capture.recorded = 0;
      return;
  }
}

}  // namespace

void applyRequests(Demo& demo) {
  takeLoaded(demo);
  if (!demo.requests.empty()) {
    for (Actor& actor : demo.actors) actor.shown_still = false;
  }
  // A request may bring others; a scene replaces the demo, so what follows it is taken over by value first.
  for (int round = 0; round < 4 && !demo.requests.empty(); ++round) {
    const std::vector<Request> asked = std::exchange(demo.requests, {});
    for (const Request& request : asked) {
      try {
        apply(request, demo);
      } catch (const std::exception& fault) {
        demo.message = fault.what();
        demo.message_is_fault = true;
      }
    }
  }
}

}  // namespace app
