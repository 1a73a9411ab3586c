// What comes and goes by itself: notices, tips, the question before leaving, the figure's way to its place.
#include <gtest/gtest.h>
#include <imgui/imgui.h>
#include <imgui/imgui_internal.h>

#include <utility>

#include "app/ui/part_glide.h"
#include "app/ui/ui_panels.h"
#include "tests/app/ui/panels.h"
#include "tests/run_program.h"

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

TEST_F(Notices, WaitWhileTheFilePanelIsOpenUnlessTheyAreFaults) {
  app::browseFor(app::BrowseFor::kOpen, ui_);
  demo_.message = "preset soft";
  for (int k = 0; k < 600; ++k) frame();
  EXPECT_EQ(find("message"), nullptr);
  ui_.browser.what = app::BrowseFor::kNothing;
  frame(), frame();
  EXPECT_NE(find("message"), nullptr);
  app::browseFor(app::BrowseFor::kOpen, ui_);
  demo_.message_is_fault = true;
  frame(), frame();
  EXPECT_NE(find("close_message"), nullptr);
}

TEST_F(Notices, UndoAndRedoSpeakAsThePanelsDo) {
  apply({{Ask::kSetParam, "stretch_along", "4e+05"}});
  apply({{Ask::kUndo, "", "", 1}});
  EXPECT_EQ(demo_.message, "undone: Stretch along 400 kPa");
  apply({{Ask::kRedo, "", "", 1}});
  EXPECT_EQ(demo_.message, "done again: Stretch along 400 kPa");
}

TEST_F(Notices, ThatTheTimelineBeginsAnewIsSaidForAWhileAndFits) {
  demo_.timeline.on = true;
  demo_.timeline.anew = true;
  for (const ImVec2 size : {ImVec2(960, 600), ImVec2(1280, 720)}) {
    ImGui::GetIO().DisplaySize = size;
    demo_.timeline.frames.clear();
    for (int k = 0; k < 600; ++k) frame();
    ASSERT_NE(find("timeline anew"), nullptr) << "as long as nothing is kept";
    const app::UiItem strip = *find("timeline");
    EXPECT_LT(ImGui::CalcTextSize("begins anew: another hair mesh").x, strip.width) << size.x;
    demo_.timeline.frames.emplace_back().frame = 3;
    for (int k = 0; k < 120; ++k) frame();
    EXPECT_NE(find("timeline anew"), nullptr) << "after 2 s";
    for (int k = 0; k < 360; ++k) frame();
    EXPECT_EQ(find("timeline anew"), nullptr) << "after 8 s";
  }
}

TEST_F(Notices, TimingsSayThatTheyStandStill) {
  EXPECT_EQ(find("timings paused"), nullptr);
  demo_.paused = true;
  frame();
  EXPECT_NE(find("timings paused"), nullptr);
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
  EXPECT_TRUE(demo_.message.empty() && ui_.history);
  app::pressKey('G', demo_, ui_);
  app::pressKey(app::kKeyEscape, demo_, ui_);
  EXPECT_FALSE(ui_.history) << "what lies on top goes first";
  EXPECT_GE(ui_.brush.tool, 0) << "one thing at a press";
  app::pressKey(app::kKeyEscape, demo_, ui_);
  for (const int tool : {'G', 'X'}) {
    app::pressKey(tool, demo_, ui_);
    app::pressKey(app::kKeyEscape, demo_, ui_);
    EXPECT_TRUE(ui_.brush.tool < 0 && ui_.select.element < 0) << tool;
  }
  app::pressKey(app::kKeyEscape, demo_, ui_);
  EXPECT_TRUE(ui_.leaving && !ui_.quit);
  for (int k = 0; k < 600; ++k) frame();
  EXPECT_NE(find("stay"), nullptr) << "the question stands until it is answered";
  app::pressKey('G', demo_, ui_);
  app::pressKey(app::kKeyEscape, demo_, ui_);
  EXPECT_TRUE(!ui_.leaving && !ui_.quit && ui_.brush.tool >= 0) << "the question goes first";
}

TEST_F(Notices, ClosingTheWindowAsksWhereSomethingIsNotSaved) {
  EXPECT_TRUE(app::mayClose(demo_, ui_)) << "nothing would be lost";
  apply({{app::Ask::kSetParam, "density", "70"}});
  EXPECT_FALSE(app::mayClose(demo_, ui_));
  EXPECT_TRUE(app::mayClose(demo_, ui_)) << "while the question stands";
  frame(), frame();
  click("stay");
  frame(), frame();
  EXPECT_EQ(find("leave"), nullptr);
  app::pressKey('Q', demo_, ui_, app::kControl);
  EXPECT_FALSE(ui_.quit);
  frame(), frame();
  click("leave_save");
  EXPECT_FALSE(ui_.leaving || ui_.quit);
  EXPECT_EQ(ui_.browser.what, app::BrowseFor::kSaveScene);
  ui_.browser.what = app::BrowseFor::kNothing;
  const std::string file = test::freshFolder("ui_saved") + "/saved.json";
  for (const app::Ask save : {app::Ask::kSaveScene, app::Ask::kSaveProject}) {
    apply({{app::Ask::kSetParam, "density", save == app::Ask::kSaveScene ? "71" : "72"}});
    EXPECT_TRUE(app::isUnsaved(demo_.edits));
    apply({{app::Ask::kEndGesture, "", ""}, {save, "", file}});
    EXPECT_TRUE(app::mayClose(demo_, ui_)) << "all is saved";
  }
  apply({{app::Ask::kUndo, "", "", 1}});
  EXPECT_FALSE(app::mayClose(demo_, ui_)) << "the saved project has it otherwise";
  ui_.leaving = false;
  apply({{app::Ask::kRedo, "", "", 1}});
  EXPECT_TRUE(app::mayClose(demo_, ui_));
  apply({{app::Ask::kSetParam, "density", "60"}, {app::Ask::kEndGesture, "", ""}});
  app::pressKey('Q', demo_, ui_, app::kControl);
  EXPECT_FALSE(ui_.quit);
  frame(), frame();
  click("leave");
  EXPECT_TRUE(ui_.quit);
}

// The offer of an earlier run's project stands by the same rule as messages, above them.
TEST_F(Notices, NoneCoversWhatCanBePressed) {
  ui_.offered = "autosave-1.json";
  demo_.timeline.on = true;
  for (const ImVec2 size : {ImVec2(1280, 720), ImVec2(1100, 480), ImVec2(1730, 333), ImVec2(900, 600), ImVec2(800, 600),
                            ImVec2(640, 480), ImVec2(480, 400)}) {
    for (const int state : {0, 1, 2, 3}) {
      ImGui::GetIO().DisplaySize = size;
      ui_.unfolded = state & 1;
      ui_.history = state & 2;
      demo_.message = "a message";
      for (int k = 0; k < 4; ++k) frame();
      for (const char* notice : {"offer", "message"}) {
        const ImGuiWindow* shown = ImGui::FindWindowByName(notice);
        ASSERT_TRUE(shown && shown->Active) << notice << size.x << "," << state;
        EXPECT_GE(shown->Rect().Min.y, 0) << notice << size.x << "," << state;
        for (const char* name : {"sidebar", "timeline", "Timings", "History", "offer", "message"}) {
          const ImGuiWindow* other = ImGui::FindWindowByName(name);
          if (!other || other == shown || !other->Active) continue;
          EXPECT_FALSE(shown->Rect().Overlaps(other->Rect())) << notice << " over " << name << size.x << "," << state;
        }
      }
    }
  }
}

TEST_F(Notices, AFaultLeavesTheFaceFreeInLowWindows) {
  demo_.timeline.on = true;
  demo_.message = "/home/someone/hair/nothing.json: cannot be read: no such file; give the path of a file";
  demo_.message_is_fault = true;
  for (const ImVec2 size :
       {ImVec2(400, 300), ImVec2(480, 400), ImVec2(640, 480), ImVec2(1280, 300), ImVec2(960, 600)}) {
    for (const bool unfolded : {false, true}) {
      ImGui::GetIO().DisplaySize = size;
      ui_.unfolded = unfolded;
      for (int k = 0; k < 4; ++k) frame();
      const ImRect shown = ImGui::FindWindowByName("message")->Rect();
      EXPECT_GE(shown.Min.y, 0.3f * size.y) << size.x << unfolded;
      EXPECT_LE(shown.Max.y, size.y) << size.x << unfolded;
      EXPECT_NE(find("close_message"), nullptr) << size.x << unfolded;
    }
  }
}

// Wide enough for all panels and too low for the timings' whole length.
TEST_F(Notices, PanelsStandBesideOneAnotherInLowWindows) {
  demo_.timeline.on = true;
  for (const ImVec2 size : {ImVec2(1300, 800), ImVec2(1100, 480), ImVec2(1730, 333), ImVec2(1280, 300)}) {
    for (const bool history : {false, true}) {
      ImGui::GetIO().DisplaySize = size;
      ui_.history = history;
      for (int k = 0; k < 4; ++k) frame();
      EXPECT_NE(find("stage_bar"), nullptr) << size.x;
      for (const char* name : {"sidebar", "timeline", "Timings", "History"}) {
        const ImGuiWindow* one = ImGui::FindWindowByName(name);
        if (!one || !one->Active) continue;
        EXPECT_TRUE(one->Rect().Min.y >= 0 && one->Rect().Max.y <= size.y) << name << size.x << history;
        for (const char* other_name : {"sidebar", "timeline", "Timings", "History"}) {
          const ImGuiWindow* other = ImGui::FindWindowByName(other_name);
          if (!other || other == one || !other->Active) continue;
          EXPECT_FALSE(one->Rect().Overlaps(other->Rect())) << name << " over " << other_name << size.x << history;
        }
      }
    }
  }
}

TEST_F(Notices, TheRowOfButtonsHasRoomInItsPanelWhateverTheTextsSize) {
  for (const float scale : {0.5f, 0.625f, 0.75f, 1.0f, 2.0f}) {
    app::prepareUi(scale, ui_);
    unsigned char* pixels = nullptr;
    int width = 0, height = 0;
    ImGui::GetIO().Fonts->GetTexDataAsRGBA32(&pixels, &width, &height);
    ImGui::GetIO().DisplaySize = {416 * scale, 1400 * scale};
    for (int k = 0; k < 3; ++k) frame();
    const app::UiItem* last = find("panels");
    ASSERT_NE(last, nullptr) << scale;
    EXPECT_LE(last->x + last->width, ImGui::FindWindowByName("sidebar")->InnerClipRect.Max.x) << scale;
  }
}

TEST_F(Notices, WhatADragOnTheHairDoesIsSaidWherePanelsAreFolded) {
  ImGui::GetIO().DisplaySize = {400, 300};
  app::pressKey('G', demo_, ui_);
  frame(), frame();
  EXPECT_NE(find("message"), nullptr);
  EXPECT_EQ(demo_.message, "brush: comb; drag on the hair");
  app::pressKey('X', demo_, ui_);
  EXPECT_EQ(demo_.message, "hair mesh: click on one vertex; with Shift on more");
  app::pressKey(app::kKeyEscape, demo_, ui_);
  EXPECT_EQ(demo_.message, "a drag turns the view");
  demo_.message = "a.bvh: a fault; mend it";
  demo_.message_is_fault = true;
  app::pressKey('G', demo_, ui_);
  EXPECT_EQ(demo_.message, "a.bvh: a fault; mend it") << "a fault stays until it is closed";
}

class Views : public Notices {
 protected:
  void drag(double dx) {
    ImGui::GetIO().MouseDown[0] = true;
    for (int k = 0; k < 5; ++k) app::orbit(dx, 0, 700, demo_.camera), frame();
    ImGui::GetIO().MouseDown[0] = false;
    frame();
  }
  void press(int modifiers) {
    app::pressKey('Z', demo_, ui_, modifiers);
    apply(std::exchange(demo_.requests, {}));
  }
};

TEST_F(Views, ADragIsOneStepBackAndOn) {
  const double first = demo_.camera.yaw;
  drag(20);
  const double second = demo_.camera.yaw;
  drag(-60);
  const double third = demo_.camera.yaw;
  press(app::kNoModifier);
  EXPECT_EQ(demo_.camera.yaw, second);
  press(app::kNoModifier);
  EXPECT_EQ(demo_.camera.yaw, first);
  press(app::kNoModifier);
  EXPECT_EQ(demo_.message, "no view before this one");
  press(app::kShift), press(app::kShift);
  EXPECT_EQ(demo_.camera.yaw, third);
  press(app::kNoModifier), drag(10);
  press(app::kShift);
  EXPECT_EQ(demo_.message, "no view after this one") << "a new view ends those after it";
  EXPECT_TRUE(demo_.edits.steps.empty());
}

TEST_F(Views, LensNamedViewsAndFollowingAreStepsAndTheFigureMaySteerMeanwhile) {
  const app::Camera first = demo_.camera;
  apply({{Ask::kLens, "", "", 0.3}});
  apply({{Ask::kView, "back", ""}});
  apply({{Ask::kFollow, "", "", 0}});
  EXPECT_EQ(ui_.views.past.size(), 3u);
  demo_.camera.anchor += app::Vec3(1, 0, 0);
  frame();
  EXPECT_EQ(ui_.views.past.size(), 3u) << "a step of the figure";
  for (int k = 0; k < 3; ++k) press(app::kNoModifier);
  EXPECT_TRUE(demo_.camera.fov == first.fov && demo_.camera.yaw == first.yaw && demo_.camera.follow);
  EXPECT_EQ(ui_.views.future.size(), 3u);
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
