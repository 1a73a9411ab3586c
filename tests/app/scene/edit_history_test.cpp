// Undo brings back to the bit what was there, redo what was undone; a gesture is one step.
#include "app/scene/edit/edit_history.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <random>

#include "app/files/data_path.h"
#include "app/scene/demo.h"
#include "app/scene/edit/cut_stroke.h"
#include "app/scene/edit/groom_brush.h"
#include "app/scene/edit/hand_pins.h"
#include "app/scene/edit/mesh_change.h"
#include "app/scene/edit/paint_brush.h"
#include "sim/field_text.h"
#include "tests/run_program.h"

namespace edit_history_test {

using app::Ask;
using app::Request;

app::Demo movingDemo() {
  app::Scene scene;
  app::CharacterSpec spec;
  spec.motion = app::dataPath("assets/clips/idle_turns.bvh");
  spec.style = app::Style::kShort;
  spec.resolution = app::Resolution::kLow;
  scene.characters = {spec};
  scene.playback.settle = 0.1;
  app::Demo demo = app::openScene(std::move(scene), 1.5);
  for (int frame = 0; frame < 20; ++frame) app::advanceFrame(demo, 1.0 / 60, {});
  return demo;
}

// Applies a request while time stands still; returns the message when it was a fault.
std::string ask(const Request& request, app::Demo& demo) {
  demo.message.clear();
  demo.message_is_fault = false;
  demo.requests = {request, {Ask::kEndGesture, "", ""}};
  app::advanceFrame(demo, 0, {});
  app::finishCuts(demo);
  return demo.message_is_fault ? demo.message : "";
}

// A value that a row takes.
template <class Field>
std::string valueOf(const Field& row, int components, std::mt19937& random) {
  std::uniform_real_distribution<double> share(0, 1);
  if (row.kind == sim::FieldKind::kSwitch) return share(random) < 0.5 ? "on" : "off";
  if (row.kind == sim::FieldKind::kChoice)
    return row.choices[static_cast<std::size_t>(share(random) * 0.999 * static_cast<double>(row.choices.size()))];
  std::string text;
  for (int k = 0; k < components; ++k) {
    double value = row.minimum + share(random) * (row.maximum - row.minimum);
    if (row.kind == sim::FieldKind::kInteger) value = std::floor(value);
    text.append(k ? "," : "").append(sim::numberText(value));
  }
  return text;
}

Request randomParameter(std::mt19937& random) {
  const auto pick = [&](std::size_t count) { return random() % count; };
  switch (random() % 3) {
    case 0: {
      const sim::ParamField& row = sim::paramFields()[pick(sim::paramFields().size())];
      return {Ask::kSetParam, row.name, valueOf(row, 1, random)};
    }
    case 1: {
      const app::HairField& row = app::hairFields()[pick(app::hairFields().size())];
      return {Ask::kSetParam, row.name, valueOf(row, row.components(), random)};
    }
    default: {
      const app::SceneField& row = app::sceneFields()[pick(app::sceneFields().size())];
      return {Ask::kSetParam, row.name, valueOf(row, row.components(), random)};
    }
  }
}

// What hands do to the hair: strokes, drags, paint, pins, ties, hats, the mesh.
Request randomOfHands(std::mt19937& random, const app::Demo& demo) {
  const auto number = [&](double high) { return high * static_cast<double>(random() % 1000) / 1000; };
  const auto of = [&](std::initializer_list<const char*> names) { return names.begin()[random() % names.size()]; };
  const app::Actor& actor = demo.actors[0];
  const sim::HairMesh& mesh = actor.haircut->mesh;
  const auto count = static_cast<unsigned>(mesh.vertexCount());
  const int vertex = static_cast<int>(random() % count);
  const app::Vec3 at = mesh.shape.positions[static_cast<std::size_t>(vertex)];
  const app::Vec3 way(number(0.04) - 0.02, number(0.04) - 0.02, number(0.04) - 0.02);
  switch (random() % 16) {
    case 0: {
      app::PaintSample sample;
      sample.field = of({"stiffness", "length", "density", "mass", "width", "color", "curl"});
      sample.at = at, sample.value = number(1), sample.mirror = random() % 2 == 0;
      return {Ask::kPaint, sample.field, app::paintText(sample)};
    }
    case 1:
      return {Ask::kCurve, of({"stiffness", "mass", "width"}), of({"1,0.5,0.2", "0.5,1,1", ""})};
    case 2:
    case 3: {
      const app::PinChoice choice{of({"scalp", "scene", "Neck"}), random() % 2 ? 40 : app::PinSpec::kForever, 0,
                                  app::PinSpec::kForever};
      return {Ask::kPin, "",
              app::writePins(app::withPins(std::array{vertex}, choice, random() % 2 == 0, actor)).dump()};
    }
    case 4:
      return {Ask::kPin, "", "[]"};
    case 5:
    case 6: {
      const app::MoveSample move{app::MeshElement::kVertex, {vertex}, way, number(0.06), 1, random() % 2 == 0};
      return {Ask::kMove, "vertex", app::moveText(move)};
    }
    case 7:
      return {Ask::kMesh, of({"add-layer", "remove-layer"}), std::to_string(1 + random() % 3)};
    case 8:
      return random() % 4 ? Request{Ask::kTie, "", "none"} : Request{Ask::kTie, "", of({"back", "high"})};
    case 9:
      if (random() % 8) return {Ask::kAttach, "", "[]"};
      return {Ask::kAttach, "", app::dataPath("assets/attachments/") + of({"glasses.obj", "beanie.obj"})};
    case 10:
      return {Ask::kMap, "length", random() % 2 ? "" : "bob_length.png"};
    default: {
      app::BrushSample sample;
      sample.tool = static_cast<app::BrushTool>(random() % app::kBrushNames.size());
      sample.at = at, sample.along = way, sample.radius = 0.02 + number(0.05), sample.mirror = random() % 2 == 0;
      return {Ask::kBrush, std::string(app::kBrushNames[static_cast<std::size_t>(sample.tool)]),
              app::brushText(sample)};
    }
  }
}

Request randomEdit(std::mt19937& random) {
  const auto number = [&](double high) { return high * static_cast<double>(random() % 1000) / 1000; };
  const auto of = [&](std::initializer_list<const char*> names) { return names.begin()[random() % names.size()]; };
  switch (random() % 200) {
    case 0:
      return {Ask::kStyle, of({"short", "shoulder", "long", "bob", "pixie"}), ""};
    case 1:
      return {Ask::kMotionFile, "", of({"walk.bvh", "dance.bvh", "jump_spin.bvh"})};
    case 2:
      return {Ask::kSceneFile, "", of({"head_shake.json", "walk.json"})};
    case 3:
    case 4:
      return {Ask::kLoop, of({"go-on", "in-place", "none"}), ""};
    case 5:
    case 6:
      return {Ask::kReset, "", ""};
    case 7:
      return {Ask::kCollapse, "", ""};
    case 8:
      return {Ask::kRestart, "", ""};
    case 9:
    case 10:
    case 11:
      return {Ask::kCarryAlong, "", "", number(3)};
    case 12:
    case 13:
    case 14:
    case 15:
      return {Ask::kPresetFile, "", of({"soft", "stiff", "paper"})};
    case 19:
    case 20:
      return {Ask::kSkip, "sleep", "", static_cast<double>(random() % 2)};
    case 21:
    case 22:
      return {Ask::kDebugView, "mesh", "", static_cast<double>(random() % 2)};
    case 23:
    case 24:
      return {Ask::kSpeed, "", "", number(20)};
    case 25:
    case 26:
      return {Ask::kBudget, "", "", number(5)};
    case 28:
      return {Ask::kDrawBudget, "", "", number(5)};
    case 27:
      return {Ask::kDeadline, "", "", number(5)};
    default:
      return randomParameter(random);
  }
}

TEST(EditHistory, AThousandRandomEditsUndoneAndDoneAgainEndInTheSameBits) {
  app::Demo demo = movingDemo();
  const std::string start = app::editHash(demo);
  std::mt19937 random(7);
  std::vector<std::string> hashes{start};
  std::size_t faults = 0;
  for (int k = 0; k < 1000; ++k) {
    const std::size_t before = demo.edits.done;
    const Request edit = random() % 3 ? randomEdit(random) : randomOfHands(random, demo);
    if (!ask(edit, demo).empty()) ++faults;
    if (demo.edits.done > before) hashes.push_back(app::editHash(demo));
  }
  EXPECT_LT(faults, 80u) << "brushes that reach nothing, hair too short for a tie, mesh that is pinned";
  const std::size_t steps = demo.edits.done;
  ASSERT_EQ(hashes.size(), steps + 1);
  EXPECT_GT(steps, 850u);
  for (std::size_t k = steps; k-- > 0;) {
    ASSERT_EQ(ask({Ask::kUndo, "", "", 1}, demo), "") << k << ": " << demo.edits.steps[k].title;
    if (k % 50 == 0 || k > steps - 50) {
      ASSERT_EQ(app::editHash(demo), hashes[k]) << k << ": " << demo.edits.steps[k].title;
    }
  }
  EXPECT_EQ(app::editHash(demo), start);
  EXPECT_EQ(ask({Ask::kUndo, "", "", 1}, demo), "") << "no fault";
  EXPECT_TRUE(demo.message.starts_with("nothing to undo")) << demo.message;
  EXPECT_EQ(app::editHash(demo), start);
  ASSERT_EQ(ask({Ask::kRedo, "", "", static_cast<double>(steps)}, demo), "");
  EXPECT_EQ(app::editHash(demo), hashes.back());
  EXPECT_EQ(ask({Ask::kRedo, "", "", 1}, demo), "") << "no fault";
  EXPECT_TRUE(demo.message.starts_with("nothing to redo")) << demo.message;
}

// Beyond so many bytes older steps are dropped.
TEST(EditHistory, WhatIsNoLongerKeptIsNotCalledTheStart) {
  app::Demo demo = movingDemo();
  for (int k = 0; k < 3; ++k) {
    app::EditStep step;
    step.request = {Ask::kSetParam, "density", "70"};
    step.other.cast = {demo.actors[0].spec};
    step.other.moments.resize(1);
    step.other.moments[0].hair.positions.resize(app::kMaxEditBytes / sizeof(sim::Vec3) / 32);
    app::commitEdit(std::move(step), false, demo.edits);
  }
  EXPECT_LT(demo.edits.steps.size(), 3u);
  demo.edits.done = 0;
  EXPECT_EQ(ask({Ask::kUndo, "", "", 1}, demo), "") << "no fault";
  EXPECT_TRUE(demo.message.starts_with("nothing more to undo")) << demo.message;
}

// The next Ctrl+S offers that name.
TEST(EditHistory, UndoLeavesTheNameThatTheSceneWasSavedBy) {
  app::Demo demo = movingDemo();
  const std::string file = test::freshFolder("edit_history_name") + "/mine.json";
  demo.requests = {{Ask::kSetParam, "density", "70"}, {Ask::kSaveScene, "", file}};
  app::advanceFrame(demo, 0, {});
  ASSERT_FALSE(demo.message_is_fault) << demo.message;
  for (const Ask way : {Ask::kUndo, Ask::kRedo}) {
    ask({way, "", "", 1}, demo);
    EXPECT_EQ(demo.scene.name, "mine");
    EXPECT_EQ(demo.scene.file, file);
  }
  EXPECT_EQ(demo.scene.sim.density, 70);
}

TEST(EditHistory, ADragIsOneStepAndALaterEditEndsWhatWasUndone) {
  app::Demo demo = movingDemo();
  const double density = demo.scene.sim.density;
  for (const char* text : {"70", "75", "80"}) {
    demo.requests = {{Ask::kSetParam, "density", text}};
    app::advanceFrame(demo, 1.0 / 60, {});
  }
  ASSERT_EQ(demo.edits.steps.size(), 1u);
  EXPECT_EQ(demo.edits.steps[0].title, "Density 80 kg/m^3");
  demo.requests = {{Ask::kEndGesture, "", ""}, {Ask::kSetParam, "density", "90"}, {Ask::kSetParam, "damping", "0.1"}};
  app::advanceFrame(demo, 1.0 / 60, {});
  EXPECT_EQ(demo.edits.steps.size(), 3u);
  EXPECT_EQ(ask({Ask::kUndo, "", "", 2}, demo), "");
  EXPECT_EQ(demo.scene.sim.density, 80);
  EXPECT_EQ(ask({Ask::kSetParam, "gravity", "5"}, demo), "");
  EXPECT_EQ(demo.edits.steps.size(), 2u);
  EXPECT_EQ(ask({Ask::kUndo, "", "", 9}, demo), "");
  EXPECT_EQ(demo.scene.sim.density, density);
}

// An artist who looks at a stroke from elsewhere and undoes means the stroke.
TEST(EditHistory, AViewIsNoStep) {
  app::Demo demo = movingDemo();
  const double density = demo.scene.sim.density;
  EXPECT_EQ(ask({Ask::kSetParam, "density", "80"}, demo), "");
  EXPECT_EQ(ask({Ask::kKeepView, "", "", 1}, demo), "");
  EXPECT_EQ(demo.message, "view 2 kept");
  EXPECT_EQ(ask({Ask::kKeepView, "", "", 1}, demo), "");
  EXPECT_EQ(demo.message, "view 2 kept in place of the one before");
  for (const Request& look : {Request{Ask::kView, "back", ""}, Request{Ask::kLens, "", "", 0.3},
                              Request{Ask::kGoToView, "", "", 1}, Request{Ask::kFollow, "", "", 0}})
    EXPECT_EQ(ask(look, demo), "");
  demo.camera.yaw = 1;
  EXPECT_EQ(ask({Ask::kUndo, "", "", 1}, demo), "");
  EXPECT_EQ(demo.scene.sim.density, density);
  EXPECT_EQ(demo.camera.yaw, 1);
  EXPECT_TRUE(demo.edits.steps.size() == 1 && demo.edits.done == 0);
}

// Where time has gone on, undo of a stroke is the opposite stroke: hair goes along with its rest shape from where it
// is, and not back to where it was.
TEST(EditHistory, WhatMovesStaysInTheTimeThatIsShown) {
  app::Demo demo = movingDemo();
  const app::Actor& actor = demo.actors[0];
  const std::vector<app::Vec3> rest = actor.haircut->mesh.shape.positions;
  app::BrushSample sample;
  sample.tool = app::BrushTool::kPuff;
  sample.at = rest[rest.size() / 2], sample.radius = 0.06;
  ASSERT_EQ(ask({Ask::kBrush, "puff", app::brushText(sample)}, demo), "");
  for (int frame = 0; frame < 90; ++frame) app::advanceFrame(demo, 1.0 / 60, {});
  const std::vector<app::Vec3> worn = actor.haircut->mesh.shape.positions, seen = actor.hair.positions;
  const std::vector<app::Vec3> speeds = actor.hair.velocities;
  const std::string before = app::editHash(demo);
  ASSERT_EQ(ask({Ask::kUndo, "", "", 1}, demo), "");
  EXPECT_EQ(actor.haircut->mesh.shape.positions, rest);
  EXPECT_EQ(actor.hair.velocities, speeds) << "it swings on";
  for (std::size_t v = 0; v < seen.size(); ++v)
    ASSERT_LT((actor.hair.positions[v] - seen[v]).norm(), 1e-9 + 1.5 * (rest[v] - worn[v]).norm()) << v;
  ASSERT_EQ(ask({Ask::kRedo, "", "", 1}, demo), "");
  EXPECT_EQ(app::editHash(demo), before) << "no time has gone on since";
}

// A length from a file begins from the style; hair whose mesh was changed before comes back with that mesh.
TEST(EditHistory, AMeshOfItsOwnComesBackWithTheLengthThatItHad) {
  for (const bool under_a_hat : {false, true}) {
    app::Demo demo = movingDemo();
    ASSERT_EQ(ask({Ask::kMesh, "add-layer", "2"}, demo), "");
    if (under_a_hat) {
      ASSERT_EQ(ask({Ask::kAttach, "", app::dataPath("assets/attachments/beanie.obj")}, demo), "");
    }
    const std::string before = app::editHash(demo);
    ASSERT_EQ(ask({Ask::kMap, "length", "bob_length.png"}, demo), "");
    ASSERT_EQ(ask({Ask::kUndo, "", "", 1}, demo), "");
    EXPECT_EQ(app::editHash(demo), before) << under_a_hat;
  }
}

// Hair of another mesh begins at rest on the body as it stands now.
TEST(EditHistory, AnUndoneTieBeginsAtRestWhereTheFigureIsNow) {
  app::Demo demo = movingDemo();
  const app::Actor& actor = demo.actors[0];
  ASSERT_EQ(ask({Ask::kTie, "", "back"}, demo), "");
  for (int frame = 0; frame < 100; ++frame) app::advanceFrame(demo, 1.0 / 60, {});
  const double time = actor.playback.time, clock = demo.clock.time;
  ASSERT_EQ(ask({Ask::kUndo, "", "", 1}, demo), "");
  EXPECT_TRUE(actor.spec.ties.empty());
  EXPECT_EQ(actor.playback.time, time);
  EXPECT_EQ(demo.clock.time, clock);
  for (int frame = 0; frame < 5; ++frame) {
    app::advanceFrame(demo, 1.0 / 60, {});
    EXPECT_LT(demo.stats.max_penetration, 0.01) << "m; hair of another time would lie in the shoulders";
  }
}

// While time goes on an undone reset gives the hair its shape back where the head is now.
TEST(EditHistory, HairComesBackWhereTheHeadIsNow) {
  app::Demo demo = movingDemo();
  demo.requests = {{Ask::kCollapse, "", ""}};
  for (int frame = 0; frame < 30; ++frame) app::advanceFrame(demo, 1.0 / 60, {});
  demo.requests = {{Ask::kUndo, "", "", 1}};
  app::advanceFrame(demo, 0, {});
  const app::Actor& actor = demo.actors[0];
  const sim::HairMeshShape& shape = actor.haircut->mesh.shape;
  double most = 0;
  for (int c = 0; c < shape.columnCount(); ++c)
    most = std::max(most, (actor.hair.positions[static_cast<std::size_t>(shape.column_first[c])] -
                           actor.roots[static_cast<std::size_t>(c)])
                              .norm());
  EXPECT_LT(most, 1e-9);
  for (int frame = 0; frame < 10; ++frame) app::advanceFrame(demo, 1.0 / 60, {});
  EXPECT_EQ(demo.stats.recoveries, 0);
}

}  // namespace edit_history_test
