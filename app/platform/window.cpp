#include "app/platform/window.h"

// GLEW must come before anything that includes OpenGL's own header.
#include <GL/glew.h>
#include <GLFW/glfw3.h>
#include <imgui/backends/imgui_impl_glfw.h>
#include <imgui/backends/imgui_impl_opengl3.h>
#include <imgui/imgui.h>

#include <algorithm>
#include <array>
#include <cfloat>
#include <cmath>
#include <functional>
#include <iostream>
#include <limits>
#include <optional>
#include <utility>

#include "app/debug_option.h"
#include "app/files/data_path.h"
#include "app/files/errors.h"
#include "app/files/output_file.h"
#include "app/files/recording.h"
#include "app/files/report.h"
#include "app/platform/capture.h"
#include "app/platform/hair_recorder.h"
#include "app/platform/interrupt.h"
#include "app/platform/opening.h"
#include "app/platform/preset_pictures.h"
#include "app/platform/shader_reload.h"
#include "app/scene/demo.h"
#include "app/scene/demo_state.h"
#include "app/scene/detail/level_of_detail.h"
#include "app/scene/project.h"
#include "app/scene/view/light_drag.h"
#include "app/scene/view/look_params.h"
#include "app/ui/input_queue.h"
#include "app/ui/part_glide.h"
#include "app/ui/redraw_throttle.h"
#include "app/ui/ui.h"
#include "app/ui/ui_panels.h"

namespace app {

namespace {

constexpr long kFirstFrames = 2;  // in which the panels find their sizes
constexpr int kEndless = std::numeric_limits<int>::max();

std::string glfw_fault;  // GLFW reports through a callback without user data

struct WindowSystem {
  WindowSystem() {
    glfwSetErrorCallback([](int, const char* words) { glfw_fault = words; });
    if (!glfwInit()) {
      throw ContextError("no window system answers (" + glfw_fault +
                         "); set DISPLAY or WAYLAND_DISPLAY, or render to files with --headless");
    }
  }
  ~WindowSystem() { glfwTerminate(); }
  WindowSystem(const WindowSystem&) = delete;
  WindowSystem& operator=(const WindowSystem&) = delete;
};

struct Window {
  GLFWwindow* handle = nullptr;
  Window(int width, int height) {
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 4);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 5);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
    handle = glfwCreateWindow(width, height, "hairmesh", nullptr, nullptr);
    if (!handle) {
      throw ContextError("no OpenGL 4.5 core context in a window (" + glfw_fault +
                         "); update the graphics driver, or try LIBGL_ALWAYS_SOFTWARE=1 or --headless");
    }
    glfwMakeContextCurrent(handle);
    glfwSwapInterval(1);
    if (const std::string fault = render::initGl(); !fault.empty()) throw ContextError(fault);
  }
  ~Window() {
    if (handle) glfwDestroyWindow(handle);
  }
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;
};

// What the window's callbacks reach.
struct Session {
  Demo& demo;
  UiState& ui;
  InputQueue input = {};
  PartGlide glide = {};  // of the figure's part of the window
  double mouse_x = 0, mouse_y = 0;
  std::array<bool, 5> buttons{};    // that are down in this frame, for the panels
  std::optional<ImVec2> pointer{};  // where one of them changed in this frame, px
  double drag_x = 0, drag_y = 0;    // px, moved with a button that no frame has seen yet
  long events = 0;                  // of the mouse, keys and files, that have come
  double light_x = 0, light_y = 0;  // where a drag of the key light began
  render::Float3 light_from{};      // the way to it there
  bool other_scale = false;         // the window has come to a display of another density
};

Session& session(GLFWwindow* window) {
  return *static_cast<Session*>(glfwGetWindowUserPointer(window));
}

bool pressed(GLFWwindow* window, int button) {
  return glfwGetMouseButton(window, button) == GLFW_PRESS;
}

// Pixels of the mouse that the camera's view is high.
double viewHeight(GLFWwindow* window, const Demo& demo) {
  int width = 1, height = 1;
  glfwGetWindowSize(window, &width, &height);
  return demo.place.zoom * std::max(1, height);
}

// A drag of the key light to (x, y). Several moves may come in one frame: each counts from where the drag began.
void turnLight(double x, double y, double height, Session& s) {
  SceneLook look = s.demo.scene.look;
  if (!std::exchange(s.ui.light_held, true)) {
    s.light_x = x, s.light_y = y;
    s.light_from = look.light.to_light;
  }
  look.light.to_light = turnedLight(s.light_from, x - s.light_x, y - s.light_y, height);
  const SceneField& row = *findSceneField("to_light");
  s.demo.requests.push_back({Ask::kSetParam, row.name, lookText(look, row)});
}

bool anyButton(const Session& s) {
  return s.buttons[GLFW_MOUSE_BUTTON_LEFT] || s.buttons[GLFW_MOUSE_BUTTON_RIGHT] || s.buttons[GLFW_MOUSE_BUTTON_MIDDLE];
}

// With the buttons that the last frame has seen, unless panels, brush or line took them.
void dragView(GLFWwindow* window, double dx, double dy, Session& s) {
  const bool left = s.buttons[GLFW_MOUSE_BUTTON_LEFT];
  const bool brushes = s.ui.line_held || s.ui.brush.stroking || (s.ui.brush.over_hair && left);
  if (ImGui::GetIO().WantCaptureMouse || brushes) return;
  const double height = viewHeight(window, s.demo);
  const auto held = [&](int key, int other) {
    return glfwGetKey(window, key) == GLFW_PRESS || glfwGetKey(window, other) == GLFW_PRESS;
  };
  const bool control = held(GLFW_KEY_LEFT_CONTROL, GLFW_KEY_RIGHT_CONTROL);
  if (control && left) return turnLight(s.mouse_x, s.mouse_y, height, s);
  const bool shift = held(GLFW_KEY_LEFT_SHIFT, GLFW_KEY_RIGHT_SHIFT);
  if (s.buttons[GLFW_MOUSE_BUTTON_RIGHT] || s.buttons[GLFW_MOUSE_BUTTON_MIDDLE] || (shift && left)) {
    pan(dx, dy, height, s.demo.camera);
  } else if (left) {
    orbit(dx, dy, height, s.demo.camera);
  }
}

// What a button drags is known when a frame has seen where it was pressed.
void onMouseMove(GLFWwindow* window, double x, double y) {
  Session& s = session(window);
  const double dx = x - s.mouse_x, dy = y - s.mouse_y;
  s.mouse_x = x, s.mouse_y = y, ++s.events;
  constexpr std::array kDrags{GLFW_MOUSE_BUTTON_LEFT, GLFW_MOUSE_BUTTON_RIGHT, GLFW_MOUSE_BUTTON_MIDDLE};
  if (std::ranges::none_of(kDrags, [&](int button) { return pressed(window, button); })) return;
  if (anyButton(s)) return dragView(window, dx, dy, s);
  s.drag_x += dx, s.drag_y += dy;
}

void dragAsSeen(GLFWwindow* window, Session& s) {
  if (anyButton(s) && (s.drag_x != 0 || s.drag_y != 0)) dragView(window, s.drag_x, s.drag_y, s);
  if (anyButton(s) || s.input.empty()) s.drag_x = s.drag_y = 0;  // else the press is yet to be seen
}

void onScroll(GLFWwindow* window, double, double notches) {
  ++session(window).events;
  if (!ImGui::GetIO().WantCaptureMouse) zoom(notches, session(window).demo.camera);
}

void onKey(GLFWwindow* window, int key, int, int action, int modifiers) {
  const bool closes = key == kKeyEscape && session(window).ui.browser.what != BrowseFor::kNothing;
  if (action == GLFW_RELEASE || (panelsTakeKey(key) && !closes)) return;
  // Only what is meant to repeat does while a key is held.
  if (action == GLFW_REPEAT && key != '.' && key != '-' && key != '=') return;
  Session& s = session(window);
  const int held = (modifiers & GLFW_MOD_SHIFT ? kShift : 0) | (modifiers & GLFW_MOD_CONTROL ? kControl : 0);
  pressKey(key, s.demo, s.ui, held);
}

void queueKey(GLFWwindow* window, int key, int scancode, int action, int modifiers) {
  ++session(window).events;
  if (key > 0) session(window).input.add({key, 0, scancode, action, modifiers});
}

void queueCharacter(GLFWwindow* window, unsigned character) {
  session(window).input.add({0, character});
}

void queueButton(GLFWwindow* window, int button, int action, int) {
  Session& s = session(window);
  ++s.events;
  if (button < static_cast<int>(s.buttons.size()))
    s.input.add({mouseKey(button), 0, 0, action, 0, s.mouse_x, s.mouse_y});
}

void feedButton(const InputEvent& event, Session& s) {
  s.buttons[static_cast<std::size_t>(mouseKey(event.key))] = event.action != GLFW_RELEASE;
  s.pointer = ImVec2(static_cast<float>(event.x), static_cast<float>(event.y));
}

// What one frame can take of the keys and buttons that have come; see InputQueue.
void feedInput(GLFWwindow* window) {
  session(window).pointer.reset();
  session(window).input.feed([&](const InputEvent& event) {
    if (event.key < 0) return feedButton(event, session(window));
    if (event.key == 0) return ImGui_ImplGlfw_CharCallback(window, event.character);
    onKey(window, event.key, event.scancode, event.action, event.modifiers);
    ImGui_ImplGlfw_KeyCallback(window, event.key, event.scancode, event.action, event.modifiers);
  });
}

void onDrop(GLFWwindow* window, int count, const char** files) {
  Session& s = session(window);
  ++s.events;
  for (int i = 0; i < count; ++i) openFile(files[i], s.demo, s.ui);
}

void onClose(GLFWwindow* window) {
  Session& s = session(window);
  ++s.events;
  if (!mayClose(s.demo, s.ui)) glfwSetWindowShouldClose(window, GLFW_FALSE);
}

void onScale(GLFWwindow* window, float, float) {
  session(window).other_scale = true;
}

// Dear ImGui's context and its two backends.
struct PanelBackends {
  explicit PanelBackends(GLFWwindow* window) {
    IMGUI_CHECKVERSION();
    ImGui::CreateContext();
    ImGui_ImplGlfw_InitForOpenGL(window, true);
    ImGui_ImplOpenGL3_Init("#version 450");
  }
  ~PanelBackends() {
    ImGui_ImplOpenGL3_Shutdown();
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
  }
  PanelBackends(const PanelBackends&) = delete;
  PanelBackends& operator=(const PanelBackends&) = delete;
};

// The pointer outside of the window points at nothing; a drag goes on there. A button changes where the pointer was.
void beginPanels(GLFWwindow* window) {
  ImGui_ImplOpenGL3_NewFrame();
  ImGui_ImplGlfw_NewFrame();
  ImGuiIO& io = ImGui::GetIO();
  const Session& s = session(window);
  std::ranges::copy(s.buttons, io.MouseDown);
  const bool held = std::ranges::any_of(io.MouseDown, [](bool down) { return down; });
  if (!held && !glfwGetWindowAttrib(window, GLFW_HOVERED)) io.MousePos = {-FLT_MAX, -FLT_MAX};
  if (s.pointer) io.MousePos = *s.pointer;
  ImGui::NewFrame();
}

// Tab bars and boxes take their sizes from the frame before: with two frames that nobody sees the first one is whole.
void layOutPanels(GLFWwindow* window, Demo& demo, UiState& ui) {
  const BuiltInCounts counted = demo.stats.always;
  for (int k = 0; k < 2; ++k) {
    beginPanels(window);
    buildUi(demo, ui);
    ImGui::EndFrame();
  }
  demo.stats.always = counted;
}

void drawPanels(GLFWwindow* window, Demo& demo, UiState& ui) {
  if (demo.frames <= 1) layOutPanels(window, demo, ui);
  beginPanels(window);
  buildUi(demo, ui);
  dragAsSeen(window, session(window));
  ImGui::Render();
  ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
}

void setCallbacks(GLFWwindow* window, Session& s) {
  glfwSetWindowUserPointer(window, &s);
  glfwSetCursorPosCallback(window, onMouseMove);
  glfwSetScrollCallback(window, onScroll);
  glfwSetDropCallback(window, onDrop);
  glfwSetWindowCloseCallback(window, onClose);
  glfwSetWindowContentScaleCallback(window, onScale);
}

// After the panels' backend has set its own: keys and mouse buttons reach it by the queue.
void setKeyCallbacks(GLFWwindow* window) {
  glfwSetKeyCallback(window, queueKey);
  glfwSetCharCallback(window, queueCharacter);
  glfwSetMouseButtonCallback(window, queueButton);
}

float textScale(GLFWwindow* window) {
  float x = 1, y = 1;
  glfwGetWindowContentScale(window, &x, &y);
  return std::clamp(x, 1.0f, 3.0f);
}

// That of the display that the window is on, times what a person has made of it, as far as the window has room.
float wantedTextScale(GLFWwindow* window, double asked, float zoom) {
  int width = 1, height = 1;
  glfwGetFramebufferSize(window, &width, &height);
  return fittingTextScale(textScale(window) * static_cast<float>(asked) * zoom, width, height);
}

void followTextScale(GLFWwindow* window, double asked, Session& s) {
  const float wanted = wantedTextScale(window, asked, s.ui.zoom_texts);
  if (!std::exchange(s.other_scale, false) && std::abs(wanted - s.ui.text_scale) < 1e-3f) return;
  ImGui_ImplOpenGL3_DestroyFontsTexture();
  prepareUi(wanted, s.ui);
  ImGui_ImplOpenGL3_CreateFontsTexture();
}

// The figure stands in the middle of what panels leave free, and glides there unless `at_once`; while something is
// dragged over the picture it stays where it is. What is recorded has no panels, and neither has the window then a part
// that they take. Returns whether it is on its way.
bool leaveFree(GLFWwindow* window, bool at_once, Session& s, FrameTarget& target) {
  int width = 1, height = 1;
  glfwGetWindowSize(window, &width, &height);
  if (width < 1 || s.demo.capture.recording) {
    target.free = s.glide.to({}, now(), true);
    return false;
  }
  if (s.ui.brush.stroking || s.ui.line_held || s.ui.light_held) {
    target.free = s.glide.stay(now());
    return false;
  }
  ImVec2& size = ImGui::GetIO().DisplaySize;
  const ImVec2 before = std::exchange(size, {static_cast<float>(width), static_cast<float>(height)});
  const bool resized = before.x != size.x || before.y != size.y;
  target.free = s.glide.to(freePart(s.demo, s.ui), now(), at_once || resized || s.demo.frames <= kFirstFrames);
  return !s.glide.arrived();
}

// How long the next frame is. Runs of a given number of frames and recordings go by frames, all else by the clock.
double frameSeconds(const Options& options, const Demo& demo, double& last) {
  const double moment = now();
  const double passed = moment - last;
  last = moment;
  return options.frames_given || demo.capture.recording || demo.capture.hair ? 1 / demo.scene.playback.fps : passed;
}

// Waits for events, s at most. Returns whether any came: those of the window itself call nobody, but end the wait.
bool waitForEvents(double seconds, const Session& s) {
  const double before = now();
  const long events = s.events;
  glfwWaitEventsTimeout(seconds);
  return s.events != events || now() - before < 0.95 * seconds;
}

// Takes events in, after a wait for them where nothing moves. Time that passes while nothing is drawn is not caught up
// with: `last` follows. `reload` is called while it waits, and ends the wait by returning true.
void pollOrWait(bool may_wait, const Session& s, const std::function<bool()>& reload, RedrawThrottle& throttle,
                double& last) {
  const Demo& demo = s.demo;
  // Runs of so many frames and replays go on by themselves.
  const bool still = may_wait && nothingMoves(demo);
  const bool fading_message = !demo.message.empty() && !demo.message_is_fault;
  const Wait wait = throttle.next(still, ImGui::GetIO().WantTextInput || fading_message);
  if (wait == Wait::kEvent) {
    while (!interrupted() && !waitForEvents(kShaderLook, s) && !reload()) continue;
    throttle.disturb();
    last = std::max(last, now() - kShortWait);
  } else if (waitForEvents(wait == Wait::kShort ? kShortWait : 0, s)) {
    throttle.disturb();
  }
}

// Runs of so many frames and recordings show the same on every run: nothing in them goes by the clock.
bool repeats(const Options& options) {
  return options.frames_given || !options.record.empty() || !options.replay.empty();
}

Demo openForWindow(Scene scene, const Options& options, double aspect) {
  const bool beside = !repeats(options);
  Demo demo = openAsked(std::move(scene), options, aspect, beside);
  demo.loading.on = beside;
  if (!options.load_state.empty())
    loadDemoState(options.load_state, !options.camera.empty() || !options.framing.empty(), demo);
  if (isSimCache(options.load_state)) openCache(options.load_state, demo);
  if (!options.save_state.empty()) checkWritable(options.save_state);
  setDebugViews(options.debug, demo.debug);
  if (!options.compare.empty()) startComparison(options.compare, demo);
  demo.comparison.side_by_side = options.compare_view == "side";
  for (const std::string& note : openingNotes(options, demo)) std::cerr << "hairmesh: " << note << "\n";
  return demo;
}

}  // namespace

namespace {

UiState uiOf(const Options& options) {
  UiState ui;
  ui.visible = !options.hide_panels;
  ui.open_tab = tabIndex(options.panel);
  ui.unfolded = !options.panel.empty();
  ui.kept_folder = options.frames_given ? "" : keptFolder();  // runs of so many frames leave nothing behind
  ui.recent = readRecent(ui.kept_folder);
  return ui;
}

// After the last frame: what was asked to be written. Returns the exit code.
int endRun(const Options& options, const RunReport& run, int frames, Tape& tape, Demo& demo) {
  if (!options.report.empty()) writeReport(options.report, run, demo);
  if (!options.save_state.empty() && (options.save_state_at == 0 || frames < options.save_state_at))
    writeFile(options.save_state, demoStateBytes(demo));
  const Tape::End end = tape.end(demo);
  std::cout << end.message;
  if (endedEarly(frames, options.frames_given ? options.frames : kEndless)) return kExitInterrupted;
  return end.differs ? kExitFault : kExitFine;
}

void keepProject(const Demo& demo, Autosave& autosave, UiState& ui) {
  if (!ui.to_forget.empty()) autosave.forget(std::exchange(ui.to_forget, ""));
  if (!ui.gone_on_from.empty()) autosave.replace(std::exchange(ui.gone_on_from, ""));
  autosave.keep(now(), demo);
}

// What a run's report says of it as a whole.
RunReport reportOf(const Demo& demo, double start_seconds) {
  RunReport run;
  run.fps = demo.scene.playback.fps;
  run.renderer = render::rendererName();
  run.start_seconds = start_seconds;
  return run;
}

}  // namespace

int runWindow(Scene scene, const Options& options) {
  noteInterrupts();
  WindowSystem system;
  Window window(options.width, options.height);
  const double start = now();
  Tape tape(options, scene);
  Demo demo = openForWindow(std::move(scene), options, tape.aspect());
  UiState ui = uiOf(options);
  Autosave autosave(ui.kept_folder);
  ui.offered = autosave.left();
  demo.timeline.on = true;
  Session callbacks{demo, ui};
  // The panels' backend chains to the callbacks that it finds.
  setCallbacks(window.handle, callbacks);
  PanelBackends backends(window.handle);
  setKeyCallbacks(window.handle);
  prepareUi(wantedTextScale(window.handle, options.ui_scale, 1), ui);
  render::Renderer renderer(dataPath("shaders"));
  if (!options.report.empty()) checkWritable(options.report);
  RunReport run = reportOf(demo, now() - start);

  render::PicturePair pair(dataPath("shaders"));
  FrameTarget target{
      .renderer = &renderer, .draw_panels = [&](Demo& shown) { drawPanels(window.handle, shown, ui); }, .pair = &pair};
  PresetPictures presets(dataPath("shaders"), options.frames_given);
  bool presets_coming = false;
  ShaderWatch watch;
  PictureWriter pictures;
  const auto reload = [&] { return reloadSavedShaders(now(), watch, renderer, demo); };
  RedrawThrottle throttle;
  HairRecorder hair(demo.scene.playback.fps);
  double last = now();
  int frame = 0;
  const int most = tape.frames().value_or(options.frames_given ? options.frames : kEndless);
  for (bool last_frame = most <= 0; !last_frame && !glfwWindowShouldClose(window.handle) && !ui.quit; ++frame) {
    pollOrWait(most == kEndless && !presets_coming, callbacks, reload, throttle, last);
    feedInput(window.handle);
    if (!callbacks.input.empty()) throttle.disturb();
    followTextScale(window.handle, options.ui_scale, callbacks);
    watch.reload_all = std::exchange(ui.reload_shaders, false);
    if (reload()) throttle.disturb();
    glfwGetFramebufferSize(window.handle, &target.width, &target.height);
    if (leaveFree(window.handle, repeats(options), callbacks, target)) throttle.disturb();
    const double seconds = frameSeconds(options, demo, last);
    advanceFrame(demo, tape.turn(frame, frame == 0 && options.load_state.empty() ? 0 : seconds, demo), target);
    presets_coming = presets.work(demo, ui);
    keepProject(demo, autosave, ui);
    demo.stats.skipped[kSkipEvents] = {throttle.waited(), 1, 0};
    pictures.write(demo, target);
    hair.frame(demo);
    if (frame + 1 == options.save_state_at) writeFile(options.save_state, demoStateBytes(demo));
    if (!options.report.empty()) run.frames.push_back(demo.stats);
    last_frame = frame + 1 >= most || interrupted() || glfwWindowShouldClose(window.handle) || ui.quit;
    if (last_frame && !options.screenshot.empty()) writeWindow(options.screenshot, target);
    glfwSwapBuffers(window.handle);
  }
  pictures.close(demo);
  hair.close(demo);
  return endRun(options, run, frame, tape, demo);
}

}  // namespace app
