// Pins of a scene: what a file may say, what each fault is answered with, and that hair stays where it is pinned.
#include "app/scene/pins.h"

#include <gtest/gtest.h>

#include <array>
#include <nlohmann/json.hpp>

#include "app/files/data_path.h"
#include "app/files/errors.h"
#include "app/files/recording.h"
#include "app/scene/actor.h"
#include "app/scene/demo.h"
#include "app/scene/detail/sleep.h"
#include "app/scene/edit/hand_pins.h"
#include "app/scene/edit/mesh_change.h"
#include "tests/run_program.h"

namespace pins_test {

using app::PinSpec;
using app::Vec3;

constexpr double kFrame = 1.0 / 60;

std::string scenes(const std::string& pins) {
  return R"({"characters": [{"motion": "head_shake.bvh", "style": "long", "resolution": "low", "pins": [)" + pins +
         "]}]}";
}

app::CharacterSpec specOf(const std::string& pins) {
  return app::readScene(scenes(pins), "scene.json").characters[0];
}

std::string faultOf(const std::string& pins, app::AssetCache& cache) {
  try {
    app::makeActor(specOf(pins), {}, cache);
  } catch (const app::InputError& fault) {
    return fault.what();
  }
  return "";
}

TEST(Pins, FaultsNameFilePlaceAndMend) {
  struct Case {
    const char *pins, *place, *fault, *mend;
  };
  const Case cases[] = {
      {R"({"to": "Head"})", "/characters/0/pins/0", "no vertex", "\"near\""},
      {R"({"vertex": 9, "column": 1})", "/characters/0/pins/0", "two", "\"column\""},
      {R"({"vertex": 9, "layer": 1})", "/characters/0/pins/0", "no column", "\"column\""},
      {R"({"vertex": 2.5})", "/characters/0/pins/0/vertex", "whole", "one"},
      {R"({"vertex": -1})", "/characters/0/pins/0/vertex", "-1", "0 to"},
      {R"({"vertex": 99999})", "/characters/0/pins/0/vertex", "99999", "0 to"},
      {R"({"vertex": 5}, {"column": 999})", "/characters/0/pins/1/column", "999", "0 to"},
      {R"({"column": 1, "layer": 500})", "/characters/0/pins/0/layer", "500", "-1 for the tip"},
      {R"({"vertex": 0})", "/characters/0/pins/0", "root", "layer from 1"},
      {R"({"near": [0, -160, 0]})", "/characters/0/pins/0/near", "over a metre", "metres"},
      {R"({"column": 1, "to": "LeftHnd"})", "/characters/0/pins/0/to", "LeftHnd", "LeftHand"},
      {R"({"column": 1, "at": [1, 2]})", "/characters/0/pins/0/at", "[1,2]", "three"},
      {R"({"column": 1, "stiffness": "hard"})", "/characters/0/pins/0/stiffness", "hard", "infinite"},
      {R"({"column": 1, "stiffness": -1})", "/characters/0/pins/0/stiffness", "-1", "0 to"},
      {R"({"column": 1, "from": 3, "until": 2})", "/characters/0/pins/0", "before", "until"},
      {R"({"column": 1, "too": "Head"})", "/characters/0/pins/0", "too", "'to'"},
  };
  app::AssetCache cache;
  for (const Case& c : cases) {
    const std::string fault = faultOf(c.pins, cache);
    EXPECT_EQ(fault.find("scene.json"), 0u) << c.pins << "\n  -> " << fault;
    for (const char* part : {c.place, c.fault, c.mend}) {
      EXPECT_NE(fault.find(part), std::string::npos) << c.pins << " lacks " << part << "\n  -> " << fault;
    }
  }
}

TEST(Pins, AFirmOneAloneCountsOnItsVertexAndThatIsSaid) {
  app::AssetCache cache;
  const auto noteOf = [&](const std::string& pins) {
    return app::idlePinNote(app::makeActor(specOf(pins), {}, cache));
  };
  const std::string firm = R"({"column": 3})", soft = R"({"column": 3, "stiffness": 40})";
  EXPECT_NE(noteOf(firm + "," + soft).find("pins 0 and 1 hold vertex "), std::string::npos);
  EXPECT_NE(noteOf(R"({"column": 4},)" + firm + "," + firm).find("pins 1 and 2"), std::string::npos);
  EXPECT_NE(noteOf(soft + "," + firm), "");
  EXPECT_EQ(noteOf(soft + "," + soft), "");
  EXPECT_EQ(noteOf(firm + R"(,{"column": 4})"), "");
  EXPECT_EQ(noteOf(R"({"column": 3, "until": 2}, {"column": 3, "from": 2})"), "");
}

TEST(Pins, WritingAndReadingKeepsThem) {
  const app::Scene scene = app::readScene(
      scenes(R"({"vertex": 41, "to": "LeftHand", "at": [0.1, 0.25, -3], "stiffness": 40, "from": 1, "until": 2.5},
                {"column": 3, "layer": 4, "stiffness": "infinite"})"),
      "scene.json");
  const app::Scene copy = app::readScene(app::writeScene(scene), "scene.json");
  ASSERT_EQ(copy.characters[0].pins.size(), 2u);
  const PinSpec &first = copy.characters[0].pins[0], &second = copy.characters[0].pins[1];
  EXPECT_EQ(first.vertex, 41);
  EXPECT_EQ(first.to, "LeftHand");
  EXPECT_EQ(*first.at, Vec3(0.1, 0.25, -3));
  EXPECT_EQ(first.stiffness, 40);
  EXPECT_EQ(first.from, 1);
  EXPECT_EQ(first.until, 2.5);
  EXPECT_EQ(second.column, 3);
  EXPECT_EQ(second.layer, 4);
  EXPECT_EQ(second.to, "scalp");
  EXPECT_EQ(second.stiffness, PinSpec::kForever);
  EXPECT_EQ(app::writeScene(copy), app::writeScene(scene));
}

// Firm ones at the scalp and at a joint through a clip; the scene's stays, one that is off pulls nothing.
TEST(Pins, HairStaysWhereItIsPinnedThroughAClip) {
  app::AssetCache cache;
  app::Actor actor = app::makeActor(
      specOf(R"({"column": 3}, {"column": 8, "to": "Neck"}, {"column": 20, "layer": 4, "to": "scene", "stiffness": 5},
                {"column": 30, "from": 0.5, "until": 1})"),
      {}, cache);
  const sim::SimParams params;
  const Vec3 scene = actor.pins[2].at;
  double moved = 0;
  for (int k = 1; k <= 120; ++k) {
    const double time = k * kFrame;
    const sim::StepReport report = app::stepActor(params, kFrame, time, actor);
    EXPECT_EQ(report.pins, time >= 0.5 && time < 1 ? 4 : 3) << time;
    EXPECT_EQ(report.pins_out_of_reach + report.recoveries, 0) << time;
    for (const sim::PinnedVertex& pin : actor.pinned) {
      if (!pin.firm() || pin.vertex == actor.pins[3].vertex) continue;
      EXPECT_LT((actor.hair.positions[pin.vertex] - pin.target).norm(), 1e-6) << time;
      moved = std::max(moved, pin.velocity.norm() * kFrame);
    }
    EXPECT_EQ(actor.pinned[2].target, scene);
  }
  EXPECT_GT(moved, 1e-3) << "the clip moved what hair is pinned to";
}

TEST(Pins, HoldOnTheCoarseMeshAndWakeWhatSleeps) {
  app::AssetCache cache;
  app::CharacterSpec spec = specOf(R"({"column": 3, "stiffness": 50})");
  spec.resolution = app::Resolution::kMedium;
  app::Actor actor = app::makeActor(spec, {}, cache);
  const app::HaircutPair* pair = app::coarsePair(actor, app::Resolution::kLow, cache);
  ASSERT_NE(pair, nullptr);
  app::enterCoarse(*pair, actor);
  const sim::SimParams params;
  EXPECT_EQ(app::stepActor(params, kFrame, kFrame, actor).pins, 1);
  app::leaveCoarse(actor);
  actor.playback.speed = 0;
  double time = 0;
  for (int k = 0; k < 1800 && !actor.sleep.asleep; ++k) {
    time += kFrame;
    app::moveActor(kFrame, actor);
    if (app::maySleep(params, kFrame, time, actor)) break;
    app::simulateActor(params, kFrame, time, actor);
  }
  ASSERT_TRUE(actor.sleep.asleep);
  actor.pins[0].until = time;
  app::maySleep(params, kFrame, time + kFrame, actor);
  EXPECT_FALSE(actor.sleep.asleep) << "the pin has let go";
}

// assets/scenes/pinned.json: hair tucked behind the ears. The debug view has a point and a line a pin, from where the
// vertex is shown to where it is drawn.
TEST(Pins, TheExampleSceneHoldsItsHairAndTheDebugViewShowsEachPin) {
  app::Demo demo = app::openScene(app::loadScene(app::dataPath("assets/scenes/pinned.json")), 1);
  demo.debug.pins = true;
  for (int frame = 0; frame < 60; ++frame) app::advanceFrame(demo, frame == 0 ? 0 : 1.0 / 60, {});
  const app::Actor& actor = demo.actors[0];
  ASSERT_EQ(actor.pinned.size(), actor.spec.pins.size());
  EXPECT_EQ(actor.last_report.pins, static_cast<int>(actor.pinned.size()));
  EXPECT_EQ(actor.last_report.pins_out_of_reach, 0);
  const app::DebugGeometry& drawn = demo.debug_geometry;
  ASSERT_EQ(drawn.points.size(), actor.pinned.size());
  ASSERT_EQ(drawn.lines.size(), 2 * actor.pinned.size());
  int firm = 0;
  for (std::size_t k = 0; k < actor.pinned.size(); ++k) {
    const sim::PinnedVertex& pin = actor.pinned[k];
    const double off = (actor.hair.positions[pin.vertex] - pin.target).norm();
    firm += pin.firm();
    EXPECT_LT(off, pin.firm() ? 1e-9 : 0.045) << "pin " << k;
    for (int axis = 0; axis < 3; ++axis) {
      const auto target = static_cast<float>(pin.target[axis] - demo.origin[axis]);
      EXPECT_NEAR(drawn.points[k].position[axis], target, 1e-5) << "pin " << k;
      EXPECT_NEAR(drawn.lines[2 * k].position[axis], actor.shown_positions[3 * pin.vertex + axis], 1e-5) << "pin " << k;
      EXPECT_NEAR(drawn.lines[2 * k + 1].position[axis], target, 1e-5) << "pin " << k;
    }
  }
  EXPECT_EQ(firm, 2);
}

std::string ask(const app::Request& request, app::Demo& demo) {
  demo.message.clear();
  demo.message_is_fault = false;
  demo.requests = {request, {app::Ask::kEndGesture, "", ""}};
  app::advanceFrame(demo, 0, {});
  return demo.message_is_fault ? demo.message : "";
}

std::string pinText(int vertex, const app::PinChoice& choice, const app::Actor& actor) {
  return app::writePins(app::withPins(std::array{vertex}, choice, false, actor)).dump();
}

// A person's demo: long hair in motion.
app::Demo movingDemo() {
  app::Demo demo = app::openScene(app::readScene(scenes(""), "scene.json"), 1.5);
  for (int frame = 0; frame < 20; ++frame) app::advanceFrame(demo, kFrame, {});
  return demo;
}

int tipOf(int column, const app::Actor& actor) {
  const sim::HairMeshShape& shape = actor.haircut->mesh.shape;
  return shape.column_first[static_cast<std::size_t>(column)] + shape.columnLength(column) - 1;
}

// What is pinned by hand stays where it was seen, whatever carries it; undo lets it go.
TEST(Pins, ByHandHoldHairWhereItIsSeenUntilUndone) {
  for (const char* to : {"scalp", "scene", "Neck"}) {
    app::Demo demo = movingDemo();
    const app::Actor& actor = demo.actors[0];
    const auto tip = static_cast<std::size_t>(tipOf(9, actor));
    const Vec3 seen = actor.hair.positions[tip];
    ASSERT_EQ(ask({app::Ask::kPin, "", pinText(static_cast<int>(tip), {to}, actor)}, demo), "");
    EXPECT_EQ(demo.message, "1 pin");
    ASSERT_EQ(actor.spec.pins.size(), 1u);
    for (int frame = 0; frame < 60; ++frame) {
      app::advanceFrame(demo, kFrame, {});
      ASSERT_EQ(actor.pinned.size(), 1u);
      EXPECT_LT((actor.hair.positions[tip] - actor.pinned[0].target).norm(), frame < 30 ? 0.01 : 1e-6) << to;
    }
    EXPECT_LT((actor.pinned[0].target - seen).norm(), std::string(to) == "scene" ? 1e-4 : 0.1) << to;
    const std::string pinned = app::editHash(demo);
    ASSERT_EQ(ask({app::Ask::kUndo, "", "", 1}, demo), "");
    EXPECT_TRUE(actor.spec.pins.empty());
    EXPECT_TRUE(actor.pins.empty());
    ASSERT_EQ(ask({app::Ask::kRedo, "", "", 1}, demo), "");
    EXPECT_EQ(app::editHash(demo), pinned);
    EXPECT_EQ(actor.pins.size(), 1u);
  }
}

// Each side is pinned where its own hair is seen, and to its own shoulder.
TEST(Pins, AreMirroredAcrossTheParting) {
  app::Demo demo = movingDemo();
  const app::Actor& actor = demo.actors[0];
  const int tip = tipOf(9, actor);
  const std::vector<Vec3>& rest = actor.haircut->mesh.shape.positions;
  ASSERT_GT(std::abs(rest[static_cast<std::size_t>(tip)].x()), 0.03) << "it is on one side";
  for (const auto& [to, across] : {std::pair("scalp", "scalp"), std::pair("scene", "scene"), std::pair("Neck", "Neck"),
                                   std::pair("LeftArm", "RightArm"), std::pair("RightHand", "LeftHand")}) {
    const std::vector<PinSpec> pins = app::withPins(std::array{tip}, {to, 40}, true, actor);
    ASSERT_EQ(pins.size(), 2u) << to;
    EXPECT_EQ(pins[0].to, to);
    EXPECT_EQ(pins[1].to, across);
    EXPECT_EQ(pins[1].stiffness, 40);
    const Vec3 here = rest[static_cast<std::size_t>(pins[0].vertex)],
               there = rest[static_cast<std::size_t>(pins[1].vertex)];
    EXPECT_LT((there - Vec3(-here.x(), here.y(), here.z())).norm(), 0.02) << to;
    ASSERT_EQ(ask({app::Ask::kPin, "", app::writePins(pins).dump()}, demo), "");
    app::advanceFrame(demo, kFrame, {});
    for (const sim::PinnedVertex& pin : actor.pinned)
      EXPECT_LT((pin.target - actor.hair.positions[static_cast<std::size_t>(pin.vertex)]).norm(), 0.01) << to;
  }
  EXPECT_TRUE(app::withoutPins(app::withLikesAcross(std::array{tip}, actor), actor).empty());
}

TEST(Pins, GoAlongWithADragAndWithAnotherResolution) {
  app::Demo demo = movingDemo();
  const app::Actor& actor = demo.actors[0];
  const int tip = tipOf(9, actor);
  ASSERT_EQ(ask({app::Ask::kPin, "", pinText(tip, {"Head", 40}, actor)}, demo), "");
  const Vec3 at = actor.pins[0].at, rest = actor.haircut->mesh.shape.positions[static_cast<std::size_t>(tip)];
  const app::MoveSample move{app::MeshElement::kVertex, {tip}, Vec3(0, 0.01, 0), 0.03, 1, false};
  ASSERT_EQ(ask({app::Ask::kMove, "vertex", app::moveText(move)}, demo), "");
  const double way = (actor.haircut->mesh.shape.positions[static_cast<std::size_t>(tip)] - rest).norm();
  EXPECT_GT(way, 0.005);
  EXPECT_NEAR((actor.pins[0].at - at).norm(), way, 1e-9);
  ASSERT_EQ(ask({app::Ask::kResolution, "medium", ""}, demo), "");
  ASSERT_EQ(actor.pins.size(), 1u);
  EXPECT_EQ(actor.pins[0].stiffness, 40);
  const Vec3 there = actor.haircut->mesh.shape.positions[static_cast<std::size_t>(actor.pins[0].vertex)];
  EXPECT_LT((there - rest).norm(), 0.03);
  EXPECT_EQ(actor.spec.pins[0].vertex, actor.pins[0].vertex);
  ASSERT_EQ(ask({app::Ask::kStyle, "bob", ""}, demo), "");
  EXPECT_TRUE(actor.pins.empty());
  ASSERT_EQ(ask({app::Ask::kUndo, "", "", 3}, demo), "");
  EXPECT_EQ((actor.pins[0].at - at).norm(), 0);
}

// Pins without a place hold the vertex where it is at rest, also after a brush has changed that.
TEST(Pins, AtRestGoAlongWithTheRestShape) {
  app::Demo demo = app::openScene(app::readScene(scenes(R"({"near": [0.1, -0.1, 0]})"), "scene.json"), 1.5);
  app::Actor& actor = demo.actors[0];
  ASSERT_EQ(actor.pins.size(), 1u);
  const int vertex = actor.pins[0].vertex;
  EXPECT_EQ(actor.spec.pins[0].vertex, vertex);
  EXPECT_FALSE(actor.spec.pins[0].near) << "it names the vertex from now on";
  const Vec3 before = actor.pins[0].at;
  const app::MoveSample move{app::MeshElement::kVertex, {vertex}, Vec3(0, 0.01, 0), 0.03, 1, false};
  ASSERT_EQ(ask({app::Ask::kMove, "vertex", app::moveText(move)}, demo), "");
  const Vec3 rest = actor.body->character.head_frame * actor.haircut->mesh.shape.positions[std::size_t(vertex)];
  EXPECT_GT((rest - before).norm(), 0.005);
  EXPECT_LT((actor.pins[0].at - rest).norm(), 1e-12);
}

TEST(Pins, FaultsOfARequestLeaveWhatIsThere) {
  app::Demo demo = movingDemo();
  const app::Actor& actor = demo.actors[0];
  ASSERT_EQ(ask({app::Ask::kPin, "", pinText(tipOf(9, actor), {"scalp"}, actor)}, demo), "");
  const std::string before = app::editHash(demo);
  const std::size_t steps = demo.edits.done;
  for (const char* text : {"", "{", "[{\"vertex\": 0}]", "[{\"vertex\": 99999}]", "[{\"vertex\": 9, \"to\": \"Tail\"}]",
                           "[{\"near\": [0, 0, 0], \"vertex\": 9}]"})
    EXPECT_NE(ask({app::Ask::kPin, "", text}, demo), "") << text;
  EXPECT_EQ(app::editHash(demo), before);
  EXPECT_EQ(demo.edits.done, steps);
}

// Where the pinned vertices are at rest, scalp frame.
std::vector<Vec3> pinnedAtRest(const app::Demo& demo) {
  std::vector<Vec3> places;
  for (const int v : app::pinnedVertices(demo.actors[0]))
    places.push_back(demo.actors[0].haircut->mesh.shape.positions[static_cast<std::size_t>(v)]);
  return places;
}

// A mesh with a layer more, and pins of it whose numbers the style does not have.
app::Demo layeredAndPinned() {
  app::Demo demo = movingDemo();
  EXPECT_EQ(ask({app::Ask::kMesh, "add-layer", "3"}, demo), "");
  const int last = demo.actors[0].haircut->mesh.columnCount() - 1;
  EXPECT_EQ(ask({app::Ask::kPin, "", pinText(tipOf(last, demo.actors[0]), {"scalp", 40}, demo.actors[0])}, demo), "");
  return demo;
}

TEST(Pins, StayWhileTheMeshIsChangedAndComeBackWithIt) {
  app::Demo demo = layeredAndPinned();
  const app::Actor& actor = demo.actors[0];
  const std::string before = app::editHash(demo);
  const std::vector<Vec3> places = pinnedAtRest(demo);
  ASSERT_EQ(ask({app::Ask::kMesh, "remove-layer", "2"}, demo), "");
  ASSERT_EQ(actor.pins.size(), 1u);
  EXPECT_LT((pinnedAtRest(demo)[0] - places[0]).norm(), 0.02);
  ASSERT_EQ(ask({app::Ask::kStyle, "bob", ""}, demo), "");
  EXPECT_NE(demo.message.find("without the pins"), std::string::npos) << demo.message;
  EXPECT_TRUE(actor.pins.empty());
  ASSERT_EQ(ask({app::Ask::kUndo, "", "", 2}, demo), "");
  EXPECT_EQ(app::editHash(demo), before);
  EXPECT_EQ(pinnedAtRest(demo), places);
  EXPECT_EQ(ask({app::Ask::kRedo, "", "", 2}, demo), "");
  EXPECT_EQ(ask({app::Ask::kUndo, "", "", 2}, demo), "");
  EXPECT_EQ(app::editHash(demo), before);
}

TEST(Pins, OfAMeshOfItsOwnAreKeptByProjectSceneAndComparison) {
  app::Demo demo = layeredAndPinned();
  const std::vector<Vec3> places = pinnedAtRest(demo);
  const std::string folder = test::freshFolder("pins_kept");
  ASSERT_EQ(ask({app::Ask::kSaveProject, "", folder + "/project.json"}, demo), "");
  ASSERT_EQ(ask({app::Ask::kSaveScene, "", folder + "/scene.json"}, demo), "");
  ASSERT_EQ(ask({app::Ask::kCompare, "gravity=3", "", 1}, demo), "");
  EXPECT_EQ(pinnedAtRest(demo.comparison.other.front()), places);

  app::Demo opened = movingDemo();
  ASSERT_EQ(ask({app::Ask::kOpenProject, "", folder + "/project.json"}, opened), "");
  EXPECT_EQ(pinnedAtRest(opened), places);
  EXPECT_EQ(app::stateHash(opened), app::stateHash(demo));
  ASSERT_EQ(ask({app::Ask::kCompare, "", "", 0}, demo), "");
  for (app::Demo* one : {&demo, &opened}) {
    for (int frame = 0; frame < 10; ++frame) app::advanceFrame(*one, kFrame, {});
  }
  EXPECT_EQ(app::stateHash(opened), app::stateHash(demo));

  const app::Demo reopened = app::openScene(app::loadScene(folder + "/scene.json"), 1.5);
  ASSERT_EQ(reopened.actors[0].spec.pins.size(), 1u);
  EXPECT_LT((pinnedAtRest(reopened)[0] - places[0]).norm(), 1e-5);
}

}  // namespace pins_test
