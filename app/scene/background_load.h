// Scenes, characters and the signed distances of bodies loaded on threads of their own, so that what is shown goes on
// meanwhile. Only the window loads so; headless runs and tests load at once, between two frames.
#pragma once

#include <future>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/files/scene_file.h"
#include "app/motion/playback.h"
#include "app/scene/request.h"

namespace app {

struct Actor;
struct Demo;
struct Loaded;  // what a thread brings back

// A scene to open or, with `spec`, a character to replace.
struct LoadOrder {
  std::string title;  // for messages
  Scene scene;        // with `spec`: its simulation and playback alone count
  double aspect = 1;
  std::optional<CharacterSpec> spec;
  int actor = 0;             // that `spec` replaces
  bool same_motion = false;  // it goes on where the old one is in its clip
  Playback playback;         // of the old one when the order was given
  CharacterLook look;        // and its look then
  long edit = 0;             // number of the step that asks for it
};

// A request that waits for what is being loaded.
struct HeldRequest {
  Request request;
  int actor = 0;  // that was selected when it was asked for
};

struct BackgroundLoad {
  bool on = false;
  std::string title;              // of what `running` brings
  long edit = 0;                  // and number of the step that asked for it
  bool unwanted = false;          // it is dropped when it comes: what asked for it was undone
  std::vector<HeldRequest> held;  // in order
  std::future<std::unique_ptr<Loaded>> running;
};

// What is being loaded, in words; empty when nothing is.
std::string loadingNote(const Demo& demo);

// Starts loading for the step that is being applied. Nothing else may be on its way.
void loadLater(LoadOrder order, Demo& demo);

// Holds a request back that changes or saves what is being loaded, so that none is lost; false where it need not wait.
// Of several in a row that choose the same thing the last one stays.
bool holdBack(const Request& request, Demo& demo);

// The first request that was held back, once nothing is being loaded.
std::optional<HeldRequest> nextHeld(BackgroundLoad& loading);

// Whether what the step of that number asks for is still being loaded.
bool comesLater(long edit, const BackgroundLoad& loading);

// What is asked for last of what waits and of what is being loaded, of a kind; null where nothing of it is on its way.
const Request* comingRequest(Ask what, const Demo& demo);

// Notes what became of a file, for the window.
void noteFileEnd(const std::string& file, bool done, Demo& demo);

// Puts in place what has been loaded, if anything has; a fault becomes the demo's message and changes nothing else.
// Where nothing is being loaded any more, what is worn is drawn in its place again.
void installLoaded(Demo& demo);

// Where signed distances are collided with: starts making those that are missing, and takes over those that are made.
// Until then the bodies are their ellipsoids. Does nothing unless loading beside the frames is on.
void followColliders(Demo& demo);

// Puts an actor in another one's place. With another motion the camera, if it follows the actor, frames it anew.
void replaceActor(Actor fresh, int index, bool same_motion, Demo& demo);

// Opens `scene` in the demo's place; what belongs to the window rather than to the scene stays.
void replaceScene(Demo fresh, Demo& demo);

}  // namespace app
