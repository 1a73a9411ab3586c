// The views that the camera came to, to go back to and on from.
#include <imgui/imgui.h>

#include <algorithm>

#include "app/ui/ui_panels.h"
#include "app/ui/ui_widgets.h"

namespace app {

namespace {

constexpr std::size_t kMaxViews = 200;
constexpr double kWheelRest = 0.5;  // s, that end a turn of the wheel

// The anchor follows the figure and is no part of a view.
bool sameView(const Camera& a, const Camera& b) {
  return a.target == b.target && a.yaw == b.yaw && a.pitch == b.pitch && a.distance == b.distance && a.fov == b.fov &&
         a.follow == b.follow;
}

bool dragged() {
  return std::ranges::any_of(ImGui::GetIO().MouseDown, [](bool down) { return down; });
}

}  // namespace

void noteView(const Demo& demo, UiState& ui) {
  ViewHistory& views = ui.views;
  const Camera& camera = demo.camera;
  const double time = ImGui::GetTime();
  const bool goes_on = ImGui::GetIO().MouseWheel != 0 && time - views.zoomed < kWheelRest;
  if (ImGui::GetIO().MouseWheel != 0) views.zoomed = time;
  if (!views.now || demo.turntable != 0) views.now = camera;
  if (dragged() || sameView(*views.now, camera)) return;
  if (!goes_on) views.past.push_back(*views.now);
  if (views.past.size() > kMaxViews) views.past.erase(views.past.begin());
  views.future.clear();
  views.now = camera;
}

void stepView(bool back, Demo& demo, UiState& ui) {
  ViewHistory& views = ui.views;
  std::vector<Camera>&from = back ? views.past : views.future, &to = back ? views.future : views.past;
  demo.message_is_fault = false;
  if (from.empty()) {
    demo.message = back ? "no view before this one" : "no view after this one";
    return;
  }
  const Camera view = from.back();
  from.pop_back();
  to.push_back(demo.camera);
  views.now = view;
  demo.camera.target = view.target;
  demo.camera.yaw = view.yaw;
  demo.camera.pitch = view.pitch;
  demo.camera.distance = view.distance;
  // What a recording does not have in its views is asked for.
  if (view.fov != demo.camera.fov) postRequest(demo, {Ask::kLens, "", "", view.fov});
  if (view.follow != demo.camera.follow) postRequest(demo, {Ask::kFollow, "", "", view.follow ? 1.0 : 0.0});
  demo.message = back ? "the view before" : "the view after";
}

}  // namespace app
