// What comes and goes by itself: notices, tips, the question before leaving, the figure's way to its place.
#include <gtest/gtest.h>
#include <imgui/imgui.h>
#include <imgui/imgui_internal.h>

#include "app/ui/part_glide.h"
#include "tests/app/ui/panels.h"

namespace notices_test {

using app::PicturePart;
using test::Ask;

class Notices : public test::Panels {
 protected:
  bool tipShown() {
    for (const ImGuiWindow* window : GImGui->Windows)
      if (window->Active && !window->Hidden && window->Flags & ImGuiWindowFlags_Tooltip) return true;
    return false;
  }
  void restOn(const std::string& name, int frames) {
    const app::UiItem* item = find(name);
    ASSERT_NE(item, nullptr) << name;
    ImGui::GetIO().MousePos = {item->x + 0.5f * item->width, item->y + 0.5f * item->height};
    for (int k = 0; k < frames; ++k) frame();
  }
  void apply(const std::vector<app::Request>& requests) {
    demo_.requests = requests;
    app::applyRequests(demo_);
  }
};

TEST_F(Notices, UndoPastTheStartIsANoticeThatGoesByItself) {
  app::pressKey('Z', demo_, ui_, app::kControl);
  apply(demo_.requests);
  EXPECT_TRUE(demo_.message.starts_with("nothing to undo")) << demo_.message;
  EXPECT_FALSE(demo_.message_is_fault);
  frame(), frame();
  EXPECT_NE(find("message"), nullptr);
  EXPECT_EQ(find("close_message"), nullptr);
  for (int k = 0; k < 600; ++k) frame();
  EXPECT_TRUE(demo_.message.empty());
}

TEST_F(Notices, UndoAndRedoAreGreyWhereThereIsNothing) {
  EXPECT_FALSE(asked(click("file Undo"), Ask::kUndo));
  EXPECT_FALSE(asked(click("file Redo"), Ask::kRedo));
  apply({{Ask::kSetParam, "density", "70"}});
  frame();
  EXPECT_FALSE(asked(click("file Redo"), Ask::kRedo));
  const std::vector<app::Request> undo = click("file Undo");
  EXPECT_TRUE(asked(undo, Ask::kUndo));
  apply(undo);
  frame();
  EXPECT_TRUE(asked(click("file Redo"), Ask::kRedo));
}

TEST_F(Notices, ATipOpensAfterARestAndEndsWithAPressOrWhenThePointerLeaves) {
  openTab(2);
  ImGuiIO& io = ImGui::GetIO();
  restOn("style Bob", 6);
  EXPECT_FALSE(tipShown()) << "at once";
  restOn("style Bob", 30);
  EXPECT_TRUE(tipShown());
  io.MousePos = {640, 400};
  frame(), frame();
  EXPECT_FALSE(tipShown()) << "beside it";
  restOn("style Bob", 30);
  EXPECT_TRUE(tipShown());
  io.MousePos = {-FLT_MAX, -FLT_MAX};
  frame(), frame();
  EXPECT_FALSE(tipShown()) << "outside of the window";
  restOn("style Bob", 30);
  io.MouseDown[0] = true;
  frame(), frame();
  io.MouseDown[0] = false;
  for (int k = 0; k < 60; ++k) frame();
  EXPECT_FALSE(tipShown()) << "after it was chosen";
  restOn("style Short", 3);
  restOn("style Bob", 30);
  EXPECT_TRUE(tipShown()) << "the pointer has come anew";
}

TEST_F(Notices, WhatTheKeyboardHasChosenHasNoTip) {
  openTab(2);
  click("style Bob");
  GImGui->NavDisableMouseHover = true, GImGui->NavDisableHighlight = false;
  for (int k = 0; k < 60; ++k) frame();
  EXPECT_FALSE(tipShown());
}

TEST_F(Notices, EscapeClosesWhatIsOpenAndLeavesWhileItsQuestionStands) {
  ui_.history = true;
  demo_.message = "file.bvh: line 3: a fault; mend it";
  demo_.message_is_fault = true;
  app::pressKey(app::kKeyEscape, demo_, ui_);
  EXPECT_TRUE(demo_.message.empty());
  for (const int tool : {'G', 'X'}) {
    app::pressKey(tool, demo_, ui_);
    app::pressKey(app::kKeyEscape, demo_, ui_);
    EXPECT_TRUE(ui_.brush.tool < 0 && ui_.select.element < 0) << tool;
    EXPECT_TRUE(ui_.history) << "one thing at a press";
  }
  app::pressKey(app::kKeyEscape, demo_, ui_);
  EXPECT_FALSE(ui_.history);
  app::pressKey(app::kKeyEscape, demo_, ui_);
  for (int k = 0; k < 600; ++k) frame();
  EXPECT_TRUE(demo_.message.empty());
  app::pressKey(app::kKeyEscape, demo_, ui_);
  EXPECT_FALSE(ui_.quit) << "it had gone";
  app::pressKey(app::kKeyEscape, demo_, ui_);
  EXPECT_TRUE(ui_.quit);
}

TEST(PartGlide, GoesToItsGoalInAFifthOfASecondWithoutAJump) {
  const PicturePart whole, beside{0.28, 0.76, 0, 0.91};
  app::PartGlide glide;
  EXPECT_EQ(glide.to(beside, 5, true), beside);
  double moment = 9, last = beside.left;
  EXPECT_EQ(glide.to(whole, moment, false), beside) << "however long nothing was drawn";
  EXPECT_FALSE(glide.arrived());
  for (int k = 0; k < 6; ++k) {
    const PicturePart on_way = glide.to(whole, moment += 1.0 / 60, false);
    EXPECT_LT(on_way.left, last);
    EXPECT_GT(on_way.left, last - 0.05);
    last = on_way.left;
  }
  EXPECT_EQ(glide.stay(moment += 1).left, last) << "while something is dragged over the picture";
  EXPECT_LT(glide.to(beside, moment += 1.0 / 60, false).left, last + 1e-9) << "from where it is";
  EXPECT_EQ(glide.to(beside, moment + 1.01 * app::kPartGlide, false), beside);
  EXPECT_TRUE(glide.arrived());
}

}  // namespace notices_test
