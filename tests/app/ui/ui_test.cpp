// The panels, driven as by a mouse but without a window: Dear ImGui is fed events and its requests are watched.
#include "app/ui/ui.h"

#include <gtest/gtest.h>
#include <imgui/imgui.h>
#include <imgui/imgui_internal.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>

#include "app/files/data_path.h"
#include "app/scene/demo.h"
#include "sim/stabilization/parameter_limits.h"
#include "tests/app/ui/panels.h"

namespace ui_test {

using app::Ask;
using app::UiItem;
using test::Panels;

TEST_F(Panels, TheTransportButtonsAskForWhatTheyShow) {
  EXPECT_TRUE(asked(click("pause"), Ask::kPause));
  EXPECT_TRUE(asked(click("step"), Ask::kSingleStep));
  EXPECT_TRUE(asked(click("reset"), Ask::kReset));
  EXPECT_TRUE(asked(click("restart"), Ask::kRestart));
  EXPECT_TRUE(asked(click("collapse"), Ask::kCollapse));
  EXPECT_TRUE(asked(click("screenshot"), Ask::kScreenshot));
  EXPECT_TRUE(asked(click("record"), Ask::kRecord));
  click("help");
  EXPECT_TRUE(ui_.help);
}

TEST_F(Panels, EveryFieldIsChosenToBePaintedAndColorIsPicked) {
  click("tab Hair");
  const std::array labels{"Stiff", "Length", "Density", "Mass",  "Bend", "Width",
                          "Clump", "Curl",   "Color",   "Rough", "Damp", "Frizz"};
  ASSERT_EQ(labels.size(), app::kFieldNames.size());
  for (std::size_t k = 0; k < labels.size(); ++k) {
    click(std::string("paint ") + labels[k]);
    EXPECT_EQ(ui_.brush.field, static_cast<int>(k)) << labels[k];
    const bool color = app::kFieldNames[k] == "color";
    EXPECT_EQ(find("brush_color") != nullptr, color);
    EXPECT_EQ(find("brush_value") != nullptr, !color);
  }
  click("paint No paint");
  EXPECT_EQ(ui_.brush.field, -1);
}

TEST_F(Panels, CurvesOfEveryFieldAreAskedFor) {
  ImGui::GetIO().DisplaySize = {1280, 1600};  // all rows
  click("tab Hair");
  click("section Root to tip");
  for (const std::string_view name : app::kCurveNames) {
    const std::string row = "curve_" + std::string(name) + (name == "color" ? "2" : "");
    const std::vector<app::Request> requests = click(row, 0.2f, -8);
    EXPECT_TRUE(std::ranges::any_of(requests, [&](const app::Request& one) {
      return one.what == Ask::kCurve && one.name == name;
    })) << row;
  }
}

TEST_F(Panels, APresetIsChosenByItsPicture) {
  EXPECT_GE(ui_.presets_in_sight.size(), 10u);
  const std::vector<app::Request> requests = click("preset_picture black");
  ASSERT_TRUE(asked(requests, Ask::kPresetFile));
  for (const app::Request& one : requests) {
    if (one.what == Ask::kPresetFile) {
      EXPECT_TRUE(one.text.ends_with("black.json")) << one.text;
    }
  }
  EXPECT_TRUE(demo_.scene.preset.empty()) << "it is chosen as it is applied";
  // The pointer over it asks what it changes.
  EXPECT_EQ(ui_.preset_scope, "changes how it looks");
}

TEST_F(Panels, PicturesOfPresetsAreAskedForWhereTheyAreInSightAlone) {
  click("tab Look");
  EXPECT_TRUE(ui_.presets_in_sight.empty());
  click("tab Simulation");
  EXPECT_FALSE(ui_.presets_in_sight.empty());
  ImGui::GetIO().DisplaySize = {1280, 380};
  frame(), frame();
  EXPECT_TRUE(ui_.presets_in_sight.empty()) << "the list alone";
  EXPECT_NE(find("##preset"), nullptr);
}

TEST_F(Panels, WhatPanelsLeaveFreeFollowsThem) {
  const auto part = [&] { return app::freePart(demo_, ui_); };
  const auto pixels = [&](double share, double side) { return std::lround(share * side); };
  demo_.timeline.on = true;
  EXPECT_EQ(pixels(part().left, 1280), 360);
  EXPECT_EQ(pixels(part().right, 1280), 1280 - 304);
  EXPECT_EQ(part().top, 0);
  EXPECT_EQ(pixels(part().bottom, 720), 720 - 62) << "above the timeline";
  ui_.visible = false;
  EXPECT_EQ(part().left, 0);
  EXPECT_EQ(part().right, 1);
  EXPECT_EQ(part().bottom, 1);
  ui_.visible = true;
  ui_.timings_folded = true;
  EXPECT_EQ(part().right, 1);
  ImGui::GetIO().DisplaySize = {700, 720};
  EXPECT_EQ(part().left, 0) << "the tabs are folded away";
  EXPECT_EQ(part().right, 1);
  ImGui::GetIO().DisplaySize = {960, 720};
  EXPECT_GT(part().left, 0.3);
  ui_.halved = true;
  EXPECT_EQ(part().left, 0) << "the left of two pictures has no room beside the sidebar";
}

// Whatever the window's size, tab and text size, no panel that stays lies over the part that is the figure's.
TEST_F(Panels, NoPanelLiesOverWhatIsLeftFree) {
  constexpr double kRounding = 4;  // px
  for (const ImVec2 size :
       {ImVec2(1280, 720), ImVec2(960, 600), ImVec2(800, 600), ImVec2(640, 480), ImVec2(400, 300)}) {
    for (const bool unfolded : {false, true}) {
      for (const bool fault : {false, true}) {
        if (fault && size.y < 400) continue;  // its box takes nearly all
        ImGui::GetIO().DisplaySize = size;
        demo_.timeline.on = true;
        ui_.unfolded = unfolded;
        demo_.message = fault ? "a file that cannot be used: line 5: it has 7 channels; give it 3 or 6" : "";
        demo_.message_is_fault = fault;
        for (int k = 0; k < 4; ++k) frame();
        const app::PicturePart free = app::freePart(demo_, ui_);
        EXPECT_GT((free.right - free.left) * size.x, 0.3 * size.x) << size.x;
        EXPECT_GT((free.bottom - free.top) * size.y, 0.2 * size.y) << size.x;
        for (const char* name : {"sidebar", "timeline", "message"}) {
          const ImGuiWindow* window = ImGui::FindWindowByName(name);
          if (!window || !window->Active) continue;
          const ImRect rect = window->Rect();
          const bool beside =
              rect.Max.x <= free.left * size.x + kRounding || rect.Min.x >= free.right * size.x - kRounding;
          EXPECT_TRUE(beside || rect.Min.y >= free.bottom * size.y - kRounding)
              << name << " at " << size.x << (unfolded ? " unfolded" : "") << (fault ? " with a fault" : "");
        }
      }
    }
  }
}

TEST_F(Panels, EveryTabOpensByAClickOnIt) {
  for (const char* tab : {"tab Motion", "tab Hair", "tab Look", "tab Debug", "tab Simulation"}) click(tab);
  EXPECT_NE(find("density"), nullptr);
  click("tab Hair");
  EXPECT_NE(find("style Short"), nullptr);
}

TEST_F(Panels, EveryRowOfTheSimulationTableIsThere) {
  // All sections opened one after the other, by clicking on those that are closed; tall enough that none is below the
  // fold.
  ImGui::GetIO().DisplaySize = {1280, 3000};
  openTab(0);
  for (const char* group : {"World", "Rest shape", "Time", "Numerics"}) click(std::string("section ") + group, 0.3f);
  frame();
  for (const sim::ParamField& field : sim::paramFields()) EXPECT_NE(find(field.name), nullptr) << field.name;
}

TEST_F(Panels, DraggingASliderSetsTheParameterAndItsMarkResetsIt) {
  openTab(0);
  EXPECT_EQ(find("reset density"), nullptr);
  const auto requests = click("density", 0.5f, 40);
  ASSERT_TRUE(asked(requests, Ask::kSetParam, "density"));
  demo_.requests = requests;
  app::applyRequests(demo_);
  EXPECT_NE(demo_.scene.sim.density, sim::SimParams{}.density);
  frame();
  const auto reset = click("reset density");
  ASSERT_TRUE(asked(reset, Ask::kSetParam, "density"));
  demo_.requests = reset;
  app::applyRequests(demo_);
  EXPECT_EQ(demo_.scene.sim.density, sim::SimParams{}.density);
}

// The digits stand in the middle of a slider; nothing of the mark's colour is drawn there.
TEST_F(Panels, NoSlidersMarkLiesBehindItsDigits) {
  openTab(0);
  const UiItem* slider = find("density");
  ASSERT_NE(slider, nullptr);
  const float low = slider->y, high = slider->y + slider->height;
  const ImU32 mark = ImGui::GetColorU32(ImGuiCol_SliderGrab) & ~IM_COL32_A_MASK;
  int vertices = 0;
  const ImDrawData* drawn = ImGui::GetDrawData();
  for (int k = 0; k < drawn->CmdListsCount; ++k) {
    for (const ImDrawVert& vertex : drawn->CmdLists[k]->VtxBuffer) {
      if ((vertex.col & ~IM_COL32_A_MASK) != mark || vertex.pos.y < low || vertex.pos.y > high) continue;
      ++vertices;
      EXPECT_GT(vertex.pos.y, high - 0.25f * (high - low));
    }
  }
  EXPECT_GT(vertices, 0);
}

TEST_F(Panels, ASliderBelowWhatTheHairBearsSaysWhatIsUsedAndWhy) {
  ImGui::GetIO().DisplaySize = {1280, 3000};
  openTab(0);
  click("section World", 0.3f);
  for (const char* name : {"stretch_along", "wind_x", "wind_z"}) EXPECT_EQ(noteOf(name), "") << name;
  sim::SimParams& params = demo_.scene.sim;
  params.stretch_along = 100;
  const double bearable = sim::limitedParameters(app::selectedActor(demo_).haircut->mesh, params).stretch_along;
  char expected[80];
  std::snprintf(expected, sizeof expected, "used: %.3g kPa, to bear the hair's weight", bearable / 1000);
  EXPECT_EQ(noteOf("stretch_along"), expected);
  EXPECT_EQ(noteOf("density"), "");
  params.wind_x = -40, params.air_drag = 10;
  EXPECT_TRUE(noteOf("stretch_along").ends_with("the hair's weight and the wind")) << noteOf("stretch_along");
  EXPECT_EQ(noteOf("wind_x"), "used: -10 m/s, with this air drag and gust, more would only crush the hair");
  EXPECT_EQ(noteOf("wind_z"), "");
  params.solver = sim::Solver::kPaper;
  for (const char* name : {"stretch_along", "wind_x"}) EXPECT_EQ(noteOf(name), "") << name;
}

TEST_F(Panels, StylesAndResolutionsAreButtons) {
  openTab(2);
  EXPECT_TRUE(asked(click("style Long"), Ask::kStyle, "long"));
  EXPECT_TRUE(asked(click("resolution High"), Ask::kResolution, "high"));
}

TEST_F(Panels, SpeedAndScrubAreAskedFor) {
  openTab(1);
  EXPECT_TRUE(asked(click("speeds 10x"), Ask::kSpeed));
  EXPECT_TRUE(asked(click("scrub", 0.4f, 30), Ask::kCarryAlong));
  EXPECT_TRUE(asked(click("hold", 0.5f), Ask::kPauseMotion));
  EXPECT_TRUE(asked(click("loop Go on"), Ask::kLoop, "go-on"));
  EXPECT_TRUE(asked(click("loop None"), Ask::kLoop, "none"));
  EXPECT_TRUE(asked(click("save_state", 0.5f), Ask::kSaveState));
  EXPECT_TRUE(asked(click("load_state", 0.5f), Ask::kLoadState));
  EXPECT_TRUE(asked(click("substeps 4"), Ask::kSetParam, "time_step"));
}

TEST_F(Panels, DebugViewsSwitch) {
  openTab(4);
  for (const app::DebugView& view : app::kDebugViews) {
    EXPECT_TRUE(asked(click("debug " + std::string(view.name), 0.1f), Ask::kDebugView, std::string(view.name)))
        << view.name;
  }
}

TEST_F(Panels, AFaultIsShownUntilItIsClosed) {
  demo_.message = "file.bvh: line 3: a fault; mend it";
  demo_.message_is_fault = true;
  for (int i = 0; i < 600; ++i) frame();
  ASSERT_NE(find("close_message"), nullptr);
  click("close_message");
  EXPECT_TRUE(demo_.message.empty());
}

TEST_F(Panels, PanelsLeaveTheMiddleToTheFigure) {
  for (const UiItem& item : ui_.items) {
    const bool left = item.x + item.width <= 380, right = item.x >= 960;
    EXPECT_TRUE(left || right) << item.name << " at " << item.x;
  }
}

TEST_F(Panels, HiddenPanelsDrawNothing) {
  const app::SkipCount& hidden = demo_.stats.always[app::kHiddenPanels];
  demo_.stats = {};
  frame();
  EXPECT_EQ(hidden.skipped, 0);
  EXPECT_EQ(hidden.of, 1);
  app::pressKey(app::kKeyTab, demo_, ui_);
  demo_.stats = {};
  frame();
  EXPECT_TRUE(ui_.items.empty());
  EXPECT_EQ(ImGui::GetDrawData()->TotalVtxCount, 0);
  EXPECT_EQ(hidden.skipped, 1);
  EXPECT_EQ(hidden.of, 1);
}

TEST_F(Panels, NoTinyNorHugeWindowMakesThemCrash) {
  for (const ImVec2 size : {ImVec2(16, 16), ImVec2(0, 0), ImVec2(300, 40), ImVec2(8000, 6000)}) {
    ImGui::GetIO().DisplaySize = size;
    for (int tab = 0; tab < 5; ++tab) openTab(tab);
  }
}

TEST_F(Panels, EveryKeyOfTheListDoesSomething) {
  for (const int key :
       {int(' '), int('.'), int('R'), int('C'), int('1'), int('2'), int('3'),          int('4'), int('5'),
        int('6'), int('-'), int('='), int('F'), int('S'), int('B'), int('T'),          int('Q'), int('L'),
        int('M'), int('E'), int('V'), int('N'), int('P'), int('K'), int(app::kKeyHome)}) {
    demo_.requests.clear();
    EXPECT_TRUE(app::pressKey(key, demo_, ui_)) << key;
    EXPECT_FALSE(demo_.requests.empty()) << key;
  }
  demo_.requests.clear();
  app::pressKey('/', demo_, ui_);
  EXPECT_TRUE(ui_.help);
  app::pressKey(app::kKeyEscape, demo_, ui_);
  EXPECT_FALSE(ui_.help || ui_.quit);
  EXPECT_FALSE(app::pressKey('W', demo_, ui_));
}

TEST_F(Panels, EscapeAsksBeforeItLeaves) {
  app::pressKey(app::kKeyEscape, demo_, ui_);
  EXPECT_FALSE(ui_.quit);
  frame(), frame();
  EXPECT_NE(find("leave"), nullptr);
  app::pressKey('F', demo_, ui_);
  app::pressKey(app::kKeyEscape, demo_, ui_);
  frame();
  EXPECT_FALSE(ui_.quit);
  EXPECT_EQ(find("leave"), nullptr);
  app::pressKey(app::kKeyEscape, demo_, ui_);
  frame(), frame();
  click("leave");
  EXPECT_TRUE(ui_.quit);
}

TEST_F(Panels, APresetThatIsThereAlreadyIsReplacedOnASecondPress) {
  openTab(0);
  const std::string name = "ui_test_preset";
  std::copy(name.begin(), name.end(), ui_.preset_name.begin());
  EXPECT_TRUE(asked(click("save_preset"), Ask::kSavePreset));
  std::ofstream(name + ".json") << "{}";
  EXPECT_FALSE(asked(click("save_preset"), Ask::kSavePreset));
  EXPECT_TRUE(asked(click("save_preset"), Ask::kSavePreset));
  std::filesystem::remove(name + ".json");
}

TEST_F(Panels, ARowThatAnotherOneMakesIdleDoesNotMove) {
  demo_.actors[0].spec.look.hair.curl_radius = 0;
  openTab(2);
  ImGui::GetIO().DisplaySize = {1280, 3000};
  frame();
  frame();
  EXPECT_FALSE(asked(click("curl_pitch", 0.5f, 40), Ask::kSetParam));
  demo_.actors[0].spec.look.hair.curl_radius = 0.01f;
  frame();
  EXPECT_TRUE(asked(click("curl_pitch", 0.5f, 40), Ask::kSetParam, "curl_pitch"));
}

TEST_F(Panels, SearchFindsRowsOfAllTables) {
  openTab(0);
  const std::string_view wanted = "rough";
  std::copy(wanted.begin(), wanted.end(), ui_.search.begin());
  frame();
  frame();
  EXPECT_NE(find("beta_m"), nullptr);
  EXPECT_NE(find("body_roughness"), nullptr);
  EXPECT_EQ(find("density"), nullptr);
}

bool overlap(const UiItem& a, const UiItem& b) {
  return a.x < b.x + b.width && b.x < a.x + a.width && a.y < b.y + b.height && b.y < a.y + a.height;
}

TEST_F(Panels, AFaultCanBeReadAndClosedInWindowsOfAnySize) {
  for (const ImVec2 size : {ImVec2(1280, 720), ImVec2(960, 600), ImVec2(400, 300)}) {
    ImGui::GetIO().DisplaySize = size;
    demo_.message = "/a/rather/long/path/to/a/file/that/cannot/be/used.bvh: line 5: it has 7 channels; give it 3 or 6";
    demo_.message_is_fault = true;
    for (int k = 0; k < 4; ++k) frame();
    const UiItem* close = find("close_message");
    ASSERT_NE(close, nullptr);
    EXPECT_TRUE(close->x >= 0 && close->y >= 0 && close->x + close->width <= size.x &&
                close->y + close->height <= size.y)
        << size.x;
    click("close_message");
    EXPECT_TRUE(demo_.message.empty()) << size.x << "x" << size.y;
    const UiItem *bar = find("stage_bar"), *sidebar = find("tab Debug");
    if (bar && sidebar) {
      EXPECT_FALSE(overlap(*bar, *sidebar)) << size.x;
    }
  }
}

// In points, from 400 x 300 on; smaller windows and larger texts come to these by fittingTextScale.
TEST_F(Panels, EverythingIsReachedInSmallWindows) {
  for (const ImVec2 size : {ImVec2(400, 300), ImVec2(500, 350), ImVec2(640, 400), ImVec2(960, 600)}) {
    ImGui::GetIO().DisplaySize = size;
    demo_.timeline.on = true;
    const auto within = [&](const char* name) {
      const UiItem* item = find(name);
      EXPECT_NE(item, nullptr) << name << " at " << size.x;
      if (!item) return;
      EXPECT_TRUE(item->x >= 0 && item->y >= 0 && item->x + item->width <= size.x && item->y + item->height <= size.y)
          << name << " at " << size.x;
    };
    ui_.unfolded = false;
    for (int k = 0; k < 3; ++k) frame();
    for (const char* name : {"timeline", "cache", "range In", "range Out", "range Bake", "range Clear"}) within(name);
    const UiItem *strip = find("timeline"), *bake = find("range Bake"), *pause = find("pause");
    ASSERT_TRUE(strip && bake && pause);
    EXPECT_FALSE(overlap(*strip, *bake)) << size.x;
    EXPECT_FALSE(overlap(*pause, *bake) || overlap(*pause, *strip)) << size.x;
    EXPECT_GT(strip->width, 100) << size.x;
    ui_.unfolded = true;
    for (int tab = 0; tab < 5; ++tab) openTab(tab);
    for (const char* name : {"tab Simulation", "tab Motion", "tab Hair", "tab Look", "tab Debug", "file History"})
      within(name);
    EXPECT_NE(find("stage_bar"), nullptr) << "timings at " << size.x;
  }
  EXPECT_EQ(app::fittingTextScale(2, 960, 600), 2);
  EXPECT_EQ(app::fittingTextScale(2, 640, 400), 1.25f);
  EXPECT_EQ(app::fittingTextScale(1, 500, 350), 1);
  EXPECT_EQ(app::fittingTextScale(1, 100, 100), 0.5f);
}

// The rows of buttons, files and tabs leave a low window five rows of a tab.
TEST_F(Panels, ASheetInASmallWindowShowsRowsBelowItsTabs) {
  ImGui::GetIO().DisplaySize = {640, 480};
  demo_.timeline.on = true;
  ui_.unfolded = true;
  openTab(0);
  const UiItem *pause = find("pause"), *open = find("file Open"), *tab = find("tab Debug"), *scene = find("scene"),
               *vary = find("vary");
  ASSERT_TRUE(pause && open && tab && scene && vary);
  EXPECT_LT(std::abs(open->y - pause->y), 8);
  EXPECT_LT(std::abs(scene->y - tab->y), 4);
  EXPECT_FALSE(overlap(*scene, *tab));
  const ImRect sheet = ImGui::FindWindowByName("sidebar")->Rect();
  EXPECT_LT(vary->y + vary->height, sheet.Max.y);
  EXPECT_TRUE(asked(click("file Open"), Ask::kOpenFile) || ui_.browser.what == app::BrowseFor::kOpen);
}

TEST_F(Panels, OneVariationReplacesTheLastUntilItIsKept) {
  openTab(0);
  const auto press = [&](const char* name) {
    std::vector<app::Request> wanted = click(name);
    std::erase_if(wanted, [](const app::Request& request) { return request.what == app::Ask::kEndGesture; });
    demo_.requests = wanted;
    app::advanceFrame(demo_, 0, {});
    return wanted;
  };
  EXPECT_EQ(press("vary").size(), 1u);
  const double first = demo_.scene.sim.bend;
  EXPECT_EQ(press("vary").size(), 2u) << "the last one is undone";
  EXPECT_NE(demo_.scene.sim.bend, first);
  press("keep_variation");
  EXPECT_EQ(press("vary").size(), 1u);
  EXPECT_EQ(demo_.edits.done, 2u);
}

}  // namespace ui_test
