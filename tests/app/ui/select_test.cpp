// Choosing parts of the hair mesh with the mouse, and what drags, arrow keys and buttons then ask for.
#include <gtest/gtest.h>

#include <cstdlib>

#include "app/files/tie_spec.h"
#include "app/scene/edit/groom_brush.h"
#include "app/scene/edit/mesh_change.h"
#include "app/scene/edit/picking.h"
#include "app/ui/ui_panels.h"
#include "tests/app/ui/panels.h"

namespace select_test {

using test::Ask;
using test::Request;

class Select : public test::Panels {
 protected:
  // A pixel right of the panels where the hair is, `number` of them in a row apart; (-1, -1): there is none.
  ImVec2 onHair(int number) {
    for (float y = 60; y < 600; y += 20) {
      for (float x = 560; x < 1100; x += 20) {
        if (app::pickHair(app::rayThrough(x, y, {1280, 720, {}}, demo_.camera), demo_.actors[0]) && number-- == 0)
          return {x, y};
      }
    }
    return {-1, -1};
  }
  // A pixel of the picture beside panels and hair.
  ImVec2 besideHair() {
    for (float y = 60; y < 700; y += 20) {
      for (float x = 560; x < 1100; x += 20) {
        if (app::pickHair(app::rayThrough(x, y, {1280, 720, {}}, demo_.camera), demo_.actors[0])) continue;
        ImGui::GetIO().MousePos = {x, y};
        frame();
        if (!ImGui::GetIO().WantCaptureMouse) return {x, y};
      }
    }
    return {-1, -1};
  }
  std::vector<Request> press(const ImVec2& at, float dx = 0) {
    ImGuiIO& io = ImGui::GetIO();
    std::vector<Request> all;
    const auto collect = [&] {
      const auto more = frame();
      all.insert(all.end(), more.begin(), more.end());
    };
    io.MousePos = at;
    collect();
    io.MouseDown[0] = true;
    collect();
    io.MousePos.x += dx;
    collect();
    io.MouseDown[0] = false;
    collect();
    collect();
    return all;
  }
};

TEST_F(Select, AClickChoosesAndShiftAddsAndTakesAway) {
  openTab(app::tabIndex("hair"));
  click("select Vertex");
  ASSERT_EQ(ui_.select.element, 0);
  const ImVec2 first = onHair(3), second = onHair(40);
  ASSERT_GT(second.x, 0);
  EXPECT_TRUE(press(first).empty());
  ASSERT_EQ(ui_.select.chosen.size(), 1u);
  const int vertex = ui_.select.chosen[0];
  ImGui::GetIO().KeyShift = true;
  press(second);
  EXPECT_EQ(ui_.select.chosen.size(), 2u);
  press(second);
  EXPECT_EQ(ui_.select.chosen, std::vector<int>{vertex});
  ImGui::GetIO().KeyShift = false;
  press(second);
  EXPECT_EQ(ui_.select.chosen.size(), 1u);
  EXPECT_NE(ui_.select.chosen[0], vertex);
}

TEST_F(Select, ADragAsksForMovesAndEndsItsGesture) {
  app::chooseElement(static_cast<int>(app::MeshElement::kColumn), ui_);
  const std::vector<Request> asked = press(onHair(40), 25);
  ASSERT_TRUE(this->asked(asked, Ask::kMove, "column"));
  EXPECT_TRUE(this->asked(asked, Ask::kEndGesture));
  for (const Request& request : asked) {
    if (request.what != Ask::kMove) continue;
    const app::MoveSample sample = app::parseMove(request.name, request.text);
    EXPECT_EQ(sample.chosen, ui_.select.chosen);
    EXPECT_GT(sample.along.norm(), 0.001);
  }
}

// What cannot follow the pointer says by how much, and why.
TEST_F(Select, ADragThatFallsShortOfThePointerSaysSo) {
  app::chooseElement(static_cast<int>(app::MeshElement::kVertex), ui_);
  ui_.brush.radius = 0.01;
  demo_.paused = true;
  ImGuiIO& io = ImGui::GetIO();
  const auto step = [&] {
    demo_.requests = frame();
    app::advanceFrame(demo_, 0, {});
  };
  const auto drag = [&](const ImVec2& at, float dx, int steps) {
    io.MousePos = at;
    step();
    io.MouseDown[0] = true;
    step();
    const app::Vec3 from = ui_.brush.last;
    for (int k = 0; k < steps; ++k) io.MousePos.x += dx, step();
    step();
    const app::Vec3 way = ui_.brush.last - from;
    io.MouseDown[0] = false;
    step();
    return way;
  };
  const auto rest = [&] {
    return demo_.actors[0].haircut->mesh.shape.positions[static_cast<std::size_t>(ui_.select.chosen.at(0))];
  };
  const ImVec2 at = onHair(40);
  press(at);
  const app::Vec3 before = rest();
  const app::Vec3 way = drag(at, -20, 10);
  const double lacks = (way - (rest() - before)).norm();
  ASSERT_GT(lacks, 0.003) << "it follows";
  EXPECT_EQ(std::atoi(demo_.message.c_str()), std::lround(1e3 * lacks)) << demo_.message;
  EXPECT_NE(demo_.message.find(" mm short of the pointer: "), std::string::npos) << demo_.message;
  const std::vector<float> all(demo_.actors[0].hair.positions.size(), 1);
  app::freezeHair(all, 0, demo_);
  demo_.message.clear();
  drag(at, 20, 2);
  EXPECT_NE(demo_.message.find("short of the pointer: it is frozen"), std::string::npos) << demo_.message;
  app::freezeHair({}, 0, demo_);
  demo_.message.clear();
  drag(onHair(90), 1, 6);
  EXPECT_EQ(demo_.message, "") << "it goes where it is led";
}

TEST_F(Select, ArrowKeysMoveWhatIsChosenAndElseReachThePanels) {
  EXPECT_TRUE(app::pressKey(app::kKeyUp, demo_, ui_));
  EXPECT_TRUE(ui_.focus_panels);
  ui_.focus_panels = false;
  app::pressKey('X', demo_, ui_);
  EXPECT_EQ(ui_.select.element, static_cast<int>(app::MeshElement::kVertex));
  press(onHair(20));
  ASSERT_EQ(ui_.select.chosen.size(), 1u);
  demo_.requests.clear();
  EXPECT_TRUE(app::pressKey(app::kKeyUp, demo_, ui_));
  EXPECT_FALSE(ui_.focus_panels);
  EXPECT_TRUE(app::pressKey(app::kKeyLeft, demo_, ui_, app::kShift));
  ASSERT_EQ(demo_.requests.size(), 2u);
  EXPECT_NEAR(app::parseMove("vertex", demo_.requests[0].text).along.norm(), 0.002, 1e-9);
  EXPECT_NEAR(app::parseMove("vertex", demo_.requests[1].text).along.norm(), 0.01, 1e-9);
}

TEST_F(Select, ButtonsAskForChangesOfTheMesh) {
  openTab(app::tabIndex("hair"));
  click("select Layer");
  press(onHair(40));
  ASSERT_EQ(ui_.select.chosen.size(), 1u);
  const std::string layer = std::to_string(ui_.select.chosen[0]);
  const std::vector<Request> asked = click("mesh Layer +");
  ASSERT_TRUE(this->asked(asked, Ask::kMesh, "add-layer"));
  for (const Request& request : asked) {
    if (request.what == Ask::kMesh) {
      EXPECT_EQ(request.text, layer);
    }
  }
  demo_.requests = asked;
  app::advanceFrame(demo_, 0, {});
  EXPECT_FALSE(demo_.message_is_fault) << demo_.message;
  frame();
  EXPECT_TRUE(ui_.select.chosen.empty()) << "they were of the mesh before";
}

TEST_F(Select, TheMirrorGoesWithAPartingAndNotWithALayer) {
  openTab(app::tabIndex("hair"));
  click("select Column");
  press(onHair(40));
  ASSERT_EQ(ui_.select.chosen.size(), 1u);
  click("brush_mirror");
  ASSERT_TRUE(ui_.brush.mirror);
  const auto textOf = [&](const char* button) {
    for (const Request& request : click(button)) {
      if (request.what == Ask::kMesh) return request.text;
    }
    return std::string("nothing");
  };
  const std::string column = std::to_string(ui_.select.chosen[0]);
  EXPECT_EQ(textOf("mesh Weld"), "mirror " + column);
  EXPECT_EQ(textOf("mesh Layer +").find("mirror"), std::string::npos);
}

// What a mirror reaches is shown: the likes of what is chosen, and a second ring.
TEST_F(Select, TheMirrorShowsWhatItReaches) {
  const auto marks = [&](const char* name) {
    return std::ranges::count_if(ui_.items, [&](const app::UiItem& item) { return item.name.starts_with(name); });
  };
  app::chooseElement(static_cast<int>(app::MeshElement::kVertex), ui_);
  press(onHair(40));
  ASSERT_EQ(ui_.select.chosen.size(), 1u);
  EXPECT_EQ(marks("mirrored "), 0);
  ui_.brush.mirror = true;
  frame();
  const app::Actor& actor = demo_.actors[0];
  const double plane = actor.body->character.scalp.center.x();
  const int like = app::likeAcross(ui_.select.chosen[0], plane, actor.haircut->mesh);
  ASSERT_EQ(marks("mirrored "), 1);
  const app::UiItem* mark = find("mirrored " + std::to_string(like));
  ASSERT_TRUE(mark);
  const auto pixel = app::pixelOf(actor.hair.positions[static_cast<std::size_t>(like)], {1280, 720, {}}, demo_.camera);
  ASSERT_TRUE(pixel);
  EXPECT_NEAR(mark->x + 0.5f * mark->width, (*pixel)[0], 0.01);
  EXPECT_NEAR(mark->y + 0.5f * mark->height, (*pixel)[1], 0.01);
  ui_.select.element = -1, ui_.brush.tool = 0;
  ImGui::GetIO().MousePos = onHair(40);
  frame();
  EXPECT_EQ(marks("brush_ring"), 1);
  EXPECT_EQ(marks("mirror_ring"), 1);
  ui_.brush.mirror = false;
  frame();
  EXPECT_EQ(marks("brush_ring"), 1);
  EXPECT_EQ(marks("mirror_ring"), 0);
}

TEST_F(Select, BrushesAndSelectionTakeTurns) {
  openTab(app::tabIndex("hair"));
  click("select Edge");
  EXPECT_EQ(ui_.select.element, static_cast<int>(app::MeshElement::kEdge));
  click("brush Comb");
  EXPECT_EQ(ui_.select.element, -1);
  EXPECT_EQ(ui_.brush.tool, 0);
  click("select Column");
  EXPECT_EQ(ui_.brush.tool, -1);
}

TEST_F(Select, TheFirstPressBesideTheHairSaysWhatItDoes) {
  openTab(app::tabIndex("hair"));
  click("brush Comb");
  demo_.message.clear();
  const ImVec2 beside = besideHair();
  EXPECT_FALSE(press(onHair(40), 25).empty());
  EXPECT_EQ(demo_.message, "");
  EXPECT_TRUE(press(beside).empty());
  EXPECT_NE(demo_.message.find("turns the camera"), std::string::npos) << demo_.message;
  demo_.message.clear();
  press(beside);
  EXPECT_EQ(demo_.message, "");
}

// A ring is put on the hair by a drag, with Mirror one on each side, and a slider makes it wider.
TEST_F(Select, ARingIsTiedWhereTheHandLetsGo) {
  openTab(app::tabIndex("hair"));
  click("tie_by_hand");
  ASSERT_TRUE(ui_.brush.tie);
  ui_.brush.tie_radius = 0.03;
  ui_.brush.mirror = true;
  ImGui::GetIO().MousePos = onHair(40);
  frame();
  EXPECT_TRUE(find("tie_ring"));
  EXPECT_TRUE(find("mirror_ring"));
  const std::vector<Request> asked = press(onHair(40), 20);
  std::string text;
  for (const Request& request : asked) {
    if (request.what == Ask::kTie) text = request.text;
  }
  const std::vector<app::TieSpec> ties = app::tiesFromText(text);
  ASSERT_EQ(ties.size(), 2u) << text;
  ASSERT_TRUE(ties[0].at && ties[1].at);
  EXPECT_EQ(ties[0].radius, 0.03);
  EXPECT_NE(ties[0].side, ties[1].side);
  EXPECT_NEAR(ties[0].at->y(), ties[1].at->y(), 1e-12);
  EXPECT_FALSE(ui_.brush.tie) << "one ring a press";
  for (const Request& request : asked) EXPECT_NE(request.what, Ask::kBrush);
}

// Ties are a list: a ring more is put beside those that there are, one is picked and changed, moved, taken away.
TEST_F(Select, TiesAreAListOfWhichOneIsChanged) {
  ImGui::GetIO().DisplaySize = {1280, 3000};
  openTab(app::tabIndex("hair"));
  const auto tiesAsked = [](const std::vector<Request>& asked) {
    const auto posted = std::ranges::find(asked, Ask::kTie, &Request::what);
    return posted == asked.end() ? std::vector<app::TieSpec>{} : app::tiesFromText(posted->text);
  };
  const auto& now = [&]() -> const std::vector<app::TieSpec>& { return demo_.actors[0].spec.ties; };
  apply({{Ask::kTie, "", "two"}});
  ASSERT_EQ(now().size(), 2u) << demo_.message;
  frame();
  ASSERT_TRUE(find("tie 0") && find("tie 1"));
  EXPECT_FALSE(find("tie_side All")) << "none is picked";
  click("tie 1");
  EXPECT_EQ(ui_.brush.tie_picked, 1);
  frame();
  EXPECT_TRUE(find("tie_side All"));
  const std::vector<app::TieSpec> wider = tiesAsked(click("tie_radius", 0.8f));
  ASSERT_EQ(wider.size(), 2u);
  EXPECT_EQ(wider[0].radius, now()[0].radius);
  EXPECT_GT(wider[1].radius, now()[1].radius + 0.01);
  const std::vector<app::TieSpec> low = tiesAsked(click("tie_place Low"));
  ASSERT_EQ(low.size(), 2u);
  EXPECT_EQ(low[0].place, "left");
  EXPECT_EQ(low[1].place, "low");
  const std::vector<app::TieSpec> left = tiesAsked(click("remove tie 1"));
  ASSERT_EQ(left.size(), 1u);
  EXPECT_EQ(left[0].place, "left");
  EXPECT_EQ(ui_.brush.tie_picked, -1);
  ImGui::GetIO().DisplaySize = {1280, 720};
  frame();
  ui_.brush.tie = true;
  ui_.brush.tie_moves = false;
  const std::vector<app::TieSpec> more = tiesAsked(press(onHair(40), 20));
  EXPECT_EQ(more.size(), 3u);
  ui_.brush.tie = ui_.brush.tie_moves = true;
  ui_.brush.tie_picked = 0;
  const std::vector<app::TieSpec> moved = tiesAsked(press(onHair(40), 20));
  ASSERT_EQ(moved.size(), 2u);
  EXPECT_TRUE(moved[0].at);
  EXPECT_FALSE(moved[1].at);
}

// What is chosen is pinned where it is, by the section's settings, and let go again.
TEST_F(Select, WhatIsChosenIsPinnedAndUnpinned) {
  openTab(app::tabIndex("hair"));
  click("select Vertex");
  press(onHair(40));
  ASSERT_EQ(ui_.select.chosen.size(), 1u);
  ImGui::GetIO().DisplaySize = {1280, 3000};
  frame();
  if (!find("pins Pin")) click("section Pins");
  frame();
  click("pin_firm");
  ui_.pin.stiffness = 25, ui_.pin.from = 1, ui_.pin.until = 0.5;
  frame();
  EXPECT_TRUE(click("pins Pin").empty()) << "it would let go before it holds";
  ui_.pin.until = 2;
  frame();
  const std::vector<Request> asked = click("pins Pin");
  EXPECT_EQ(std::ranges::count(asked, Ask::kPin, &Request::what), 1);
  apply(asked);
  const std::vector<app::PinSpec>& pins = demo_.actors[0].spec.pins;
  ASSERT_EQ(pins.size(), 1u);
  EXPECT_EQ(pins[0].vertex, ui_.select.chosen[0]);
  EXPECT_EQ(pins[0].stiffness, 25);
  EXPECT_EQ(pins[0].from, 1);
  EXPECT_EQ(pins[0].until, 2);
  frame();
  EXPECT_TRUE(find("pinned " + std::to_string(pins[0].vertex))) << "it is marked";
  ui_.pin = {};  // as after something else was chosen
  frame();
  EXPECT_FALSE(ui_.pin.firm) << "the chosen pin's settings are shown";
  EXPECT_EQ(ui_.pin.stiffness, 25);
  EXPECT_EQ(ui_.pin.from, 1);
  EXPECT_EQ(ui_.pin.until, 2);
  apply(click("pins Unpin"));
  EXPECT_TRUE(demo_.actors[0].spec.pins.empty());
  ui_.brush.mirror = true;
  apply(click("pins Pin"));
  EXPECT_EQ(demo_.actors[0].spec.pins.size(), 2u) << "the like on the other side is pinned as well";
  apply(click("pins Unpin"));
  EXPECT_TRUE(demo_.actors[0].spec.pins.empty());
}

}  // namespace select_test
