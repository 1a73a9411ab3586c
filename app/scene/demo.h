// THE STORY of a frame: advanceFrame. The window and the headless run call it alike; only who makes the context and who
// reads the pixels differs.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "app/files/scene_file.h"
#include "app/motion/fixed_clock.h"
#include "app/scene/actor.h"
#include "app/scene/background_load.h"
#include "app/scene/comparison.h"
#include "app/scene/detail/deadline.h"
#include "app/scene/detail/draw_governor.h"
#include "app/scene/detail/governor.h"
#include "app/scene/edit/edit_history.h"
#include "app/scene/frame_stats.h"
#include "app/scene/record/timeline.h"
#include "app/scene/request.h"
#include "app/scene/view/camera.h"
#include "app/scene/view/debug_views.h"
#include "render/picture_pair.h"
#include "render/renderer.h"

namespace app {

// Pictures that were asked for; whoever owns the context takes them after the frame.
struct Capture {
  bool screenshot = false;
  std::string screenshot_file;  // empty: the next free name
  bool recording = false;
  std::string folder;  // of the recording
  int recorded = 0;    // frames so far
  bool hair = false;   // the simulated hair is written, see platform/hair_recorder.h
  std::string hair_file;
};

struct Demo {
  Scene scene;
  AssetCache asset_cache;
  std::vector<Actor> actors;
  int selected = 0;
  Camera camera;
  double aspect = 16.0 / 9;    // of the picture
  int picture_height = 720;    // pixels; what is far is what is small in it
  ViewPlace place;             // of the camera's view in the picture
  Vec3 origin = Vec3::Zero();  // m, of what is handed to the renderer
  double shown_fraction = -1;  // of the step, when positions were last handed over
  DebugViews debug;
  FixedClock clock;
  Governor governor;
  DrawGovernor draw_governor;
  Deadline deadline;
  sim::SimParams running;  // the scene's parameters as the governor lets them run
  long frames = 0;         // shown since the scene began
  double shown_time = 0;   // s that were simulated up to what is shown
  bool paused = false;
  int single_steps = 0;  // asked for while paused

  EditHistory edits;
  Timeline timeline;
  Comparison comparison;
  std::array<std::optional<Camera>, 4> bookmarks;
  double turntable = 0;  // rad/s
  BackgroundLoad loading;
  std::vector<Request> requests;  // applied at the start of the next frame
  std::string message;            // the last fault or success, for the window
  bool message_is_fault = false;
  std::pair<Ask, std::string> refused{Ask::kCount, ""};  // and its message, which goes when another such succeeds
  std::vector<FileEnd> file_ends;                        // since the window has last looked
  Capture capture;

  FrameStats stats;                 // of the last frame
  std::vector<FrameStats> history;  // ring of the last kHistoryLength frames
  std::size_t history_next = 0;

  // Scratch of the drawing, kept so that frames do not allocate.
  DebugGeometry debug_geometry;
  std::vector<render::HairInput> hair_inputs;
  std::vector<std::vector<float>> drawn_hair;    // an actor: what its hair input points to, of plaits and grooms
  std::vector<std::vector<render::Mat4>> bands;  // an actor: of its ties and its plaits' ends
  std::vector<render::BodyInput> body_inputs;
};

inline constexpr std::size_t kHistoryLength = 240;

// Where a frame is drawn. Without a renderer nothing is.
struct FrameTarget {
  render::Renderer* renderer = nullptr;
  int width = 0, height = 0;
  unsigned framebuffer = 0;
  std::vector<unsigned char>* pixels = nullptr;  // when given: drawn offscreen and read back, RGBA, top row first
  bool measure = false;                          // stage times of the drawing
  std::function<void(Demo&)> draw_panels;        // empty: there are none
  render::PicturePair* pair = nullptr;           // without it comparisons show the first picture alone
  PicturePart free = {};                         // what panels leave to the figure
};

// Loads a scene and lets the hair come to rest. With `beside`, what can follow later is loaded beside the frames from
// now on. Throws InputError.
Demo openScene(Scene scene, double aspect, bool beside = false);

// The rows of the tables as they are now become what Scene::base has.
void keepBase(Demo& demo);

// Advances by `seconds` of wall time and draws. Faults of requests become the demo's message; what was loaded stays.
void advanceFrame(Demo& demo, double seconds, const FrameTarget& target);

// A frame of the past once more, without a picture and without being kept or counted; below 0 s a single step.
void simulateAgain(double seconds, Demo& demo);

// What was found of hair mesh files that do not fit their heads; empty when all fit.
std::string hairNotes(std::span<const Actor> actors);

// Draws the demo as it is; advanceFrame does.
void drawFrame(Demo& demo, const FrameTarget& target);

// What advanceFrame hands to the renderer; spans point into the demo.
render::FrameInput frameInput(Demo& demo, int width, int height);

// Adds each count of a drawn frame to its row of the table of skips.
void addDrawing(const render::DrawSkipCounts& drawing, SkipCounts& counts);

// Applies and clears demo.requests. See apply_requests.cpp.
void applyRequests(Demo& demo);

// Shows a success, or what is worth knowing, until the next one. See apply_requests.cpp.
void showMessage(const std::string& text, Demo& demo);

inline Actor& selectedActor(Demo& demo) {
  return demo.actors[demo.selected];
}
inline const Actor& selectedActor(const Demo& demo) {
  return demo.actors[demo.selected];
}

}  // namespace app
