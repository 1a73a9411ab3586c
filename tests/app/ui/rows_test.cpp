// Rows of the panels: what is worn, units, what counts as a change; and where the history stands.
#include <gtest/gtest.h>
#include <imgui/imgui.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "app/scene/demo.h"
#include "app/ui/ui_panels.h"
#include "app/ui/ui_widgets.h"
#include "tests/app/ui/panels.h"

namespace rows_test {

using app::Ask;
using test::Panels;

// A hat that sits badly is moved, turned and scaled; each drag is a step that can be taken back, and is saved.
TEST_F(Panels, WhatIsWornIsPlacedTurnedAndScaledByDrags) {
  ImGui::GetIO().DisplaySize = {1280, 3000};
  apply({{Ask::kAttach, "add", "glasses.obj"}});
  openTab(app::tabIndex("hair"));
  if (!find("place glasses")) click("section Worn");
  const auto spec = [&] { return app::selectedActor(demo_).spec.attachments.at(0); };
  const auto middle = [&] {
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    const app::Attachment& mesh = *app::selectedActor(demo_).worn.at(0).mesh;
    for (const Eigen::Vector3f& p : mesh.positions) sum += p / static_cast<float>(mesh.positions.size());
    return sum;
  };
  const Eigen::Vector3f before = middle();
  for (const std::string row : {"place", "turn", "size"}) {
    const Eigen::Vector3f then = middle();
    apply(click(row + " glasses", 0.5f, 30));
    EXPECT_FALSE(demo_.message_is_fault) << demo_.message;
    EXPECT_GT((middle() - then).norm(), 1e-4f) << row << " moves nothing";
  }
  EXPECT_GT(spec().at.y(), 0.005);
  EXPECT_GT(spec().turn.y(), 5);
  EXPECT_GT(spec().size, 1.05);
  EXPECT_EQ(demo_.edits.done, 4u);
  const app::AttachmentSpec saved = app::attachmentsFromText(app::writeAttachments({spec()}).dump()).at(0);
  EXPECT_EQ(saved.size, spec().size);
  EXPECT_EQ(saved.turn, spec().turn);
  apply(click("reset size glasses"));
  EXPECT_EQ(spec().size, 1);
  apply({{Ask::kUndo, "", "", 4}});
  EXPECT_EQ(spec().at, sim::Vec3::Zero());
  EXPECT_LT((middle() - before).norm(), 1e-6f);
  click("open attach");
  EXPECT_EQ(ui_.browser.what, app::BrowseFor::kWorn);
}

// It is seen at its new place while the mouse is held; the hair follows when that is let go, and nothing jumps then.
TEST_F(Panels, WhatIsWornIsDrawnWhereItIsDragged) {
  ImGuiIO& io = ImGui::GetIO();
  io.DisplaySize = {1280, 3000};
  apply({{Ask::kAttach, "add", "glasses.obj"}});
  openTab(app::tabIndex("hair"));
  if (!find("place glasses")) click("section Worn");
  const auto show = [&](const std::vector<test::Request>& requests) {
    demo_.requests = requests;
    app::advanceFrame(demo_, 0, {});
    const app::WornAttachment& worn = app::selectedActor(demo_).worn.at(0);
    std::vector<Eigen::Vector3f> drawn;
    for (const Eigen::Vector3f& p : worn.mesh->positions)
      drawn.push_back((Eigen::Map<const Eigen::Matrix4f>(worn.matrix.data()) * p.homogeneous()).head<3>());
    return drawn;
  };
  const auto apart = [](const std::vector<Eigen::Vector3f>& a, const std::vector<Eigen::Vector3f>& b) {
    float farthest = 0;
    for (std::size_t k = 0; k < a.size(); ++k) farthest = std::max(farthest, (a[k] - b[k]).norm());
    return farthest;
  };
  for (const std::string row : {"place", "turn", "size"}) {
    demo_.shown_fraction = -1;
    const std::vector<Eigen::Vector3f> before = show({});
    const std::uint64_t actor = app::selectedActor(demo_).id;
    const test::UiItem item = *find(row + " glasses");
    io.MousePos = {item.x + 0.5f * item.width, item.y + 0.5f * item.height};
    frame(), frame();
    io.MouseDown[0] = true;
    frame();
    io.MousePos.x += 30;
    const std::vector<test::Request> held = frame();
    EXPECT_FALSE(asked(held, Ask::kAttach));
    const std::vector<Eigen::Vector3f> dragged = show(held);
    EXPECT_GT(apart(before, dragged), 1e-3f) << row << " stands still";
    EXPECT_EQ(app::selectedActor(demo_).id, actor) << "made anew while it is dragged";
    EXPECT_LT(apart(before, show({})), 1e-6f) << "nobody drags it any more";
    io.MouseDown[0] = false;
    show(frame());
    const std::vector<test::Request> released = frame();
    EXPECT_TRUE(asked(released, Ask::kAttach));
    EXPECT_LT(apart(dragged, show(released)), 2e-5f) << row << " jumps when it is let go";
    EXPECT_NE(app::selectedActor(demo_).id, actor);
    frame();
  }
}

TEST_F(Panels, LengthsAreShownInMillimetresAndPressuresInKilopascals) {
  EXPECT_EQ(app::rowValue("strand_radius", "4e-05"), "0.04 mm");
  EXPECT_EQ(app::rowValue("offset", "0.0012"), "1.2 mm");
  EXPECT_EQ(app::rowValue("curl_pitch", "0.035"), "35 mm");
  EXPECT_EQ(app::rowValue("stretch_along", "4e+05"), "400 kPa");
  EXPECT_EQ(app::rowValue("bend", "0.6"), "0.6 Pa m^2");
  EXPECT_EQ(app::rowValue("collide", "off"), "off");
  // What is dragged there is kept in metres.
  ImGui::GetIO().DisplaySize = {1280, 3000};
  openTab(app::tabIndex("hair"));
  const auto requests = click("offset", 0.5f, 10);
  ASSERT_TRUE(asked(requests, Ask::kSetParam, "offset"));
  apply(requests);
  const float metres = app::selectedActor(demo_).spec.look.hair.offset;
  EXPECT_GT(metres, 0.005f);
  EXPECT_LE(metres, 0.02f);
}

// A scene or preset may differ from the tables' defaults: that is no change of the person's.
TEST_F(Panels, RowsAreMarkedAsChangedAgainstWhatWasOpenedOrThePreset) {
  app::Scene scene = demo_.scene;
  scene.sim.density = 90;
  scene.characters[0].look.hair.clump = 0.9f;
  demo_ = app::openScene(scene, 1.5);
  openTab(0);
  EXPECT_EQ(find("reset density"), nullptr);
  apply({{Ask::kSetParam, "density", "60"}});
  frame();
  ASSERT_NE(find("reset density"), nullptr) << "the table's default is a change here";
  const auto reset = click("reset density");
  apply(reset);
  EXPECT_EQ(demo_.scene.sim.density, 90);
  apply({{Ask::kPresetFile, "", "soft"}});
  frame();
  for (const sim::ParamField& field : sim::paramFields())
    EXPECT_EQ(find(std::string("reset ") + field.name), nullptr) << field.name;
  apply({{Ask::kUndo, "", "", 1}});
  frame();
  EXPECT_EQ(find("reset density"), nullptr);
}

TEST_F(Panels, TheHeaderNamesASceneAsItsListDoes) {
  ASSERT_EQ(ui_.scenes.size(), ui_.scene_names.size());
  for (std::size_t k = 0; k < ui_.scenes.size(); ++k)
    EXPECT_EQ(ui_.scene_names[k], app::loadScene(ui_.scenes[k]).name) << ui_.scenes[k];
}

// Beside a sidebar the history would lie over half of the picture, and leave the timeline no room.
TEST_F(Panels, InASmallWindowTheHistoryStandsInTheSidebar) {
  ImGui::GetIO().DisplaySize = {860, 640};
  demo_.timeline.on = true;
  frame();
  click("file History");
  frame();
  ASSERT_NE(find("history list"), nullptr);
  EXPECT_LT(find("history list")->x + find("history list")->width, 372);
  EXPECT_NE(find("timeline"), nullptr) << "the timeline is gone";
  EXPECT_GT(app::freePart(demo_, ui_).right, 0.95);
  ASSERT_NE(find("moment 0"), nullptr);
}

TEST_F(Panels, HairThatHasNoRoomForAPlaitOrABunIsShownAsATail) {
  ImGui::GetIO().DisplaySize = {1280, 3000};
  app::CharacterSpec spec = app::selectedActor(demo_).spec;
  openTab(app::tabIndex("hair"));
  apply({{Ask::kTie, "", "plait"}});
  frame();
  ASSERT_FALSE(demo_.message_is_fault) << demo_.message;
  const bool plaited = !app::selectedActor(demo_).haircut->braids.empty();
  EXPECT_FALSE(plaited) << "short hair has become long enough: take another";
  const auto requests = click("braided");
  const auto posted = std::ranges::find(requests, Ask::kTie, &app::Request::what);
  ASSERT_NE(posted, requests.end());
  EXPECT_NE(posted->text.find("\"braided\":true"), std::string::npos) << "a click on an empty box asks for a plait";
  apply({{Ask::kTie, "", "bun"}});
  frame();
  ASSERT_FALSE(demo_.message_is_fault) << demo_.message;
  const auto again = click("bun");
  const auto wound = std::ranges::find(again, Ask::kTie, &app::Request::what);
  ASSERT_NE(wound, again.end());
  EXPECT_NE(wound->text.find("\"bun\":true"), std::string::npos) << "a click on an empty box asks for a bun";
  EXPECT_EQ(wound->text.find("\"braided\""), std::string::npos);
}

// A picture paints the field that is chosen, dropped or opened, and can be taken off again.
TEST_F(Panels, AFieldIsPaintedByAFile) {
  openTab(app::tabIndex("hair"));
  click("paint Stiff");
  ASSERT_EQ(ui_.brush.field, 0);
  frame();
  click("open map");
  EXPECT_EQ(ui_.browser.what, app::BrowseFor::kMap);
  ui_.browser.what = app::BrowseFor::kNothing;
  app::openFile(app::dataPath("assets/maps/left_side.png"), demo_, ui_);
  const std::vector<test::Request> asked = std::exchange(demo_.requests, {});
  ASSERT_EQ(asked.size(), 1u);
  EXPECT_EQ(asked[0].what, Ask::kMap);
  EXPECT_EQ(asked[0].name, "stiffness");
  apply(asked);
  EXPECT_FALSE(demo_.message_is_fault) << demo_.message;
  EXPECT_NE(demo_.actors[0].spec.maps.stiffness, "");
  frame();
  apply(click("no map"));
  EXPECT_EQ(demo_.actors[0].spec.maps.stiffness, "");
}

}  // namespace rows_test
