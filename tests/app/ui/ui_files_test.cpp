// The file panel, the rows on top in windows of any size, and what the panels tell by themselves.
#include <gtest/gtest.h>
#include <imgui/imgui.h>
#include <imgui/imgui_internal.h>

#include <filesystem>
#include <fstream>
#include <future>

#include "app/files/data_path.h"
#include "app/scene/project.h"
#include "app/ui/ui_panels.h"
#include "tests/app/ui/panels.h"
#include "tests/run_program.h"

namespace ui_files_test {

using app::Ask;
using app::UiItem;
using test::Panels;

const app::Request* requestOf(const std::vector<app::Request>& requests, Ask what) {
  for (const app::Request& request : requests) {
    if (request.what == what) return &request;
  }
  return nullptr;
}

TEST_F(Panels, AFileIsFoundAndOpenedAndThenIsAmongTheRecentOnes) {
  const std::string folder = test::freshFolder("ui_files");
  std::filesystem::create_directories(folder + "/inner");
  std::filesystem::copy_file(app::dataPath("assets/presets/soft.json"), folder + "/inner/a.json");
  ui_.browser.folder = folder;
  ui_.kept_folder = folder + "/kept";
  click("file Open");
  click("entry inner");
  ASSERT_NE(find("entry a.json"), nullptr);
  click("entry a.json");
  const auto requests = click("file_take");
  const app::Request* open = requestOf(requests, Ask::kOpenFile);
  ASSERT_NE(open, nullptr);
  EXPECT_TRUE(std::filesystem::equivalent(open->text, folder + "/inner/a.json"));
  EXPECT_EQ(find("file_take"), nullptr) << "the panel is still there";
  EXPECT_TRUE(ui_.recent.empty()) << "before it has been opened";
  apply(requests);
  EXPECT_EQ(app::readRecent(ui_.kept_folder).size(), 1u);
  click("file Open");
  EXPECT_NE(find("recent a.json"), nullptr);
  click("place Up");
  EXPECT_NE(find("entry inner"), nullptr);
  app::pressKey(app::kKeyEscape, demo_, ui_);
  frame();
  EXPECT_EQ(find("file_take"), nullptr);
  EXPECT_FALSE(ui_.leaving);
}

TEST_F(Panels, ARefusedFileIsNotAmongTheRecentOnes) {
  const std::string folder = test::freshFolder("ui_refused");
  ui_.kept_folder = folder + "/kept";
  const std::string hair = folder + "/hair.obj", preset = folder + "/preset.json", gone = folder + "/gone.json";
  std::ofstream(hair) << "v 0 0 0\n";
  for (const std::string& file : {preset, gone}) std::ofstream(file) << "{\"sim\": {\"density\": 70}}";
  const auto open = [&](const std::string& file) {
    app::openFile(file, demo_, ui_);
    apply(frame());
  };
  open(hair);
  EXPECT_TRUE(demo_.message_is_fault) << demo_.message;
  open(folder + "/none.json");
  EXPECT_TRUE(ui_.recent.empty()) << ui_.recent[0];
  open(gone), open(preset);
  EXPECT_EQ(ui_.recent, (std::vector<std::string>{preset, gone}));
  // One that was among them and is refused now, and one that is no longer there.
  std::ofstream(preset) << "{\"sim\": {\"density\": true}}";
  open(preset);
  EXPECT_EQ(ui_.recent, std::vector<std::string>{gone});
  EXPECT_EQ(app::readRecent(ui_.kept_folder), ui_.recent);
  std::filesystem::remove(gone);
  app::browseFor(app::BrowseFor::kOpen, ui_);
  EXPECT_TRUE(ui_.recent.empty());
}

TEST_F(Panels, AFileLoadedBesideTheFramesIsNotedOnceItIsThere) {
  const std::string folder = test::freshFolder("ui_beside");
  const std::string bad = folder + "/bad.bvh";
  std::ofstream(bad) << "HIERARCHY\nROOT hips\n";
  demo_.loading.on = true;
  for (const std::string& file : {bad, app::dataPath("assets/clips/walk.bvh")}) {
    app::openFile(file, demo_, ui_);
    apply(frame());
    EXPECT_TRUE(ui_.recent.empty()) << "before it has been loaded";
    ASSERT_TRUE(demo_.loading.running.valid());
    demo_.loading.running.wait();
    apply({});
    EXPECT_EQ(ui_.recent.empty(), file == bad) << demo_.message;
  }
}

TEST_F(Panels, ASavedSceneIsAmongTheRecentOnesOnceItIsWritten) {
  const std::string file = test::freshFolder("ui_saved") + "/kept.json";
  ui_.asked = {file};
  apply({{Ask::kSaveScene, "", file + "/no/folder.json"}});
  EXPECT_TRUE(ui_.recent.empty());
  apply({{Ask::kSaveScene, "", file}});
  EXPECT_EQ(ui_.recent, std::vector<std::string>{file});
}

// What is typed there would else paint, reset, or quit.
TEST_F(Panels, WhileAFileIsNamedKeysAreTextAndTheNameIsReadyToBeTyped) {
  ui_.browser.folder = test::freshFolder("ui_name");
  EXPECT_TRUE(app::pressKey('O', demo_, ui_, app::kControl));
  for (int k = 0; k < 3; ++k) frame();
  EXPECT_TRUE(ImGui::GetIO().WantTextInput);
  demo_.requests.clear();
  for (const int key : {int('R'), int('C'), int(' '), int('/'), int(app::kKeyTab), int(app::kKeyHome)})
    EXPECT_FALSE(app::pressKey(key, demo_, ui_)) << key;
  EXPECT_FALSE(app::pressKey('Z', demo_, ui_, app::kControl));
  EXPECT_TRUE(demo_.requests.empty());
  EXPECT_FALSE(ui_.help);
  EXPECT_TRUE(app::pressKey(app::kKeyEscape, demo_, ui_));
  EXPECT_TRUE(app::pressKey('R', demo_, ui_));
}

TEST_F(Panels, ASceneIsSavedAndOneThatIsThereOnlyOnASecondPress) {
  const std::string folder = test::freshFolder("ui_save_scene");
  std::ofstream(folder + "/there.json") << "{}";
  ui_.browser.folder = folder;
  for (const std::string name : {"fresh", "there"}) {
    click("file Save");
    frame();
    for (const char letter : name) ImGui::GetIO().AddInputCharacter(static_cast<unsigned>(letter));
    frame();
    EXPECT_EQ(ui_.browser.name.data(), name);
    const auto first = click("file_take");
    if (name == "there") {
      EXPECT_EQ(requestOf(first, Ask::kSaveScene), nullptr);
    }
    const auto last = name == "there" ? click("file_take") : first;
    const app::Request* save = requestOf(last, Ask::kSaveScene);
    ASSERT_NE(save, nullptr) << name;
    EXPECT_TRUE(save->text.ends_with(name + ".json")) << save->text;
  }
}

TEST_F(Panels, WhereASaveFailsTheNameIsAskedForAgain) {
  const std::string folder = test::freshFolder("ui_save_fails"), file = folder + "/no/such/mine.json";
  ui_.browser.folder = folder;
  click("file Save");
  frame();
  for (const char letter : std::string("no/such/mine")) ImGui::GetIO().AddInputCharacter(static_cast<unsigned>(letter));
  frame();
  apply(click("file_take"));
  frame();
  EXPECT_TRUE(demo_.message_is_fault) << demo_.message;
  EXPECT_EQ(ui_.browser.what, app::BrowseFor::kSaveScene);
  EXPECT_EQ(std::string(ui_.browser.name.data()), file);
}

// Ctrl+S, Enter, Enter.
TEST_F(Panels, ASceneIsSavedOverItselfByTheKeyboard) {
  const std::string file = test::freshFolder("ui_save_again") + "/mine.json";
  apply({{Ask::kSaveScene, "", file}});
  ui_.browser.folder.clear();
  app::pressKey('S', demo_, ui_, app::kControl);
  ImGuiIO& io = ImGui::GetIO();
  io.KeyMap[ImGuiKey_Enter] = app::kKeyEnter;
  const auto enter = [&] {
    std::vector<app::Request> all;
    for (const bool down : {false, false, true, false, false}) {
      io.KeysDown[app::kKeyEnter] = down;
      for (const app::Request& one : frame()) all.push_back(one);
    }
    return all;
  };
  EXPECT_EQ(requestOf(enter(), Ask::kSaveScene), nullptr);
  EXPECT_NE(find("replaces"), nullptr) << "nothing says why it is not saved";
  const auto last = enter();
  const app::Request* save = requestOf(last, Ask::kSaveScene);
  ASSERT_NE(save, nullptr);
  EXPECT_EQ(save->text, file);
  EXPECT_EQ(find("file_take"), nullptr);
}

TEST_F(Panels, ANameThatIsOfferedIsTypedOverAtEveryOpening) {
  demo_.scene.name = "other";
  demo_.scene.file = test::freshFolder("ui_name_again") + "/other.json";
  for (const int key : {'S', 'S', 'O', 'S'}) {
    app::pressKey(key, demo_, ui_, app::kControl);
    for (int k = 0; k < 3; ++k) frame();
    for (const char letter : std::string("new")) ImGui::GetIO().AddInputCharacter(static_cast<unsigned>(letter));
    frame();
    EXPECT_STREQ(ui_.browser.name.data(), "new");
    app::pressKey(app::kKeyEscape, demo_, ui_);
    for (int k = 0; k < 3; ++k) frame();
  }
}

// The folder of what is kept by itself is one that the offer of an earlier run, or a person, has come to.
TEST_F(Panels, WhatIsKeptByItselfIsNoPlaceToSaveTo) {
  ui_.kept_folder = ui_.browser.folder = test::freshFolder("ui_kept");
  demo_.scene.name = "mine";
  for (const std::string& scene : {app::dataPath("assets/scenes/default.json"), std::string()}) {
    demo_.scene.file = scene;
    ui_.browser.folder = ui_.kept_folder;
    app::browseToSave(demo_, ui_);
    EXPECT_TRUE(std::filesystem::equivalent(ui_.browser.folder, "."));
    EXPECT_STREQ(ui_.browser.name.data(), scene.empty() ? "mine" : "default");
  }
  apply({{Ask::kSaveScene, "", ui_.kept_folder + "/mine.json"}});
  app::browseToSave(demo_, ui_);
  EXPECT_EQ(ui_.browser.folder, ui_.kept_folder) << "a person has saved it there";
}

// A project that was opened is saved as one again, and a scene as a scene, whatever was saved before.
TEST_F(Panels, WhatWasOpenedIsSavedAsWhatItIs) {
  const std::string folder = test::freshFolder("ui_save_kind"), project = folder + "/p.json",
                    scene = folder + "/s.json";
  app::saveProject(project, demo_);
  apply({{Ask::kSaveScene, "", scene}});
  for (const std::string& opened : {project, scene, project}) {
    app::openFile(opened, demo_, ui_);
    apply(frame());
    ASSERT_EQ(demo_.scene.file, opened) << demo_.message;
    app::browseToSave(demo_, ui_);
    EXPECT_EQ(ui_.browser.project, opened == project);
    app::pressKey(app::kKeyEscape, demo_, ui_);
  }
}

// Opened by the offer: what it has left is forgotten once this run is kept itself, a refused one stays.
TEST_F(Panels, ARunGoesOnFromAnOfferedProjectOnceItIsOpen) {
  const std::string folder = test::freshFolder("ui_offer"), file = folder + "/a.json";
  app::saveProject(file, demo_);
  for (const std::string& offered : {folder + "/none.json", file}) {
    ui_.offered = offered;
    frame(), frame();
    apply(click("offer_open"));
    EXPECT_EQ(ui_.gone_on_from, offered == file ? file : "");
    EXPECT_TRUE(ui_.to_go_on_from.empty());
    EXPECT_EQ(app::isUnsaved(demo_.edits), offered == file) << "a person has not saved it";
    demo_.message.clear();
  }
}

// A panorama of two rows: above brighter than below.
std::string panorama(const std::string& file) {
  std::ofstream(file, std::ios::binary) << "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 4\n"
                                        << "\x80\x80\x80\x82\x80\x80\x80\x82\x80\x80\x80\x82\x80\x80\x80\x82"
                                        << "\x80\x80\x80\x80\x80\x80\x80\x80\x80\x80\x80\x80\x80\x80\x80\x80";
  return file;
}

TEST_F(Panels, APanoramaIsOpenedShownTakenBackAndTakenOff) {
  const std::string file = panorama(test::freshFolder("ui_panorama") + "/studio.hdr");
  const render::LightInput before = demo_.scene.look.light;
  app::openFile(file, demo_, ui_);
  apply(frame());
  EXPECT_FALSE(demo_.message_is_fault) << demo_.message;
  const render::LightInput lit = demo_.scene.look.light;
  EXPECT_NE(lit, before);
  EXPECT_NE(app::writeScene(demo_.scene).find("\"to_fill\""), std::string::npos) << "a saved scene has its lights";
  openTab(app::tabIndex("look"));
  click("section Light");
  EXPECT_NE(find("environment studio"), nullptr);
  apply({{Ask::kUndo, "", "", 1}});
  EXPECT_EQ(demo_.scene.look.light, before);
  EXPECT_EQ(find("environment studio"), nullptr);
  apply({{Ask::kRedo, "", "", 1}});
  EXPECT_EQ(demo_.scene.look.light, lit);
  apply(click("no environment"));
  EXPECT_EQ(demo_.scene.look.light, before);
  click("open environment");
  EXPECT_EQ(ui_.browser.what, app::BrowseFor::kEnvironment);
}

TEST_F(Panels, APictureThatIsNoPanoramaIsRefusedWithWhatWouldBe) {
  apply({{Ask::kOpenFile, "", app::dataPath("assets/maps/bob_length.png")}});
  apply({});
  EXPECT_TRUE(demo_.message_is_fault);
  EXPECT_NE(demo_.message.find("is no Radiance picture"), std::string::npos) << demo_.message;
  EXPECT_NE(demo_.message.find(".hdr"), std::string::npos) << demo_.message;
}

TEST_F(Panels, PathFieldsHaveAnOpenButton) {
  openTab(1);
  click("open ##motion_path");
  EXPECT_EQ(ui_.browser.what, app::BrowseFor::kMotion);
  click("file_cancel");
  EXPECT_EQ(ui_.browser.what, app::BrowseFor::kNothing);
  ImGui::GetIO().DisplaySize = {1280, 3000};  // its row is below the fold of the usual window
  openTab(2);
  click("open ##hair_path");
  EXPECT_EQ(ui_.browser.what, app::BrowseFor::kHair);
}

TEST_F(Panels, ANarrowWindowFoldsTheTabsUntilTheyAreAskedFor) {
  for (const ImVec2 size : {ImVec2(400, 300), ImVec2(500, 350), ImVec2(700, 500)}) {
    ImGui::GetIO().DisplaySize = size;
    demo_.timeline.on = true;
    ui_.unfolded = false;
    for (int k = 0; k < 3; ++k) frame();
    EXPECT_EQ(find("tab Debug"), nullptr) << size.x;
    ASSERT_NE(find("panels"), nullptr) << size.x;
    for (const UiItem& item : ui_.items) {
      EXPECT_TRUE(item.y >= 0.5f * size.y || item.x >= 0.6f * size.x) << item.name << " covers the face at " << size.x;
      EXPECT_LE(item.x + item.width, size.x) << item.name;
    }
    click("panels");
    frame();
    EXPECT_NE(find("tab Debug"), nullptr) << size.x;
    EXPECT_NE(find("file Open"), nullptr) << size.x;
  }
}

// Unfolded in a window where the sidebar would cover the figure, the tabs leave it the upper half.
TEST_F(Panels, UnfoldedInANarrowWindowTheyLeaveTheUpperHalfToTheFigure) {
  for (const ImVec2 size : {ImVec2(640, 480), ImVec2(480, 400), ImVec2(720, 600)}) {
    ImGui::GetIO().DisplaySize = size;
    demo_.timeline.on = true;
    ui_.unfolded = true;
    for (int tab = 0; tab < 5; ++tab) openTab(tab);
    for (const char* name : {"panels", "scene", "tab Hair", "file Open"})
      EXPECT_NE(find(name), nullptr) << name << size.x;
    for (const UiItem& item : ui_.items) EXPECT_GE(item.y, 0.5f * size.y) << item.name << " at " << size.x;
  }
}

TEST_F(Panels, AMessageAndTheHistoryStandBesideOneAnother) {
  for (const ImVec2 size : {ImVec2(1280, 720), ImVec2(960, 600), ImVec2(640, 480), ImVec2(480, 400)}) {
    ImGui::GetIO().DisplaySize = size;
    ui_.history = true;
    demo_.message = "/a/rather/long/path/to/a/file/that/cannot/be/used.bvh: line 5: it has 7 channels; give it 3 or 6";
    demo_.message_is_fault = true;
    for (int k = 0; k < 4; ++k) frame();
    const ImGuiWindow *message = ImGui::FindWindowByName("message"), *history = ImGui::FindWindowByName("History");
    ASSERT_TRUE(message && history);
    EXPECT_FALSE(message->Rect().Overlaps(history->Rect())) << size.x;
    EXPECT_TRUE(message->Rect().Min.y >= 0 && message->Rect().Max.x <= size.x) << size.x;
  }
}

TEST_F(Panels, TheLineOfAComparisonBeginsInTheMiddleOfWhatPanelsLeaveFree) {
  const auto placed = [&] {
    const std::vector<app::Request> requests = frame();
    const app::Request* asked = requestOf(requests, Ask::kCompareView);
    return asked ? asked->value : -1;
  };
  EXPECT_EQ(placed(), -1) << "nothing is compared";
  app::startComparison("", demo_);
  const app::UiItem *left = find("scene"), *right = find("stage_bar");
  ASSERT_TRUE(left && right);
  const double middle = 0.5 * (left->x + left->width + right->x);
  EXPECT_NEAR(placed() * 1280, middle, 14);
  EXPECT_EQ(placed(), -1) << "once";
  demo_.comparison.other.clear();
  frame();
  ImGui::GetIO().DisplaySize = {640, 480};
  app::startComparison("", demo_);
  EXPECT_EQ(placed(), 0.5);
}

// Two discs of 12 corners a root, each with a soft edge.
TEST_F(Panels, PaintDotsOnTheFarSideOfTheHeadAreHidden) {
  constexpr int kDot = 2 * 2 * 12;
  ui_.brush.field = 0;
  ImGui::GetIO().MousePos = {640, 4};
  const int columns = demo_.actors[0].haircut->mesh.columnCount();
  for (const double yaw : {0.0, 1.6, 3.1}) {
    demo_.camera.yaw = yaw;
    frame();
    const int dots = ImGui::GetBackgroundDrawList()->VtxBuffer.Size / kDot;
    EXPECT_GT(dots, columns / 5) << yaw;
    EXPECT_LT(dots, columns * 9 / 10) << yaw;
  }
}

TEST_F(Panels, LoadingIsToldAsLongAsItGoesOn) {
  std::promise<std::vector<app::PartDistance>> promise;
  demo_.actors[0].body->parts_coming = promise.get_future();
  demo_.message.clear();
  for (int i = 0; i < 600; ++i) frame();
  EXPECT_NE(find("message"), nullptr);
  demo_.actors[0].body->parts_coming = {};
  frame();
  EXPECT_EQ(find("message"), nullptr);
}

TEST_F(Panels, ThePresetBoxSaysWhatWasChosenAndWhetherItWasChanged) {
  openTab(0);
  demo_.scene.preset = app::dataPath("assets/presets/soft.json");
  frame();
  EXPECT_NE(find("preset Soft"), nullptr);
  demo_.scene.sim.density += 1;
  frame();
  EXPECT_NE(find("preset Soft, changed"), nullptr);
  demo_.scene.sim.density -= 1;
  frame();
  EXPECT_NE(find("preset Soft"), nullptr);
}

TEST_F(Panels, ThePresetBoxFollowsUndoAndRedo) {
  openTab(0);
  const auto apply = [&](std::vector<app::Request> requests) {
    demo_.requests = std::move(requests);
    app::advanceFrame(demo_, 0, {});
    frame();
  };
  apply({{app::Ask::kPresetFile, "", app::dataPath("assets/presets/soft.json")}});
  EXPECT_NE(find("preset Soft"), nullptr);
  apply({{app::Ask::kPresetFile, "", app::dataPath("assets/presets/stiff.json")}});
  EXPECT_NE(find("preset Stiff"), nullptr);
  apply({{app::Ask::kUndo, "", "", 1}});
  EXPECT_NE(find("preset Soft"), nullptr);
  apply({{app::Ask::kUndo, "", "", 1}});
  EXPECT_NE(find("preset choose..."), nullptr);
  apply({{app::Ask::kRedo, "", "", 2}});
  EXPECT_NE(find("preset Stiff"), nullptr);
}

TEST_F(Panels, TheSceneBoxNamesAMotionThatIsNotTheScenes) {
  demo_.scene.name = "idle";
  frame();
  EXPECT_NE(find("scene Idle"), nullptr);
  demo_.actors[0].spec.motion = "walk.bvh";
  frame();
  EXPECT_NE(find("scene Idle, with Walk"), nullptr);
}

TEST_F(Panels, PausedTimesStandStill) {
  app::advanceFrame(demo_, 1.0 / 60, {});
  demo_.paused = true;
  const std::size_t frames = demo_.history.size();
  for (int i = 0; i < 5; ++i) app::advanceFrame(demo_, 1.0 / 60, {});
  EXPECT_EQ(demo_.history.size(), frames);
}

TEST_F(Panels, TheKeyboardReachesThePanels) {
  ImGuiIO& io = ImGui::GetIO();
  const auto tap = [&](int key) {
    std::vector<app::Request> all;
    for (const bool down : {true, false}) {
      io.KeysDown[key] = down;
      for (app::Request& request : frame()) all.push_back(std::move(request));
    }
    return all;
  };
  EXPECT_FALSE(app::panelsTakeKey(' '));
  app::pressKey(app::kKeyDown, demo_, ui_);
  frame();
  std::vector<app::Request> requests;
  tap(app::kKeyDown);
  EXPECT_TRUE(app::panelsTakeKey(' '));
  for (int k = 0; k < 6 && requests.empty(); ++k) {
    tap(app::kKeyDown);
    requests = tap(' ');
    ui_.browser.what = app::BrowseFor::kNothing;
    ui_.help = false;
  }
  EXPECT_FALSE(requests.empty()) << "no button is reached by the keyboard";
}

}  // namespace ui_files_test
