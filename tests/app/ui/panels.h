// Panels without a window, for tests: Dear ImGui is fed events and its requests are watched.
#pragma once

#include <gtest/gtest.h>
#include <imgui/imgui.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "app/files/data_path.h"
#include "app/scene/demo.h"
#include "app/ui/ui.h"

namespace test {

using app::Ask;
using app::Demo;
using app::Request;
using app::UiItem;

// A demo with panels and no pixels.
class Panels : public testing::Test {
 protected:
  void SetUp() override {
    ImGui::CreateContext();
    ImGuiIO& io = ImGui::GetIO();
    io.DisplaySize = {1280, 720};
    io.KeyMap[ImGuiKey_Space] = ' ';
    io.KeyMap[ImGuiKey_DownArrow] = app::kKeyDown;
    app::prepareUi(1, ui_);
    unsigned char* pixels = nullptr;
    int width = 0, height = 0;
    io.Fonts->GetTexDataAsRGBA32(&pixels, &width, &height);
    app::Scene scene;
    app::CharacterSpec spec;
    spec.motion = app::dataPath("assets/clips/idle_turns.bvh");
    spec.style = app::Style::kShort;
    spec.resolution = app::Resolution::kLow;
    scene.characters = {spec};
    scene.playback.settle = 0;
    demo_ = app::openScene(std::move(scene), 1.5);
    app::advanceFrame(demo_, 0, {});
    frame();
    frame();
  }
  void TearDown() override { ImGui::DestroyContext(); }

  // Draws the panels once; returns what was asked for.
  std::vector<Request> frame() {
    ImGui::GetIO().DeltaTime = 1.0f / 60;
    ImGui::NewFrame();
    app::buildUi(demo_, ui_);
    ImGui::Render();
    return std::exchange(demo_.requests, {});
  }

  // Applies what was asked for, and shows what has come of it.
  void apply(const std::vector<Request>& requests) {
    demo_.requests = requests;
    app::applyRequests(demo_);
    frame();
  }

  const UiItem* find(const std::string& name) const {
    const auto found =
        std::find_if(ui_.items.begin(), ui_.items.end(), [&](const UiItem& item) { return item.name == name; });
    return found == ui_.items.end() ? nullptr : &*found;
  }

  // Moves, presses, drags by `dx` and releases over a widget; returns all requests on the way.
  std::vector<Request> click(const std::string& name, float share = 0.5f, float dx = 0) {
    const UiItem* item = find(name);
    if (!item) {
      ADD_FAILURE() << "no widget '" << name << "'";
      return {};
    }
    ImGuiIO& io = ImGui::GetIO();
    std::vector<Request> all;
    const auto collect = [&] {
      const auto more = frame();
      all.insert(all.end(), more.begin(), more.end());
    };
    io.MousePos = {item->x + share * item->width, item->y + 0.5f * item->height};
    collect();
    collect();
    io.MouseDown[0] = true;
    collect();
    io.MousePos.x += dx;
    collect();
    io.MouseDown[0] = false;
    collect();
    io.MousePos = {640, 400};
    collect();
    return all;
  }

  // The note under a slider, or "".
  std::string noteOf(const std::string& name) {
    frame();
    for (const UiItem& item : ui_.items) {
      if (item.name.starts_with(name + " used: ")) return item.name.substr(name.size() + 1);
    }
    return "";
  }

  void openTab(int index) {
    ui_.open_tab = index;
    frame();
    frame();
  }

  bool asked(const std::vector<Request>& requests, Ask what, const std::string& name = "") const {
    return std::any_of(requests.begin(), requests.end(),
                       [&](const Request& r) { return r.what == what && (name.empty() || r.name == name); });
  }

  Demo demo_;
  app::UiState ui_;
};

}  // namespace test
