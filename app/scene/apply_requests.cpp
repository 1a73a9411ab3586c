// What each request does. A fault becomes the demo's message and changes nothing else.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include "app/files/data_path.h"
#include "app/files/errors.h"
#include "app/files/file_kind.h"
#include "app/files/hair_file.h"
#include "app/files/presets.h"
#include "app/files/told_body.h"
#include "app/scene/attachments.h"
#include "app/scene/demo.h"
#include "app/scene/demo_state.h"
#include "app/scene/edit/brushed_hair.h"
#include "app/scene/edit/cut_stroke.h"
#include "app/scene/edit/groom_brush.h"
#include "app/scene/edit/hand_pins.h"
#include "app/scene/edit/mesh_change.h"
#include "app/scene/edit/paint_brush.h"
#include "app/scene/edit/vary.h"
#include "app/scene/hair_from_file.h"
#include "app/scene/hairdo.h"
#include "app/scene/project.h"
#include "app/scene/save_requests.h"
#include "app/scene/view/environment_light.h"
#include "sim/field_text.h"

namespace app {

void showMessage(const std::string& text, Demo& demo) {
  demo.message = text;
  demo.message_is_fault = false;
}

namespace {

void changePreset(const std::string& name, Demo& demo) {
  std::vector<CharacterLook*> looks;
  for (Actor& actor : demo.actors) looks.push_back(&actor.spec.look);
  const std::string file = presetFile(name, "");
  loadPreset(file, {&demo.scene.sim, &demo.scene.look, looks});
  demo.scene.preset = file;
  keepBase(demo);
  showMessage("preset " + stem(name), demo);
}

// Replaces the selected actor by one of another spec; loads first, so that a fault leaves the old one standing.
void recast(CharacterSpec spec, bool same_motion, std::string title, Demo& demo, bool another_hair = false) {
  Actor& old = selectedActor(demo);
  title += keepBrushed(old, another_hair, spec);
  if (!spec.pins.empty()) spec.pins = pinsForAnotherMesh(old);
  if (demo.loading.on) {
    LoadOrder order{title, {}, demo.aspect, spec, demo.selected, same_motion, old.playback, old.spec.look};
    order.scene.sim = demo.scene.sim;
    order.scene.playback = demo.scene.playback;
    return loadLater(std::move(order), demo);
  }
  Actor fresh = makeActor(spec, demo.scene.playback, demo.asset_cache);
  fresh.playback.paused = old.playback.paused;
  if (same_motion) fresh.playback = old.playback;
  settleInMotion(demo.scene.sim, demo.scene.playback.settle, fresh);
  fresh.context->refreshGradually(true);
  replaceActor(std::move(fresh), demo.selected, same_motion, demo);
  const std::string notes = hairNotes(demo.actors);
  showMessage(notes.empty() ? title : notes, demo);
}

void changeStyle(const Request& request, Demo& demo) {
  CharacterSpec spec = selectedActor(demo).spec;
  if (request.what == Ask::kStyle) {
    chooseStyle(request.name, spec);
    spec.pins.clear();
  } else {
    const auto resolution = parseResolution(request.name);
    if (!resolution)
      throw InputError("", "resolution '" + request.name + "'", "is unknown", "choose low, medium, high or ultra");
    spec.resolution = *resolution;
    chooseHair("", spec);
  }
  const bool restyled = request.what == Ask::kStyle;
  const bool unpinned = restyled && !selectedActor(demo).spec.pins.empty();
  recast(spec, true,
         (restyled ? request.name : std::string(styleName(spec.style))) + " " +
             std::string(resolutionName(spec.resolution)) + (unpinned ? ", without the pins of the style before" : ""),
         demo, restyled);
}

void changeHairFile(const std::string& file, Demo& demo) {
  CharacterSpec spec = selectedActor(demo).spec;
  chooseHair(foundFile(file, "", "hair"), spec);
  spec.mends.clear(), spec.pins.clear();
  recast(spec, true, "hair mesh " + stem(file), demo, true);
}

void changeMends(const std::string& mends, Demo& demo) {
  CharacterSpec spec = selectedActor(demo).spec;
  GroomMends checked;
  if (const std::string fault = readMends(mends, checked); !fault.empty()) throw InputError("", "mends", fault, "");
  spec.mends = mends;
  recast(spec, true, "mended hair", demo, true);
}

void changeTies(const std::string& text, Demo& demo) {
  CharacterSpec spec = selectedActor(demo).spec;
  spec.ties = tiesFromText(text);
  const std::string hair = std::ranges::any_of(spec.ties, &TieSpec::braided) ? "braided hair" : "hair",
                    bun = std::ranges::any_of(spec.ties, &TieSpec::bun) ? " in a bun" : "";
  recast(spec, true, hair + (spec.ties.empty() ? " without ties" : bun + " with " + tieTitle(spec.ties)), demo);
}

void changeAttachments(const Request& request, Demo& demo) {
  CharacterSpec spec = selectedActor(demo).spec;
  std::vector<AttachmentSpec> given = attachmentsFromText(request.text);
  if (request.name == "add") given.insert(given.begin(), spec.attachments.begin(), spec.attachments.end());
  if (given.size() > kMaxAttachments)
    throw InputError("", "attachments", "are more than " + std::to_string(kMaxAttachments), "take one off first");
  if (wornText(given) == wornText(spec.attachments)) {
    selectedActor(demo).spec.attachments = std::move(given);
    return;
  }
  spec.attachments = std::move(given);
  recast(spec, true,
         spec.attachments.empty() ? "hair with nothing over it" : "hair with " + stem(spec.attachments.back().file),
         demo);
}

void changeMap(const Request& request, Demo& demo) {
  CharacterSpec spec = selectedActor(demo).spec;
  const bool none = request.text.empty() || isPictureText(request.text);
  const std::string file = none ? request.text : findFile(request.text, "", "maps");
  if (const std::string fault = setMap(request.name, file, spec.maps); !fault.empty())
    throw InputError("", "map '" + request.name + "'", fault, "");
  recast(spec, true, request.name + (file.empty() ? " no longer painted" : " painted by " + stem(file)), demo);
}

void changeMotion(const Request& request, Demo& demo) {
  CharacterSpec spec = selectedActor(demo).spec;
  spec.motion = foundFile(request.text, "", "clips");
  spec.clip.clear();
  spec.parts = request.name;
  spec.body.clear();
  spec.clip_offset = 0;
  recast(spec, false, "motion " + stem(request.text), demo);
}

void changeBody(const std::string& told, Demo& demo) {
  CharacterSpec spec = selectedActor(demo).spec;
  ToldBody checked;
  if (const std::string fault = readToldBody(told, checked); !fault.empty()) throw InputError("", "body", fault, "");
  spec.body = told;
  recast(spec, false, stem(spec.motion) + ", " + (told.empty() ? "by its outline" : told), demo);
}

void changeClip(const std::string& name, Demo& demo) {
  goOnWithClip(name, selectedActor(demo));
  showMessage("clip " + name, demo);
}

void changeScene(const std::string& file, Demo& demo) {
  Scene scene = loadScene(foundFile(file, "", "scenes"));
  scene.skips = demo.scene.skips;
  if (demo.loading.on) {
    const std::string title = "scene " + scene.name;
    return loadLater({title, std::move(scene), demo.aspect, {}, 0, false, {}, {}}, demo);
  }
  replaceScene(openScene(std::move(scene), demo.aspect), demo);
}

void scrub(double time, Demo& demo) {
  Actor& actor = selectedActor(demo);
  actor.playback.time = std::clamp(time, 0.0, actor.playedClip().duration());
  placeActor(actor, false);
}

void loadState(const Request& request, Demo& demo) {
  loadDemoState(request.text, false, demo);
  showMessage("state " + stem(request.text), demo);
}

// What opens a file, in the order of FileKind.
constexpr std::array kOpens{Ask::kSceneFile, Ask::kPresetFile, Ask::kMotionFile,  Ask::kMotionFile, Ask::kHairFile,
                            Ask::kLoadState, Ask::kOpenCache,  Ask::kOpenProject, Ask::kAttach,     Ask::kEnvironment};
static_assert(kOpens.size() == static_cast<std::size_t>(FileKind::kEnvironment) + 1);

void openAnyFile(const std::string& file, Demo& demo) {
  const FileKind kind = fileKind(file);
  std::string name;
  if (kind == FileKind::kRigidMotion) name = partsBeside(file);
  if (kind == FileKind::kAttachment) name = "add";
  demo.requests.push_back({kOpens[static_cast<std::size_t>(kind)], name, file});
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

void switchSkip(const Request& request, Demo& demo) {
  const std::string fault = setSkip(request.name + (request.value != 0 ? "=on" : "=off"), demo.scene.skips);
  if (!fault.empty()) throw InputError("", "", fault, "");
}

void restart(const Request&, Demo& demo) {
  for (Actor& actor : demo.actors) {
    startPlayback(actor.playedClip(), actor.spec.clip_offset, actor.playback);
    placeActor(actor, true);
    settleActor(demo.scene.sim, demo.scene.playback.settle, actor);
  }
}

void collapse(const Request&, Demo& demo) {
  for (Actor& actor : demo.actors) {
    sim::collapseOntoRoots(actor.haircut->mesh, actor.hair);
    actor.previous_positions = actor.hair.positions;
    actor.coarse.active = false;
  }
}

void setSpeed(const Request& request, Demo& demo) {
  demo.scene.playback.speed = std::clamp(request.value, 0.0, kFastestPlayback);
  for (Actor& actor : demo.actors) actor.playback.speed = demo.scene.playback.speed;
}

void setLoop(const Request& request, Demo& demo) {
  const auto loop = parseLoop(request.name);
  if (!loop)
    throw InputError("", "loop '" + request.name + "'", "is unknown", "choose auto, go-on, in-place, stop or none");
  chooseLoop(*loop, selectedActor(demo));
}

void setBudget(const Request& request, Demo& demo) {
  double& budget = demo.scene.playback.budget_ms;
  budget = std::isfinite(request.value) ? std::clamp(request.value, 0.0, kLargestBudget) : 0;
  setBudget(1e-3 * budget, demo.governor);
}

void setDrawBudget(const Request& request, Demo& demo) {
  double& budget = demo.scene.playback.draw_budget_ms;
  budget = std::isfinite(request.value) ? std::clamp(request.value, 0.0, kLargestBudget) : 0;
  setDrawBudget(1e-3 * budget, demo.draw_governor);
}

void setDeadline(const Request& request, Demo& demo) {
  double& deadline = demo.scene.playback.deadline_ms;
  deadline = std::isfinite(request.value) ? std::clamp(request.value, 0.0, kLargestBudget) : 0;
  demo.deadline.seconds = 1e-3 * deadline;
}

long frameOf(const Request& request) {
  return static_cast<long>(std::clamp(request.value, -1.0, 1e15));
}

std::optional<Camera>& bookmark(const Request& request, Demo& demo) {
  const double last = static_cast<double>(demo.bookmarks.size() - 1);
  return demo.bookmarks[static_cast<std::size_t>(std::clamp(request.value, 0.0, last))];
}

void keepView(const Request& request, Demo& demo) {
  std::optional<Camera>& kept = bookmark(request, demo);
  const long number = 1 + (&kept - demo.bookmarks.data());
  showMessage("view " + std::to_string(number) + (kept ? " kept in place of the one before" : " kept"), demo);
  kept = demo.camera;
}

// The kept direction, distance and angle, about where the figure is now.
void goToView(const Request& request, Demo& demo) {
  const std::optional<Camera>& kept = bookmark(request, demo);
  if (!kept) throw InputError("", "", "no view is kept there", "keep one first");
  const Camera now = demo.camera;
  demo.camera = *kept;
  demo.camera.anchor = now.anchor;
  demo.camera.jumped = now.jumped;
}

int stepsOf(const Request& request) {
  return static_cast<int>(std::clamp(request.value, 1.0, 1e6));
}

void compare(const Request& request, Demo& demo) {
  if (request.value == 0) {
    demo.comparison.other.clear();
    return;
  }
  startComparison(request.text, demo);
  showMessage("compared with " + (request.text.empty() ? "what it was" : stem(request.text)), demo);
}

void vary(const Request& request, Demo& demo) {
  double amount = 0;
  if (!sim::parseNumber(request.text, amount) || amount < 0 || amount > kLargestVariation)
    throw InputError("", "variation", "'" + request.text.substr(0, 40) + "' is no amount", "choose 0 to 2");
  varyMaterial(amount, static_cast<std::uint64_t>(std::clamp(request.value, 0.0, 1e15)), demo.scene.sim);
}

void changeEnvironment(const Request& request, Demo& demo) {
  setEnvironment(request.text, demo.scene);
  showMessage(request.text.empty() ? "light without a panorama" : "light of " + stem(request.text), demo);
}

struct Action {
  Ask what;
  void (*apply)(const Request&, Demo&);
};

// Row k is for the request of number k.
constexpr Action kActions[] = {
    {Ask::kSetParam, setParameter},
    {Ask::kPause, [](const Request& request, Demo& demo) { demo.paused = request.value != 0; }},
    {Ask::kPauseMotion,
     [](const Request& request, Demo& demo) {
       for (Actor& actor : demo.actors) actor.playback.paused = request.value != 0;
     }},
    {Ask::kSingleStep,
     [](const Request&, Demo& demo) {
       demo.paused = true;
       demo.single_steps += 1;
     }},
    {Ask::kReset,
     [](const Request&, Demo& demo) {
       for (Actor& actor : demo.actors) placeActor(actor, true);
     }},
    {Ask::kRestart, restart},
    {Ask::kCollapse, collapse},
    {Ask::kCarryAlong, [](const Request& request, Demo& demo) { scrub(request.value, demo); }},
    {Ask::kSpeed, setSpeed},
    {Ask::kLoop, setLoop},
    {Ask::kClip, [](const Request& request, Demo& demo) { changeClip(request.name, demo); }},
    {Ask::kStyle, changeStyle},
    {Ask::kResolution, changeStyle},
    {Ask::kMotionFile, changeMotion},
    {Ask::kBody, [](const Request& request, Demo& demo) { changeBody(request.text, demo); }},
    {Ask::kHairFile, [](const Request& request, Demo& demo) { changeHairFile(request.text, demo); }},
    {Ask::kHairMends, [](const Request& request, Demo& demo) { changeMends(request.text, demo); }},
    {Ask::kSceneFile, [](const Request& request, Demo& demo) { changeScene(request.text, demo); }},
    {Ask::kPresetFile, [](const Request& request, Demo& demo) { changePreset(request.text, demo); }},
    {Ask::kSavePreset, savePreset},
    {Ask::kSaveScene, saveScene},
    {Ask::kSaveState, saveState},
    {Ask::kLoadState, loadState},
    {Ask::kOpenFile, [](const Request& request, Demo& demo) { openAnyFile(request.text, demo); }},
    {Ask::kSelect,
     [](const Request& request, Demo& demo) {
       demo.selected = std::clamp(static_cast<int>(request.value), 0, static_cast<int>(demo.actors.size()) - 1);
     }},
    {Ask::kView, [](const Request& request, Demo& demo) { turnTo(request.name, demo.actors.front(), demo.camera); }},
    {Ask::kFollow, [](const Request& request, Demo& demo) { demo.camera.follow = request.value != 0; }},
    {Ask::kDebugView, setDebugView},
    {Ask::kBudget, setBudget},
    {Ask::kDrawBudget, setDrawBudget},
    {Ask::kDeadline, setDeadline},
    {Ask::kSkip, switchSkip},
    {Ask::kScreenshot,
     [](const Request& request, Demo& demo) {
       demo.capture.screenshot = true;
       demo.capture.screenshot_file = request.text;
     }},
    {Ask::kRecord,
     [](const Request& request, Demo& demo) {
       demo.capture.recording = request.value != 0;
       if (demo.capture.recording) demo.capture.recorded = 0;
     }},
    {Ask::kRecordHair,
     [](const Request& request, Demo& demo) {
       demo.capture.hair = request.value != 0;
       demo.capture.hair_file = request.text;
     }},
    {Ask::kOpenCache, [](const Request& request, Demo& demo) { openCache(request.text, demo); }},
    {Ask::kBrush, [](const Request& request,
                     Demo& demo) { applyBrush(parseBrush(request.name, request.text), demo.selected, demo); }},
    {Ask::kMove,
     [](const Request& request, Demo& demo) { applyMove(parseMove(request.name, request.text), demo.selected, demo); }},
    {Ask::kMesh,
     [](const Request& request, Demo& demo) { applyMeshChange(request.name, request.text, demo.selected, demo); }},
    {Ask::kSaveProject, saveAsProject},
    {Ask::kOpenProject,
     [](const Request& request, Demo& demo) {
       openProject(request.text, demo);
       showMessage("project " + stem(request.text), demo);
     }},
    {Ask::kRewind, [](const Request& request, Demo& demo) { rewindTo(frameOf(request), demo); }},
    {Ask::kKeepView, keepView},
    {Ask::kGoToView, goToView},
    {Ask::kLens, [](const Request& request, Demo& demo) { demo.camera.fov = std::clamp(request.value, 0.05, 2.5); }},
    {Ask::kTurntable,
     [](const Request& request, Demo& demo) { demo.turntable = std::clamp(request.value, -10.0, 10.0); }},
    {Ask::kUndo, [](const Request& request, Demo& demo) { undoEdits(stepsOf(request), demo); }},
    {Ask::kRedo, [](const Request& request, Demo& demo) { redoEdits(stepsOf(request), demo); }},
    {Ask::kEndGesture, [](const Request&, Demo& demo) { demo.edits.gesture = false, endCuts(demo); }},
    {Ask::kCompare, compare},
    {Ask::kCompareView,
     [](const Request& request, Demo& demo) {
       demo.comparison.side_by_side = request.name == "side";
       demo.comparison.line = std::clamp(request.value, 0.0, 1.0);
     }},
    {Ask::kMarkIn, [](const Request& request, Demo& demo) { setInPoint(request.value != 0, demo); }},
    {Ask::kMarkOut, [](const Request& request, Demo& demo) { setOutPoint(request.value != 0, demo); }},
    {Ask::kBake, [](const Request& request, Demo& demo) { startBake(request.value, demo); }},
    {Ask::kClearBake,
     [](const Request&, Demo& demo) {
       forgetMoments(demo.timeline);
       demo.timeline.in = demo.timeline.out = -1;
     }},
    {Ask::kMap, changeMap},
    {Ask::kTie, [](const Request& request, Demo& demo) { changeTies(request.text, demo); }},
    {Ask::kPin, [](const Request& request, Demo& demo) { applyPins(pinsFromText(request.text), demo.selected, demo); }},
    {Ask::kAttach, changeAttachments},
    {Ask::kDragWorn, [](const Request& request, Demo& demo) { drawDragged(request.text, selectedActor(demo)); }},
    {Ask::kPaint, [](const Request& request,
                     Demo& demo) { applyPaint(parsePaint(request.name, request.text), demo.selected, demo); }},
    {Ask::kCurve,
     [](const Request& request, Demo& demo) { applyCurve(request.name, request.text, demo.selected, demo); }},
    {Ask::kVary, vary},
    {Ask::kEnvironment, changeEnvironment},
};

constexpr bool rowsMatchRequests() {
  for (std::size_t k = 0; k < std::size(kActions); ++k) {
    if (kActions[k].what != static_cast<Ask>(k)) return false;
  }
  return std::size(kActions) == static_cast<std::size_t>(Ask::kCount);
}
static_assert(rowsMatchRequests());

// Requests whose text is a file that they open or save, once kOpenFile has told its kind.
constexpr Ask kOfFiles[] = {Ask::kMotionFile, Ask::kHairFile,    Ask::kSceneFile,   Ask::kPresetFile,
                            Ask::kLoadState,  Ask::kOpenCache,   Ask::kOpenProject, Ask::kAttach,
                            Ask::kSaveScene,  Ask::kSaveProject, Ask::kEnvironment};

bool ofFile(Ask what) {
  return std::ranges::find(kOfFiles, what) != std::end(kOfFiles);
}

void apply(const Request& request, Demo& demo) {
  if (request.what != Ask::kEndGesture) finishCuts(demo);
  std::optional<EditStep> step = beginEdit(request, demo);
  kActions[static_cast<std::size_t>(request.what)].apply(request, demo);
  const bool later = step && comesLater(demo.edits.next, demo.loading);
  if (step) commitEdit(std::move(*step), later, demo.edits);
  if (!later && ofFile(request.what)) noteFileEnd(request.text, true, demo);
}

void tryToApply(const Request& request, Demo& demo) {
  try {
    apply(request, demo);
    if (demo.refused == std::pair(request.what, demo.message)) showMessage("", demo);
  } catch (const std::exception& fault) {
    demo.message = fault.what();
    demo.message_is_fault = true;
    demo.refused = {request.what, demo.message};
    if (request.what == Ask::kOpenFile || ofFile(request.what)) noteFileEnd(request.text, false, demo);
  }
}

void applyHeld(Demo& demo) {
  while (const std::optional<HeldRequest> held = nextHeld(demo.loading)) {
    const int selected = demo.selected, last = static_cast<int>(demo.actors.size()) - 1;
    demo.selected = std::min(held->actor, last);
    tryToApply(held->request, demo);
    demo.selected = std::clamp(selected, 0, static_cast<int>(demo.actors.size()) - 1);
  }
}

}  // namespace

void applyRequests(Demo& demo) {
  installLoaded(demo);
  workOnCuts(demo);
  if (!demo.requests.empty() || !demo.loading.held.empty()) {
    for (Actor& actor : demo.actors) actor.shown_still = false;
  }
  applyHeld(demo);
  // A request may bring others; a scene replaces the demo, so what follows it is taken over by value first.
  for (int round = 0; round < 4 && !demo.requests.empty(); ++round) {
    const std::vector<Request> asked = std::exchange(demo.requests, {});
    for (const Request& request : asked) {
      if (!holdBack(request, demo)) tryToApply(request, demo);
    }
  }
}

}  // namespace app
