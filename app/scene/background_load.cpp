#include "app/scene/background_load.h"

#include <algorithm>
#include <chrono>
#include <functional>
#include <utility>

#include "app/scene/attachments.h"
#include "app/scene/demo.h"

namespace app {

struct Loaded {
  LoadOrder order;
  std::optional<Demo> demo;  // of a scene
  AssetCache asset_cache;    // of a character
  std::optional<Actor> actor;
};

namespace {

constexpr std::size_t kMaxFileEnds = 100;  // runs without a window look at none

// What changes or saves a character and its hair.
constexpr Ask kWaiting[] = {Ask::kStyle,     Ask::kResolution,  Ask::kHairFile,   Ask::kHairMends, Ask::kMotionFile,
                            Ask::kSceneFile, Ask::kTie,         Ask::kPin,        Ask::kAttach,    Ask::kMap,
                            Ask::kBrush,     Ask::kMove,        Ask::kMesh,       Ask::kPaint,     Ask::kCurve,
                            Ask::kClip,      Ask::kBody,        Ask::kLoop,       Ask::kSaveScene, Ask::kSaveState,
                            Ask::kLoadState, Ask::kSaveProject, Ask::kOpenProject};

// What the next choice replaces as a whole.
constexpr Ask kChosenAnew[] = {Ask::kStyle,      Ask::kResolution, Ask::kHairFile,
                               Ask::kMotionFile, Ask::kBody,       Ask::kSceneFile};

// The file that the step of that number has asked for; empty where it was undone.
std::string fileOf(long edit, const EditHistory& history) {
  const auto at = std::ranges::find(history.steps, edit, &EditStep::number);
  return at == history.steps.end() ? "" : at->request.text;
}

// On the thread: touches nothing but what it makes.
std::unique_ptr<Loaded> load(LoadOrder order) {
  auto loaded = std::make_unique<Loaded>();
  const PlaybackSpec& playback = order.scene.playback;
  if (order.spec) {
    Actor actor = makeActor(*order.spec, playback, loaded->asset_cache);
    if (order.same_motion) actor.playback = order.playback;
    settleInMotion(order.scene.sim, playback.settle, actor);
    actor.context->refreshGradually(true);
    loaded->actor = std::move(actor);
  } else {
    loaded->demo = openScene(std::move(order.scene), order.aspect);
  }
  loaded->order = std::move(order);
  return loaded;
}

void start(LoadOrder order, Demo& demo) {
  demo.loading.title = order.title;
  demo.loading.edit = order.edit;
  demo.loading.unwanted = false;
  demo.message = "loading " + order.title;
  demo.message_is_fault = false;
  demo.loading.running = std::async(std::launch::async, load, std::move(order));
}

// The old one has moved on since the order was given: the new one is carried to where it is now.
void recastLoaded(Loaded& loaded, Demo& demo) {
  if (loaded.order.actor >= static_cast<int>(demo.actors.size())) return;
  Actor& old = demo.actors[loaded.order.actor];
  Actor fresh = std::move(*loaded.actor);
  for (auto& body : loaded.asset_cache.bodies) demo.asset_cache.bodies.push_back(std::move(body));
  for (auto& haircut : loaded.asset_cache.haircuts) demo.asset_cache.haircuts.push_back(std::move(haircut));
  for (auto& scalp : loaded.asset_cache.covers) demo.asset_cache.covers.push_back(std::move(scalp));
  for (auto& one : loaded.asset_cache.attachments) demo.asset_cache.attachments.push_back(std::move(one));
  fresh.playback.speed = old.playback.speed;
  fresh.playback.paused = old.playback.paused;
  if (old.spec.look != loaded.order.look) fresh.spec.look = old.spec.look;
  if (loaded.order.same_motion) {
    fresh.playback = old.playback;
    placeActor(fresh, false);
  }
  replaceActor(std::move(fresh), loaded.order.actor, loaded.order.same_motion, demo);
}

}  // namespace

std::string loadingNote(const Demo& demo) {
  if (demo.loading.running.valid()) {
    const bool more = std::ranges::any_of(
        demo.loading.held, [](const HeldRequest& held) { return held.request.what != Ask::kEndGesture; });
    return "loading " + demo.loading.title + (more ? ", then what was asked for since" : "");
  }
  const bool parts =
      std::ranges::any_of(demo.actors, [](const Actor& actor) { return actor.body->parts_coming.valid(); });
  return parts ? "making the signed distances of the body" : "";
}

void loadLater(LoadOrder order, Demo& demo) {
  order.edit = demo.edits.next;
  start(std::move(order), demo);
}

bool holdBack(const Request& request, Demo& demo) {
  BackgroundLoad& loading = demo.loading;
  if (!loading.running.valid() && loading.held.empty()) return false;
  const bool ends_held = request.what == Ask::kEndGesture && !loading.held.empty();
  if (!ends_held && std::ranges::find(kWaiting, request.what) == std::end(kWaiting)) return false;
  const bool choice = std::ranges::find(kChosenAnew, request.what) != std::end(kChosenAnew);
  const bool again = choice && !loading.held.empty() && loading.held.back().request.what == request.what &&
                     loading.held.back().actor == demo.selected;
  if (again) loading.held.pop_back();
  loading.held.push_back({request, demo.selected});
  return true;
}

std::optional<HeldRequest> nextHeld(BackgroundLoad& loading) {
  if (loading.running.valid() || loading.held.empty()) return {};
  HeldRequest next = std::move(loading.held.front());
  loading.held.erase(loading.held.begin());
  return next;
}

bool comesLater(long edit, const BackgroundLoad& loading) {
  return loading.running.valid() && loading.edit == edit;
}

const Request* comingRequest(Ask what, const Demo& demo) {
  const BackgroundLoad& loading = demo.loading;
  for (auto held = loading.held.rbegin(); held != loading.held.rend(); ++held) {
    if (held->request.what == what && held->actor == demo.selected) return &held->request;
  }
  const auto step = std::ranges::find(demo.edits.steps, loading.edit, &EditStep::number);
  const bool comes = loading.running.valid() && !loading.unwanted && step != demo.edits.steps.end();
  return comes && step->request.what == what ? &step->request : nullptr;
}

void noteFileEnd(const std::string& file, bool done, Demo& demo) {
  if (!file.empty() && demo.file_ends.size() < kMaxFileEnds) demo.file_ends.push_back({file, done});
}

namespace {

void takeLoaded(Demo& demo) {
  BackgroundLoad& loading = demo.loading;
  if (!loading.running.valid() || loading.running.wait_for(std::chrono::seconds(0)) != std::future_status::ready)
    return;
  const std::string file = loading.unwanted ? "" : fileOf(loading.edit, demo.edits);
  try {
    const std::unique_ptr<Loaded> loaded = loading.running.get();
    const std::string title = loaded->order.title;
    if (loading.unwanted) {
      // Nothing of it is used.
    } else if (loaded->demo) {
      replaceScene(std::move(*loaded->demo), demo);
    } else {
      recastLoaded(*loaded, demo);
    }
    const std::string notes = hairNotes(demo.actors);
    demo.message = notes.empty() ? title : notes;
    demo.message_is_fault = false;
    noteFileEnd(file, true, demo);
  } catch (const std::exception& fault) {
    demo.message = fault.what();
    demo.message_is_fault = true;
    noteFileEnd(file, false, demo);
    forgetEdit(loading.edit, demo.edits);
  }
  demo.shown_fraction = -1;  // what was loaded is shown though time may stand still
}

}  // namespace

void installLoaded(Demo& demo) {
  takeLoaded(demo);
  if (demo.loading.running.valid()) return;
  for (Actor& actor : demo.actors) {
    if (drawInPlace(actor)) demo.shown_fraction = -1;
  }
}

void followColliders(Demo& demo) {
  if (!demo.loading.on || demo.scene.sim.collider != sim::ColliderKind::kSdf) return;
  for (Actor& actor : demo.actors) {
    LoadedBody& body = *actor.body;
    if (body.has_parts) continue;
    if (!body.parts_coming.valid()) {
      body.parts_coming = std::async(std::launch::async, partDistances, std::cref(body.character));
      demo.message = "making the signed distances of the body";
      demo.message_is_fault = false;
    }
    if (body.parts_coming.wait_for(std::chrono::seconds(0)) != std::future_status::ready) continue;
    body.has_parts = true;
    try {
      body.parts = body.parts_coming.get();
      demo.message = "signed distances of the body";
      demo.message_is_fault = false;
    } catch (const std::exception& fault) {
      demo.message = std::string("no signed distances, the ellipsoids stay: ") + fault.what();
      demo.message_is_fault = true;
    }
    for (Actor& wearer : demo.actors) {
      if (wearer.body == &body) wakeAll(wearer);
    }
  }
}

void replaceActor(Actor fresh, int index, bool same_motion, Demo& demo) {
  Actor& old = demo.actors[static_cast<std::size_t>(index)];
  fresh.jumped = old.jumped;
  old = std::move(fresh);
  tidy(demo.actors, demo.asset_cache);
  beginAnew(demo.timeline);
  const CameraSpec& camera = demo.scene.camera;
  if (index != 0 || same_motion || !demo.camera.follow) return;
  if (camera.eye && camera.target) {
    lookAtHead(old, demo.camera);
  } else {
    frameFigure(camera.framing, old, demo.aspect, demo.camera);
  }
}

void replaceScene(Demo fresh, Demo& demo) {
  fresh.debug = demo.debug;
  fresh.capture = demo.capture;
  fresh.picture_height = demo.picture_height;
  fresh.governor.counted = demo.governor.counted;
  fresh.deadline.counted = demo.deadline.counted;
  fresh.loading = std::move(demo.loading);
  fresh.requests = std::move(demo.requests);
  fresh.file_ends = std::move(demo.file_ends);
  fresh.edits = std::move(demo.edits);
  fresh.timeline.on = demo.timeline.on;
  // A scene without any leaves those there are.
  const auto isKept = [](const std::optional<Camera>& one) { return one.has_value(); };
  if (std::none_of(fresh.bookmarks.begin(), fresh.bookmarks.end(), isKept)) fresh.bookmarks = demo.bookmarks;
  fresh.message = "scene " + fresh.scene.name;
  demo = std::move(fresh);
}

}  // namespace app
