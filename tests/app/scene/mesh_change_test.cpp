// The hair mesh in a hand while the hair moves: what is chosen goes where it is led, the structure changes, all of it
// is undone, recorded and kept.
#include "app/scene/edit/mesh_change.h"

#include <gtest/gtest.h>

#include <random>

#include "app/files/data_path.h"
#include "app/files/errors.h"
#include "app/files/hair_file.h"
#include "app/files/output_file.h"
#include "app/files/recording.h"
#include "app/scene/demo.h"
#include "app/scene/edit/groom_brush.h"
#include "app/scene/project.h"
#include "app/scene/view/figure_input.h"
#include "tests/app/scene/mesh_in_hand.h"
#include "tests/run_program.h"

namespace mesh_change_test {

using app::Ask;
using app::Demo;
using app::MeshElement;
using app::Request;
using sim::Vec3;
using test::ask;
using test::chainOfEdges;
using test::demoOf;
using test::expectValid;
using test::meshOf;
using test::sceneOf;

Request moveOf(MeshElement element, std::vector<int> chosen, const Vec3& along, double radius = 0.03,
               bool mirror = false) {
  const app::MoveSample sample{element, std::move(chosen), along, radius, 1, mirror};
  return {Ask::kMove, std::string(app::kElementNames[static_cast<std::size_t>(element)]), app::moveText(sample)};
}

// All that undo has to bring back: settings, the moving hair, its mesh and its rest shape.
std::string wholeHash(const Demo& demo) {
  const sim::HairMeshShape& shape = meshOf(demo).shape;
  std::string text = app::editHash(demo) + " " + std::to_string(shape.columnCount());
  double sum = 0;
  for (std::size_t v = 0; v < shape.positions.size(); ++v)
    sum += shape.positions[v].dot(Vec3(1, 2, 3)) * static_cast<double>(v + 1);
  for (const sim::RootFace& face : shape.root_faces) {
    for (int k = 0; k < face.corner_count; ++k) sum = 1.1 * sum + face.columns[static_cast<std::size_t>(k)];
    sum = std::fmod(sum, 1e6);
  }
  char number[40];
  std::snprintf(number, sizeof number, " %a", sum);
  return text + number;
}

// The column that hangs farthest in front.
int frontColumn(const Demo& demo) {
  const sim::HairMeshShape& shape = meshOf(demo).shape;
  int best = 0;
  const auto tip = [&](int c) {
    return shape.positions[static_cast<std::size_t>(shape.column_first[static_cast<std::size_t>(c) + 1] - 1)].z();
  };
  for (int c = 0; c < shape.columnCount(); ++c) {
    if (tip(c) > tip(best)) best = c;
  }
  return best;
}

// The first step on another mesh balances gravity nearly, those after it wholly; no step does all of it. What is
// brought back has its balance at once.
TEST(MeshChange, GravityIsBalancedOverTheStepsAfterIt) {
  Demo demo = demoOf();
  const auto& memory = [&]() -> const sim::MaterialMemory& { return demo.actors[0].hair.memory.material; };
  ASSERT_EQ(ask({Ask::kMesh, "add-layer", "2"}, demo), "");
  app::advanceFrame(demo, 1.0 / 60, {});
  EXPECT_GT(memory().slices, 0) << "the first step has solved for all of the balance";
  const auto lies = [&] {
    double most = 0;
    const app::Rigid to_scalp =
        app::scalpToWorld(demo.actors[0].body->character, demo.actors[0].pose).inverse(Eigen::Isometry);
    for (std::size_t v = 0; v < demo.actors[0].hair.positions.size(); ++v)
      most = std::max(most, (to_scalp * demo.actors[0].hair.positions[v] - meshOf(demo).shape.positions[v]).norm());
    return most;
  };
  const double at_first = lies();
  int frames = 0;
  for (; memory().slices != 0 && frames < 200; ++frames) {
    app::advanceFrame(demo, 1.0 / 60, {});
    EXPECT_LT(lies(), at_first + 0.01 * meshOf(demo).hair_length) << "it droops";
  }
  EXPECT_LT(frames, 120) << "two seconds";
  ASSERT_EQ(ask({Ask::kMesh, "add-layer", "4"}, demo), "");
  for (frames = 0; frames == 0 || (memory().slices != 0 && frames < 200); ++frames)
    app::advanceFrame(demo, 1.0 / 60, {});
  ASSERT_EQ(ask({Ask::kUndo, "", "", 1}, demo), "");
  app::advanceFrame(demo, 1.0 / 60, {});
  EXPECT_EQ(memory().slices, 0);
}

TEST(MeshMove, ASampleReadsBackToTheSameBits) {
  const app::MoveSample sample{MeshElement::kEdge, {4, 5, 17, 33}, {0.1, -1.0 / 3, 2e-17}, 0.0123456789, 2.5, true};
  const app::MoveSample back = app::parseMove("edge", app::moveText(sample));
  EXPECT_EQ(app::moveText(back), app::moveText(sample));
  EXPECT_EQ(back.chosen, sample.chosen);
  EXPECT_EQ(back.along, sample.along);
  for (const char* text : {"", "0 0 0 0.1 1 0", "0 0 0 9 1 0 4", "0 0 nan 0.1 1 0 4", "0 0 0 0.1 1 0 4.5",
                           "0 0 0 0.1 1 0 -4", "0 0 0 0.1 1 0 x"})
    EXPECT_THROW(app::parseMove("vertex", text), app::InputError) << text;
  EXPECT_THROW(app::parseMove("edge", "0 0 0 0.1 1 0 4 5 6"), app::InputError);
  EXPECT_THROW(app::parseMove("bundle", "0 0 0 0.1 1 0 4"), app::InputError);
}

TEST(MeshMove, WhatIsChosenGoesThereAndWhatIsAroundFollows) {
  Demo demo = demoOf();
  const std::vector<Vec3> before = meshOf(demo).shape.positions, seen = app::seenFromScalp(demo.actors[0]);
  const int c = frontColumn(demo);
  const int tip = meshOf(demo).shape.column_first[static_cast<std::size_t>(c) + 1] - 1;
  const Vec3 way(0, 0.003, 0.006);
  ASSERT_EQ(ask(moveOf(MeshElement::kVertex, {tip}, way, 0.05), demo), "");
  const std::vector<Vec3> after = meshOf(demo).shape.positions;
  EXPECT_LT((after[static_cast<std::size_t>(tip)] - before[static_cast<std::size_t>(tip)] - way).norm(), 1e-12);
  int followed = 0;
  for (std::size_t v = 0; v < after.size(); ++v) {
    const double went = (after[v] - before[v]).norm();
    const double away = (seen[v] - seen[static_cast<std::size_t>(tip)]).norm();
    if (away >= 0.05 || meshOf(demo).isRoot(static_cast<int>(v))) {
      EXPECT_EQ(went, 0) << v;
    } else if (went > 0 && static_cast<int>(v) != tip) {
      EXPECT_LE(went, way.norm() * (1 - away * away / 0.0025) + 1e-12) << v;
      ++followed;
    }
  }
  EXPECT_GT(followed, 0);
  expectValid(demo);
  ASSERT_EQ(demo.edits.steps.size(), 1u);
  EXPECT_EQ(demo.edits.steps[0].title, "Move vertex");
  for (int frame = 0; frame < 60; ++frame) app::advanceFrame(demo, 1.0 / 60, {});
  EXPECT_EQ(demo.stats.recoveries, 0);
}

TEST(MeshMove, AColumnALayerAndAnEdgeMoveAndRootsStay) {
  Demo demo = demoOf();
  const sim::HairMeshShape shape = meshOf(demo).shape;
  const int c = frontColumn(demo), first = shape.column_first[static_cast<std::size_t>(c)];
  const sim::Edge edge = meshOf(demo).horizontal_edges.back();
  const std::vector<std::pair<Request, std::vector<int>>> moves{
      {moveOf(MeshElement::kColumn, {c}, {0.001, 0, 0.002}, 0), {first + 1, first + 2}},
      {moveOf(MeshElement::kLayer, {3}, {0.001, 0.001, 0}, 0), {3, first + 3}},
      {moveOf(MeshElement::kEdge, {edge.a, edge.b}, {0, 0.001, 0.001}, 0), {edge.a, edge.b}}};
  for (const auto& [request, vertices] : moves) {
    const std::vector<Vec3> before = meshOf(demo).shape.positions;
    ASSERT_EQ(ask(request, demo), "") << request.text;
    for (const int v : vertices)
      EXPECT_GT(
          (meshOf(demo).shape.positions[static_cast<std::size_t>(v)] - before[static_cast<std::size_t>(v)]).norm(),
          1e-4)
          << request.name << v;
    for (int k = 0; k < shape.columnCount(); ++k) {
      const auto root = static_cast<std::size_t>(shape.column_first[static_cast<std::size_t>(k)]);
      EXPECT_EQ(meshOf(demo).shape.positions[root], before[root]);
    }
    expectValid(demo);
  }
  EXPECT_EQ(demo.edits.steps.size(), 3u);
  EXPECT_NE(ask(moveOf(MeshElement::kVertex, {first}, {0, 0, 0.01}), demo).find("nothing to move"), std::string::npos);
  EXPECT_NE(ask(moveOf(MeshElement::kColumn, {9999}, {0, 0, 0.01}), demo).find("is not there"), std::string::npos);
  EXPECT_EQ(demo.edits.steps.size(), 3u);
}

// Led 10 cm to its side in small steps, a column bends: nowhere by more than 35 degrees between two segments.
TEST(MeshMove, AColumnThatIsDraggedHasNoKinks) {
  Demo demo = demoOf();
  const std::vector<Vec3> rest = meshOf(demo).shape.positions;
  const std::vector<int> firsts = meshOf(demo).shape.column_first;
  const Vec3 centre = demo.actors[0].body->character.scalp.center;
  const auto besides = [&](int c) {
    const Vec3 root = rest[static_cast<std::size_t>(firsts[static_cast<std::size_t>(c)])] - centre;
    return root.x() - 2 * std::abs(root.z());
  };
  int chosen = 0;
  for (int c = 0; c < meshOf(demo).columnCount(); ++c) {
    if (besides(c) > besides(chosen)) chosen = c;
  }
  for (int k = 0; k < 25; ++k) {
    demo.requests = {moveOf(MeshElement::kColumn, {chosen}, {0.004, 0.001, 0}, 0.1)};
    for (int frame = 0; frame < 3; ++frame) app::advanceFrame(demo, 1.0 / 60, {});
  }
  const std::vector<Vec3>& x = meshOf(demo).shape.positions;
  const auto first = static_cast<std::size_t>(firsts[static_cast<std::size_t>(chosen)]);
  const auto tip = static_cast<std::size_t>(firsts[static_cast<std::size_t>(chosen) + 1]) - 1;
  EXPECT_GT((x[tip] - rest[tip]).norm(), 0.05);
  for (std::size_t v = first + 1; v < tip; ++v) {
    const double straight = (x[v] - x[v - 1]).normalized().dot((x[v + 1] - x[v]).normalized());
    EXPECT_GT(straight, std::cos(35 * 3.14159265 / 180)) << v - first;
  }
  expectValid(demo);
}

// However far it is led, the mesh stays valid and outside of the body.
TEST(MeshMove, NothingIsInvertedNorLedIntoTheBody) {
  Demo demo = demoOf(app::Style::kShoulder);
  const app::BodyDistance body = app::restBodyDistance(demo.actors[0].body->character);
  std::mt19937 random(3);
  for (int k = 0; k < 40; ++k) {
    const int v = static_cast<int>(random() % static_cast<unsigned>(meshOf(demo).vertexCount()));
    const std::vector<Vec3> before = meshOf(demo).shape.positions;
    const auto coordinate = [&] { return 0.1 * (static_cast<double>(random() % 2001) / 1000 - 1); };
    const Vec3 way(coordinate(), coordinate(), coordinate());
    ask(moveOf(MeshElement::kVertex, {v}, way, 0.04, k % 2 == 0), demo);
    for (std::size_t u = 0; u < before.size(); ++u) {
      const double distance = body(meshOf(demo).shape.positions[u]);
      EXPECT_TRUE(distance >= 0.002 || distance >= body(before[u]) - 1e-12) << k << ": " << u;
    }
  }
  expectValid(demo);
  EXPECT_GT(demo.edits.steps.size(), 20u);
}

TEST(MeshMove, TheOtherSideOfTheHeadMovesAsInAMirror) {
  Demo demo = demoOf();
  const double plane = demo.actors[0].body->character.scalp.center.x();
  const std::vector<Vec3> before = meshOf(demo).shape.positions;
  const int c = frontColumn(demo), v = meshOf(demo).shape.column_first[static_cast<std::size_t>(c) + 1] - 2;
  const Vec3 way(0.003, 0.002, 0.001);
  ASSERT_EQ(ask(moveOf(MeshElement::kVertex, {v}, way, 0.02, true), demo), "");
  const std::vector<Vec3>& after = meshOf(demo).shape.positions;
  const double side = before[static_cast<std::size_t>(v)].x() - plane;
  int mirrored = 0;
  for (std::size_t u = 0; u < after.size(); ++u) {
    const Vec3 went = after[u] - before[u];
    if (went.norm() < 1e-4 || (before[u].x() - plane) * side > 0) continue;
    EXPECT_LT(went.x() * way.x(), 0) << u;
    EXPECT_GT(went.y() * way.y(), 0) << u;
    ++mirrored;
  }
  EXPECT_GT(mirrored, 0);
}

TEST(MeshMove, ADragIsOneStepAndUndoBringsBackWhatWas) {
  Demo demo = demoOf();
  const std::string before = wholeHash(demo);
  const int tip = meshOf(demo).shape.column_first[static_cast<std::size_t>(frontColumn(demo)) + 1] - 1;
  for (int k = 0; k < 8; ++k) {
    demo.requests = {moveOf(MeshElement::kVertex, {tip}, {0, 0.001, 0.002})};
    app::advanceFrame(demo, 0, {});
    ASSERT_FALSE(demo.message_is_fault) << demo.message;
  }
  const std::string moved = wholeHash(demo);
  EXPECT_EQ(demo.edits.steps.size(), 1u);
  ask({Ask::kUndo, "", "", 1}, demo);
  EXPECT_EQ(wholeHash(demo), before);
  ask({Ask::kRedo, "", "", 1}, demo);
  EXPECT_EQ(wholeHash(demo), moved);
}

TEST(MeshChange, LayersComeAndGoWhileTheHairMoves) {
  Demo demo = demoOf(app::Style::kLong, "walk.bvh");
  const int layers = *std::ranges::max_element(meshOf(demo).bundle_layers);
  const std::vector<Vec3> seen = demo.actors[0].hair.positions;
  ASSERT_EQ(ask({Ask::kMesh, "add-layer", "4"}, demo), "");
  EXPECT_NE(demo.message.find("layer added: strands within "), std::string::npos) << demo.message;
  EXPECT_EQ(*std::ranges::max_element(meshOf(demo).bundle_layers), layers + 1);
  expectValid(demo);
  std::size_t kept = 0;
  for (const Vec3& p : demo.actors[0].hair.positions) kept += std::ranges::count(seen, p) > 0;
  EXPECT_GE(kept, seen.size()) << "what was there is where it was";
  int recoveries = 0;
  const auto goOn = [&] {
    for (int frame = 0; frame < 30; ++frame) {
      app::advanceFrame(demo, 1.0 / 60, {});
      recoveries += demo.stats.recoveries;
    }
  };
  goOn();
  ASSERT_EQ(ask({Ask::kMesh, "add-layer", std::to_string(layers)}, demo), "") << "beyond the tip";
  goOn();
  ASSERT_EQ(ask({Ask::kMesh, "remove-layer", "6"}, demo), "");
  goOn();
  EXPECT_EQ(recoveries, 0);
  EXPECT_EQ(demo.edits.steps.back().title, "Remove layer");
  expectValid(demo);
}

TEST(MeshChange, WhatCannotBeIsRefusedAndChangesNothing) {
  Demo demo = demoOf();
  const std::string before = wholeHash(demo);
  const std::vector<std::pair<Request, const char*>> refused{
      {{Ask::kMesh, "remove-layer", "0"}, "is the scalp's"},
      {{Ask::kMesh, "remove-layer", "400"}, "is not there"},
      {{Ask::kMesh, "add-layer", ""}, "choose a layer"},
      {{Ask::kMesh, "add-layer", "3 4"}, "choose a layer"},
      {{Ask::kMesh, "split", "1"}, "choose an edge between two roots"},
      {{Ask::kMesh, "merge", "-3"}, "choose columns"},
      {{Ask::kMesh, "shave", "3"}, "is unknown"},
  };
  for (const auto& [request, words] : refused) {
    EXPECT_NE(ask(request, demo).find(words), std::string::npos) << request.name << ": " << demo.message;
    EXPECT_EQ(wholeHash(demo), before);
  }
  EXPECT_TRUE(demo.edits.steps.empty());
  ASSERT_EQ(ask({Ask::kTie, "", "back"}, demo), "");
  EXPECT_NE(ask({Ask::kMesh, "add-layer", "3"}, demo).find("take that off first"), std::string::npos) << demo.message;
}

// Until layers are gone but two, one at a time.
TEST(MeshChange, TheLastLayerStays) {
  Demo demo = demoOf(app::Style::kShort);
  std::string fault;
  for (int k = 0; k < 40 && fault.empty(); ++k) fault = ask({Ask::kMesh, "remove-layer", "1"}, demo);
  EXPECT_FALSE(fault.empty());
  expectValid(demo);
}

Request randomChange(std::mt19937& random, const Demo& demo) {
  const sim::HairMesh& mesh = meshOf(demo);
  const auto pick = [&](int count) { return static_cast<int>(random() % static_cast<unsigned>(count)); };
  const auto along = [&] { return 1e-5 * (pick(1001) - 500); };
  const int layers = *std::ranges::max_element(mesh.bundle_layers);
  const auto element = static_cast<MeshElement>(pick(4));
  app::BrushSample brush;
  switch (pick(10)) {
    case 0:
      return {Ask::kMesh, "add-layer", std::to_string(pick(layers))};
    case 1:
    case 2:
      return {Ask::kMesh, "remove-layer", std::to_string(layers > 6 ? 1 + pick(layers - 1) : 0)};
    case 3:
      return {Ask::kMesh, "split", (pick(2) ? "mirror " : "") + chainOfEdges(demo, 3, static_cast<unsigned>(random()))};
    case 4:
      return {Ask::kMesh, "merge",
              std::to_string(mesh.columnCount() - 1) + " " + std::to_string(pick(mesh.columnCount()))};
    case 5:
      return {Ask::kMesh, "extrude", chainOfEdges(demo, 1, static_cast<unsigned>(random()))};
    case 6:
      brush.at = app::seenFromScalp(demo.actors[0])[static_cast<std::size_t>(pick(mesh.vertexCount()))];
      brush.along = {along(), along(), along()};
      return {Ask::kBrush, pick(2) ? "comb" : "freeze", app::brushText(brush)};
    default:
      break;
  }
  std::vector<int> chosen{pick(element == MeshElement::kLayer    ? layers
                               : element == MeshElement::kColumn ? mesh.columnCount()
                                                                 : mesh.vertexCount())};
  if (element == MeshElement::kEdge) {
    const sim::Edge& edge =
        mesh.horizontal_edges[static_cast<std::size_t>(pick(static_cast<int>(mesh.horizontal_edges.size())))];
    chosen = {edge.a, edge.b};
  }
  return moveOf(element, chosen, {along(), along(), along()}, 0.03, pick(2) == 0);
}

TEST(MeshChange, TwoHundredRandomOnesUndoneAndDoneAgainEndInTheSameBits) {
  Demo demo = demoOf(app::Style::kShort);
  std::mt19937 random(11);
  std::vector<std::string> hashes{wholeHash(demo)};
  std::array<int, 5> done{};
  for (int k = 0; k < 200; ++k) {
    const Request request = randomChange(random, demo);
    const std::size_t before = demo.edits.done;
    const std::string fault = ask(request, demo);
    if (!fault.empty()) {
      EXPECT_EQ(wholeHash(demo), hashes.back()) << fault;
    }
    if (demo.edits.done == before) continue;
    hashes.push_back(wholeHash(demo));
    const auto name = std::ranges::find(app::kMeshChangeNames, request.name);
    if (name != app::kMeshChangeNames.end()) ++done[static_cast<std::size_t>(name - app::kMeshChangeNames.begin())];
  }
  expectValid(demo);
  const std::size_t steps = demo.edits.done;
  EXPECT_GT(steps, 100u);
  for (std::size_t k = 0; k < done.size(); ++k) EXPECT_GT(done[k], 0) << app::kMeshChangeNames[k];
  for (std::size_t k = steps; k-- > 0;) {
    ASSERT_EQ(ask({Ask::kUndo, "", "", 1}, demo), "");
    ASSERT_EQ(wholeHash(demo), hashes[k]) << k << ": " << demo.edits.steps[k].title;
  }
  ASSERT_EQ(ask({Ask::kRedo, "", "", static_cast<double>(steps)}, demo), "");
  EXPECT_EQ(wholeHash(demo), hashes.back());
}

TEST(MeshChange, ARecordedTakeReplaysToTheBit) {
  const std::string file = test::freshFolder("mesh_change") + "/take.hmr";
  app::Options options;
  options.record = file;
  app::Scene scene = sceneOf(app::Style::kLong, "walk.bvh");
  app::Tape tape(options, scene);
  Demo demo = app::openScene(scene, tape.aspect());
  std::mt19937 random(5);
  for (int frame = 0; frame < 60; ++frame) {
    if (frame % 3 == 0 && frame < 50) demo.requests = {randomChange(random, demo), {Ask::kEndGesture, "", ""}};
    if (frame == 53) demo.requests = {{Ask::kUndo, "", "", 2}};
    app::advanceFrame(demo, tape.turn(frame, 1.0 / 60, demo), {});
  }
  const std::string recorded = app::stateHash(demo);
  EXPECT_TRUE(demo.actors[0].haircut->remeshed);
  tape.end(demo);
  app::Options again;
  again.replay = file;
  app::Scene other;
  app::Tape replay(again, other);
  Demo copy = app::openScene(other, replay.aspect());
  for (int frame = 0; frame < replay.frames(); ++frame) app::advanceFrame(copy, replay.turn(frame, 0, copy), {});
  EXPECT_EQ(app::stateHash(copy), recorded);
  EXPECT_EQ(meshOf(copy).shape.positions, meshOf(demo).shape.positions);
  EXPECT_FALSE(replay.end(copy).differs);
}

TEST(MeshChange, AProjectAndASceneKeepTheMesh) {
  const std::string folder = test::freshFolder("mesh_project"), file = folder + "/mine.json";
  Demo demo = demoOf();
  ASSERT_EQ(ask({Ask::kMesh, "add-layer", "3"}, demo), "");
  app::saveProject(file, demo);
  Demo other = demoOf(app::Style::kShort);
  app::openProject(file, other);
  EXPECT_EQ(meshOf(other).shape.positions, meshOf(demo).shape.positions);
  EXPECT_EQ(app::stateHash(other), app::stateHash(demo));
  for (int frame = 0; frame < 10; ++frame) app::advanceFrame(other, 1.0 / 60, {});
  EXPECT_EQ(other.stats.recoveries, 0);
  ASSERT_EQ(ask({Ask::kSaveScene, "", folder + "/scene.json"}, demo), "");
  const Demo reopened = app::openScene(app::loadScene(folder + "/scene.json"), 1.5);
  EXPECT_EQ(meshOf(reopened).shape.positions, meshOf(demo).shape.positions);
}

// m, from the simulated vertices at rest to where strands grow: the longest.
double farthestOffset(const Demo& demo) {
  const app::Haircut& haircut = *demo.actors[0].haircut;
  double most = 0;
  for (std::size_t k = 0; k < haircut.rest_drawn.size(); ++k)
    most = std::max(most, std::abs(static_cast<double>(haircut.rest_drawn[k] - haircut.rest[k])));
  return most;
}

// Strands of a groom grow beside its mesh, after brushes, another layer, undo and in the project too.
TEST(MeshChange, StrandsOfAGroomStayWhereTheyGrow) {
  const std::string folder = test::freshFolder("mesh_groom");
  sim::HairMeshShape shape = meshOf(demoOf()).shape;
  shape.groom_offsets.assign(shape.positions.size(), Vec3::Zero());
  for (int c = 0; c < shape.columnCount(); ++c)
    for (int v = shape.column_first[c] + 1; v < shape.column_first[c + 1]; ++v)
      shape.groom_offsets[static_cast<std::size_t>(v)] = Vec3(0, 0, 0.004);
  app::writeFile(folder + "/groom.obj", app::writeHairMesh(shape));
  app::Scene scene = test::sceneOf(app::Style::kLong, "idle_turns.bvh");
  scene.characters[0].hair = folder + "/groom.obj";
  Demo demo = app::openScene(scene, 1.5);
  app::advanceFrame(demo, 1.0 / 60, {});
  ASSERT_NEAR(farthestOffset(demo), 0.004, 1e-6);
  const app::Actor& actor = demo.actors[0];
  std::vector<float> seen;
  const render::HairInput input = app::hairInput(actor, actor.spec.look, actor.shown_positions, seen);
  ASSERT_EQ(input.positions.size(), actor.shown_positions.size());
  EXPECT_NE(seen, actor.shown_positions) << "what is drawn grows there";
  for (std::size_t k = 0; k < seen.size(); k += 3)
    EXPECT_LT((Eigen::Map<const Eigen::Vector3f>(&input.positions[k]) -
               Eigen::Map<const Eigen::Vector3f>(&actor.shown_positions[k]))
                  .norm(),
              0.0041f);
  ASSERT_EQ(ask({Ask::kMesh, "add-layer", "3"}, demo), "");
  EXPECT_NEAR(farthestOffset(demo), 0.004, 1e-4);
  EXPECT_EQ(meshOf(demo).shape.groom_offsets.size(), meshOf(demo).shape.positions.size());
  const std::vector<float> drawn = demo.actors[0].haircut->rest_drawn;
  app::saveProject(folder + "/mine.json", demo);
  Demo other = demoOf(app::Style::kShort);
  app::openProject(folder + "/mine.json", other);
  ASSERT_EQ(other.actors[0].haircut->rest_drawn.size(), drawn.size());
  for (std::size_t k = 0; k < drawn.size(); ++k)
    ASSERT_NEAR(other.actors[0].haircut->rest_drawn[k], drawn[k], 1e-6) << k;
  ASSERT_EQ(ask({Ask::kUndo, "", ""}, demo), "");
  EXPECT_NEAR(farthestOffset(demo), 0.004, 1e-4);
  EXPECT_EQ(meshOf(demo).shape.positions.size(), shape.positions.size());
}

// Two seconds after the change gravity is balanced in the new mesh: what hangs still has not drooped.
TEST(MeshChange, TwoSecondsAfterAChangeNothingHasDrooped) {
  app::Scene scene = sceneOf(app::Style::kLong, "idle_turns.bvh");
  scene.sim.collide = false;
  Demo demo = app::openScene(std::move(scene), 1.5);
  demo.actors[0].playback.paused = true;
  for (int frame = 0; frame < 60; ++frame) app::advanceFrame(demo, 1.0 / 60, {});
  ASSERT_EQ(ask({Ask::kMesh, "add-layer", "2"}, demo), "");
  ASSERT_EQ(ask({Ask::kMesh, "remove-layer", "7"}, demo), "");
  for (int frame = 0; frame < 120; ++frame) app::advanceFrame(demo, 1.0 / 60, {});
  const app::Actor& actor = demo.actors[0];
  const app::Rigid head = app::scalpToWorld(actor.body->character, actor.pose);
  double most = 0;
  for (std::size_t v = 0; v < actor.hair.positions.size(); ++v)
    most = std::max(most, (actor.hair.positions[v] - head * meshOf(demo).shape.positions[v]).norm());
  EXPECT_LT(most, 0.01 * meshOf(demo).hair_length);
}

}  // namespace mesh_change_test
