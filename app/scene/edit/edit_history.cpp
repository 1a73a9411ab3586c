#include "app/scene/edit/edit_history.h"

#include <algorithm>
#include <cctype>
#include <nlohmann/json.hpp>
#include <string>
#include <tuple>
#include <utility>

#include "app/files/data_path.h"
#include "app/files/recording.h"
#include "app/groom/edit/mesh_edit.h"
#include "app/scene/demo.h"
#include "app/scene/edit/groom_brush.h"
#include "app/scene/edit/mesh_change.h"
#include "app/scene/edit/paint_brush.h"
#include "app/scene/edit/painted_fields.h"
#include "app/scene/present_scene.h"
#include "app/scene/view/row_words.h"
#include "sim/field_text.h"
#include "sim/forces/rest_balance.h"

namespace app {

namespace {

// What an edit reaches beyond the settings.
enum Reach { kSettings = 0, kOfView = 1, kOfHair = 2, kOfMotion = 4, kOfShape = 8, kOfSwing = 16 };

struct EditKind {
  Ask what;
  int reach;
  bool drags;  // one gesture gives many of them
  const char* title;
};

// What is no edit (pause, steps, pictures, saving) is not here. Where the camera looks from is the window's to take
// back.
constexpr EditKind kEditKinds[] = {{Ask::kSetParam, kSettings, true, ""},
                                   {Ask::kPresetFile, kSettings, false, "Preset"},
                                   {Ask::kSkip, kSettings, false, "Skip"},
                                   {Ask::kBudget, kSettings, true, "Budget"},
                                   {Ask::kDrawBudget, kSettings, true, "Drawing budget"},
                                   {Ask::kDeadline, kSettings, true, "Deadline"},
                                   {Ask::kSpeed, kSettings, true, "Speed"},
                                   {Ask::kVary, kSettings, false, "Variation"},
                                   {Ask::kEnvironment, kSettings, false, "Environment"},
                                   {Ask::kDebugView, kSettings, false, "Debug view"},
                                   {Ask::kBrush, kOfHair | kOfShape, true, ""},
                                   {Ask::kMove, kOfHair | kOfShape, true, "move"},
                                   {Ask::kMesh, kOfHair | kOfShape, false, ""},
                                   {Ask::kPaint, kOfHair | kOfShape, true, "Paint"},
                                   {Ask::kCurve, kOfHair | kOfShape, true, "Curve of"},
                                   {Ask::kReset, kOfHair | kOfSwing, false, "Hair to rest"},
                                   {Ask::kCollapse, kOfHair | kOfSwing, false, "Collapse"},
                                   {Ask::kStyle, kOfHair, false, "Style"},
                                   {Ask::kResolution, kOfHair, false, "Resolution"},
                                   {Ask::kHairFile, kOfHair, false, "Hair mesh"},
                                   {Ask::kHairMends, kOfHair, false, "Mends"},
                                   {Ask::kTie, kOfHair, false, "Tie"},
                                   {Ask::kPin, kOfHair, false, "Pins"},
                                   {Ask::kAttach, kOfHair, false, "Attachment"},
                                   {Ask::kMap, kOfHair, false, "Painted"},
                                   {Ask::kRestart, kOfHair | kOfMotion, false, "To the start"},
                                   {Ask::kCarryAlong, kOfHair | kOfMotion, true, "Scrub"},
                                   {Ask::kClip, kOfHair | kOfMotion, false, "Clip"},
                                   {Ask::kLoop, kOfHair | kOfMotion, false, "At the end"},
                                   {Ask::kMotionFile, kOfView | kOfHair | kOfMotion, false, "Motion"},
                                   {Ask::kBody, kOfView | kOfHair | kOfMotion, false, "Body"},
                                   {Ask::kSceneFile, kOfView | kOfHair | kOfMotion, false, "Scene"},
                                   {Ask::kOpenProject, kOfView | kOfHair | kOfMotion, false, "Project"},
                                   {Ask::kLoadState, kOfView | kOfHair | kOfMotion, false, "State"}};

const EditKind* kindOf(Ask what) {
  const auto at = std::find_if(std::begin(kEditKinds), std::end(kEditKinds),
                               [&](const EditKind& kind) { return kind.what == what; });
  return at == std::end(kEditKinds) ? nullptr : at;
}

// What is painted of the look alone, or of how dense strands grow, moves no hair.
int reachOf(const Request& request, const EditKind& kind) {
  const bool paints = request.what == Ask::kPaint || request.what == Ask::kCurve;
  return paints && (isOfLook(request.name) || request.name == "density") ? kSettings : kind.reach;
}

std::string spaced(std::string name) {
  std::replace_if(
      name.begin(), name.end(), [](char c) { return c == '_' || c == '-'; }, ' ');
  return name;
}

std::string capitalized(std::string words) {
  if (!words.empty()) words[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(words[0])));
  return words;
}

std::string titleOf(const Request& request, const EditKind& kind) {
  if (request.what == Ask::kSetParam) return rowTitle(request.name) + " " + rowValue(request.name, request.text);
  if (request.what == Ask::kBrush) return capitalized(request.name);
  if (request.what == Ask::kMove) return capitalized(kind.title + (" " + request.name));
  if (request.what == Ask::kMesh) return capitalized(spaced(request.name));
  if (request.what == Ask::kAttach && request.text == "[]") return "Nothing worn";
  if (request.what == Ask::kBody) return "Body " + (request.text.empty() ? "by its outline" : request.text);
  std::string title = kind.title;
  if (!request.name.empty() && request.name != "add" && request.what != Ask::kMotionFile)
    title.append(" ").append(request.name);
  if (request.text.starts_with('[') || request.text.starts_with('{')) {  // JSON says more than a title holds
    const auto has = [&](const char* key) { return request.text.find(key) != std::string::npos; };
    return title + (has("\"braided\":true") ? ", braided" : "") + (has("\"bun\":true") ? ", bun" : "");
  }
  const bool sample = request.what == Ask::kPaint;
  if (!request.text.empty() && request.what != Ask::kVary && !sample)
    title.append(" ").append(spaced(stem(request.text)).substr(0, 40));
  const bool budget =
      request.what == Ask::kBudget || request.what == Ask::kDrawBudget || request.what == Ask::kDeadline;
  if (budget || request.what == Ask::kSpeed || request.what == Ask::kVary)
    title.append(" ").append(sim::numberText(request.value)).append(budget ? " ms" : "");
  const bool toggle = request.what == Ask::kSkip || request.what == Ask::kDebugView;
  if (toggle) title += request.value != 0 ? " on" : " off";
  return title;
}

EditSide sideOf(const Demo& demo, int reach) {
  EditSide side;
  side.scene = demo.scene;
  for (const Actor& actor : demo.actors) side.cast.push_back(actor.spec);
  side.selected = demo.selected;
  side.debug = demo.debug;
  side.moment = demo.edits.moment;
  if (reach & kOfView) side.camera = demo.camera;
  if (!(reach & (kOfHair | kOfMotion))) return side;
  for (const Actor& actor : demo.actors) {
    const Haircut& haircut = *actor.haircut;
    const Rigid head = scalpToWorld(actor.body->character, actor.pose);
    ActorMoment moment{head, actor.hair, {}, {}, haircut.remeshed, haircut.frozen, {}};
    if (haircut.remeshed) moment.sag = actor.context->material().sag();
    if (reach & kOfMotion) moment.playback = actor.playback;
    if (reach & kOfShape || haircut.edited) moment.shape = haircut.mesh.shape;
    side.moments.push_back(std::move(moment));
  }
  return side;
}

std::string mapsText(const FieldFiles& maps) {
  std::string text;
  for (const std::string_view field : kFieldNames) text += mapOf(field, maps) + "|";
  return text;
}

bool samePaint(const CharacterSpec& a, const CharacterSpec& b) {
  return mapsText(a.maps) == mapsText(b.maps) && writeCurves(a.curves) == writeCurves(b.curves);
}

// Whether one actor can play both without being made anew, what is painted and pinned apart. All members are named, so
// that a new one does not compile until it is decided.
bool sameCast(const CharacterSpec& a, const CharacterSpec& b) {
  const auto cast = [](const CharacterSpec& spec) {
    const auto& [motion, parts, body, clip, style, resolution, hair, reverse_faces, fit, mends, position, heading,
                 clip_offset, loop, look, look_before, maps_before, fields_of, pins, ties, attachments, maps, curves,
                 brushed] = spec;
    return std::tuple(motion, parts, body, clip, style, resolution, hair, reverse_faces, fit, mends, position.x(),
                      position.y(), position.z(), heading, loop, writeTies(ties).dump(), wornText(attachments));
  };
  return cast(a) == cast(b);
}

// Whether hair that is painted otherwise can stay, and the timeline with it. The length that was painted is that of the
// moment's shape, where that is one of the mesh that is worn or brings a mesh of its own.
bool staysPainted(const CharacterSpec& spec, const ActorMoment* moment, const Actor& actor) {
  if (mapOf("length", spec.maps) == mapOf("length", actor.spec.maps)) return true;
  if (!moment || moment->shape.positions.empty()) return false;
  return moment->remeshed || sameStructure(moment->shape, actor.haircut->mesh.shape);
}

void paintAnew(const CharacterSpec& spec, const ActorMoment* moment, int index, Demo& demo) {
  const CharacterSpec& now = demo.actors[static_cast<std::size_t>(index)].spec;
  const bool another_length = mapOf("length", spec.maps) != mapOf("length", now.maps);
  repaint(spec.maps, spec.curves, index, demo);
  if (!another_length || moment->remeshed) return;  // a mesh of its own is brought back as a whole
  reshapeHair(moment->shape.positions, index, demo);
  ownHaircut(demo.actors[static_cast<std::size_t>(index)], demo).painted = moment->shape.positions;
}

// The spec to make an actor of. Pins are left out where they name vertices of a mesh that is brought back only later.
CharacterSpec castable(CharacterSpec spec, const ActorMoment* moment) {
  if (moment && moment->remeshed) spec.pins.clear();
  return spec;
}

// `settle`: what moves does not come back.
void castAnew(const CharacterSpec& spec, const ActorMoment* moment, bool settle, int index, Demo& demo) {
  Actor& old = demo.actors[static_cast<std::size_t>(index)];
  const bool same_motion = spec.motion == old.spec.motion && spec.parts == old.spec.parts;
  Actor fresh = makeActor(castable(spec, moment), demo.scene.playback, demo.asset_cache);
  if (same_motion && spec.clip == old.spec.clip) {
    const ClipLoop loop = fresh.playback.loop;
    fresh.playback = old.playback;
    fresh.playback.loop = loop;
  }
  fresh.playback.paused = old.playback.paused;
  placeActor(fresh, true);
  if (settle) settleInMotion(demo.scene.sim, demo.scene.playback.settle, fresh);
  fresh.context->refreshGradually(true);
  replaceActor(std::move(fresh), index, same_motion, demo);
}

// The hair in the shape that it had, where the head is now.
void bringBack(const ActorMoment& moment, Actor& actor) {
  if (moment.playback) {
    const bool paused = actor.playback.paused;
    actor.playback = *moment.playback;
    actor.playback.paused = paused;
    placeActor(actor, false);
  }
  actor.hair = moment.hair;
  const Rigid head = scalpToWorld(actor.body->character, actor.pose);
  if (head.matrix() != moment.head.matrix()) sim::carryAlong(moment.head, head, actor.hair);
  actor.previous_positions = actor.hair.positions;
  actor.coarse.active = false;
}

void bringBackSettings(const EditSide& side, Demo& demo) {
  Scene& scene = demo.scene;
  const double budget = scene.playback.budget_ms, draw_budget = scene.playback.draw_budget_ms;
  scene = side.scene;
  for (std::size_t i = 0; i < demo.actors.size(); ++i) {
    std::vector<PinSpec> pins = std::move(demo.actors[i].spec.pins);
    demo.actors[i].spec = side.cast[i];
    demo.actors[i].spec.pins = std::move(pins);  // until the mesh is back that they are of
    demo.actors[i].playback.speed = scene.playback.speed;
  }
  if (scene.playback.budget_ms != budget) setBudget(1e-3 * scene.playback.budget_ms, demo.governor);
  if (scene.playback.draw_budget_ms != draw_budget)
    setDrawBudget(1e-3 * scene.playback.draw_budget_ms, demo.draw_governor);
  demo.deadline.seconds = 1e-3 * scene.playback.deadline_ms;
  demo.selected = std::clamp(side.selected, 0, static_cast<int>(demo.actors.size()) - 1);
  demo.debug = side.debug;
}

void bringBackView(const Camera& view, Camera& camera) {
  const Camera now = camera;
  camera = view;
  camera.jumped = now.jumped;
  if (view.follow) camera.anchor = now.anchor;
}

// `moving`: what moves as well.
void bringBack(const EditSide& side, bool moving, Demo& demo) {
  demo.loading.unwanted = demo.loading.running.valid();
  const auto momentOf = [&](std::size_t i) { return side.moments.empty() ? nullptr : &side.moments[i]; };
  if (side.cast.size() != demo.actors.size()) {
    const bool paused = demo.paused;
    Scene scene = side.scene;
    scene.characters.clear();
    for (std::size_t i = 0; i < side.cast.size(); ++i) scene.characters.push_back(castable(side.cast[i], momentOf(i)));
    replaceScene(openScene(std::move(scene), demo.aspect), demo);
    demo.paused = paused;
  } else {
    for (std::size_t i = 0; i < demo.actors.size(); ++i) {
      const Haircut& worn = *demo.actors[i].haircut;
      const ActorMoment* moment = momentOf(i);
      const bool another_shape =
          moment && ((worn.edited && moment->shape.positions.empty()) || (worn.remeshed && !moment->remeshed));
      const CharacterSpec &spec = side.cast[i], &now = demo.actors[i].spec;
      const bool painted = !samePaint(spec, now);
      if (another_shape || !sameCast(spec, now) || (painted && !staysPainted(spec, moment, demo.actors[i])))
        castAnew(spec, moment, !moment || !moving, static_cast<int>(i), demo);
      else if (painted)
        paintAnew(spec, moment, static_cast<int>(i), demo);
    }
  }
  bringBackSettings(side, demo);
  for (std::size_t i = 0; i < side.moments.size(); ++i) {
    const ActorMoment& moment = side.moments[i];
    if (moment.remeshed) {
      bringBackShape(moment.shape, moment.sag, static_cast<int>(i), demo);
    } else if (moment.hair.positions.size() != demo.actors[i].hair.positions.size()) {
      continue;
    } else if (!moment.shape.positions.empty() &&
               moment.shape.positions != demo.actors[i].haircut->mesh.shape.positions) {
      reshapeHair(moment.shape.positions, static_cast<int>(i), demo);
    }
    if (moment.frozen != demo.actors[i].haircut->frozen) freezeHair(moment.frozen, static_cast<int>(i), demo);
    if (moving) bringBack(moment, demo.actors[i]);
    demo.actors[i].shown_still = false;
    wakeAll(demo.actors[i]);
  }
  for (std::size_t i = 0; i < demo.actors.size(); ++i) repin(side.cast[i].pins, demo.actors[i]);
  if (side.camera) bringBackView(*side.camera, demo.camera);
  demo.shown_fraction = -1;
}

// Changes the two sides of a step over. `history`: the step's, while it is not the demo's.
void swapSides(EditStep& step, EditHistory& history, Demo& demo) {
  const int reach = reachOf(step.request, *kindOf(step.request.what));
  EditSide now = sideOf(demo, reach);
  now.moment = history.moment;
  const std::string name = demo.scene.name, file = demo.scene.file;
  const bool moving = step.other.moment == history.moment || reach & (kOfMotion | kOfSwing);
  bringBack(step.other, moving, demo);
  if (reach & kOfMotion) history.moment = step.other.moment;
  // What the scene was saved as since stays, unless the step opened another.
  const bool opened = step.request.what == Ask::kSceneFile || step.request.what == Ask::kOpenProject;
  if (!opened) demo.scene.name = name, demo.scene.file = file;
  step.other = std::move(now);
}

// That there is nothing to go to is no fault.
void notice(const std::string& words, Demo& demo) {
  demo.message = words;
  demo.message_is_fault = false;
}

// Takes back the last edit that waits for what is being loaded, and says so; false where none does.
bool dropHeld(Demo& demo) {
  std::vector<HeldRequest>& held = demo.loading.held;
  const auto isEdit = [](const HeldRequest& one) { return kindOf(one.request.what) != nullptr; };
  auto end = std::find_if(held.rbegin(), held.rend(), isEdit).base();
  if (end == held.begin()) return false;
  const Request last = std::prev(end)->request;
  const EditKind& kind = *kindOf(last.what);
  auto begin = std::prev(end);
  const auto sameGesture = [&](const Request& one) { return one.what == last.what && one.name == last.name; };
  while (kind.drags && begin != held.begin() && sameGesture(std::prev(begin)->request)) --begin;
  held.erase(begin, end);
  notice("undone: " + titleOf(last, kind), demo);
  return true;
}

}  // namespace

std::size_t EditSide::bytes() const {
  std::size_t bytes = sizeof(EditSide) + 4 * cast.size() * sizeof(CharacterSpec);
  for (const CharacterSpec& spec : cast) bytes += 2 * spec.brushed.size();  // the scene has it too
  for (const ActorMoment& one : moments) {
    const std::size_t vertices = one.hair.positions.size();
    bytes += vertices * 4 * sizeof(sim::Vec3) * 4;  // positions, velocities, those before, and about thrice of memory
  }
  return bytes;
}

std::optional<EditStep> beginEdit(const Request& request, const Demo& demo) {
  const EditKind* kind = kindOf(request.what);
  const bool begins = request.what == Ask::kOpenProject && request.value != 0;
  if (!kind || begins) return {};
  const bool further = kind->drags && goesOn(request.what, demo.edits);
  if (further && demo.edits.steps.back().request.name == request.name)
    return EditStep{titleOf(request, *kind), request, {}};
  return EditStep{titleOf(request, *kind), request, sideOf(demo, reachOf(request, *kind))};
}

void commitEdit(EditStep step, bool later, EditHistory& history) {
  const bool goes_on = step.other.cast.empty();
  history.gesture = kindOf(step.request.what)->drags;
  if (goes_on) {
    history.steps.back().title = std::move(step.title);
    return;
  }
  history.dropped.clear();
  const auto undone = history.steps.begin() + static_cast<std::ptrdiff_t>(history.done);
  if (later) history.dropped.assign(std::move_iterator(undone), std::move_iterator(history.steps.end()));
  history.steps.resize(history.done);
  step.number = history.next++;
  const bool opens = step.request.what == Ask::kOpenProject || step.request.what == Ask::kSceneFile;
  if (opens) history.saved = step.number;
  history.steps.push_back(std::move(step));
  std::size_t bytes = 0, keep = history.steps.size();
  while (keep > 0 && (bytes += history.steps[keep - 1].other.bytes()) <= kMaxEditBytes) --keep;
  keep = std::min(keep, history.steps.size() - 1);
  history.forgot = history.forgot || keep > 0;
  history.steps.erase(history.steps.begin(), history.steps.begin() + static_cast<std::ptrdiff_t>(keep));
  history.done = history.steps.size();
}

bool goesOn(Ask what, const EditHistory& history) {
  return history.gesture && history.done == history.steps.size() && history.done > 0 &&
         history.steps.back().request.what == what;
}

void forgetEdit(long number, EditHistory& history) {
  const auto at = std::ranges::find(history.steps, number, &EditStep::number);
  if (at == history.steps.end()) return;
  const bool last = at == std::prev(history.steps.end());
  history.done -= at - history.steps.begin() < static_cast<std::ptrdiff_t>(history.done);
  history.steps.erase(at);
  if (!last) return;
  std::ranges::move(history.dropped, std::back_inserter(history.steps));
  history.dropped.clear();
}

int heldEdits(const BackgroundLoad& loading) {
  int edits = 0;
  const Request* before = nullptr;
  for (const auto& [request, actor] : loading.held) {
    const EditKind* kind = kindOf(request.what);
    const bool further = kind && kind->drags && before && before->what == request.what && before->name == request.name;
    edits += kind && !further;
    before = &request;
  }
  return edits;
}

void undoEdits(int count, Demo& demo) {
  while (count > 0 && dropHeld(demo)) --count;
  if (count == 0) return;
  if (demo.edits.done == 0)
    return notice(demo.edits.forgot ? "nothing more to undo: what was done before is no longer kept"
                                    : "nothing to undo: this is where the scene was opened",
                  demo);
  for (; count > 0 && demo.edits.done > 0; --count) {
    // Taken out: the demo may be replaced by another scene's.
    EditHistory history = std::exchange(demo.edits, {});
    EditStep& step = history.steps[history.done - 1];
    // What is still being loaded for the step will not be: there is nothing to do again.
    const bool loading = demo.loading.running.valid();
    const std::string title = step.title;
    try {
      swapSides(step, history, demo);
      --history.done;
      if (loading) history.steps.resize(history.done);
    } catch (...) {
      demo.edits = std::move(history);
      throw;
    }
    notice("undone: " + title, demo);
    history.gesture = false;
    demo.edits = std::move(history);
  }
}

void redoEdits(int count, Demo& demo) {
  if (demo.edits.done == demo.edits.steps.size())
    return notice("nothing to redo: nothing was undone since the last change", demo);
  for (; count > 0 && demo.edits.done < demo.edits.steps.size(); --count) {
    EditHistory history = std::exchange(demo.edits, {});
    EditStep& step = history.steps[history.done];
    try {
      swapSides(step, history, demo);
      ++history.done;
    } catch (...) {
      demo.edits = std::move(history);
      throw;
    }
    notice("done again: " + step.title, demo);
    history.gesture = false;
    demo.edits = std::move(history);
  }
}

std::string editHash(const Demo& demo) {
  std::string text = writeScene(presentScene(demo)) + std::to_string(demo.selected);
  for (const DebugView& view : kDebugViews) text += demo.debug.*view.on ? "1" : "0";
  for (const Skip& skip : skipTable()) text += demo.scene.skips[skip.id] ? "1" : "0";
  for (const Actor& actor : demo.actors) text.append(1, ' ').append(sim::numberText(actor.playback.time));
  std::uint64_t hash = 0xcbf29ce484222325ull;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3ull;
  return std::to_string(hash) + "-" + stateHash(demo);
}

}  // namespace app
