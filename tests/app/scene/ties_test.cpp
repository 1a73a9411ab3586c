// Hair ties: tied hair is a valid hair mesh on the head, its ring holds, and it is asked for, undone and saved.
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <numeric>
#include <set>

#include "app/files/data_path.h"
#include "app/files/errors.h"
#include "app/files/image_io.h"
#include "app/files/recording.h"
#include "app/files/scene_file.h"
#include "app/scene/demo.h"
#include "app/scene/edit/tie_list.h"
#include "tests/app/scene/small_scene.h"
#include "tests/run_program.h"
#include "tests/sim_probes.h"

namespace ties_test {

using app::Ask;
using test::tiedScene;

// Farthest that a vertex of a ring is from its tie's middle, over the tie's radius; m.
double overOf(const app::Demo& demo) {
  const app::Actor& actor = demo.actors[0];
  const std::vector<app::HairTie> ties = app::placeTies(actor.spec.ties, actor.body->character.scalp);
  const app::Rigid to_scalp = app::scalpToWorld(actor.body->character, actor.pose).inverse();
  double over = -1;
  for (const int v : actor.haircut->tied) {
    const sim::Vec3 now = to_scalp * actor.hair.positions[static_cast<std::size_t>(v)];
    double nearest = 1;
    for (const app::HairTie& tie : ties) nearest = std::min(nearest, (now - tie.at).norm() - tie.radius);
    over = std::max(over, nearest);
  }
  return over;
}

TEST(Ties, EveryPlaceAndStyleGivesAValidHairMeshWhoseRingIsFilled) {
  for (const char* place : {"back", "high", "low", "two"}) {
    for (const app::Style style : {app::Style::kLong, app::Style::kShoulder}) {
      for (const app::Resolution resolution : {app::Resolution::kLow, app::Resolution::kMedium}) {
        const app::Scene scene = tiedScene(place, "idle_turns.bvh", resolution, style);
        const app::Demo demo = app::openScene(scene, 1.5);
        const app::Haircut& haircut = *demo.actors[0].haircut;
        EXPECT_GT(haircut.tied.size(), haircut.mesh.columnCount() * 0.6) << place;
        EXPECT_LT(overOf(demo), 0.001) << place << " " << app::styleName(style) << " "
                                       << app::resolutionName(resolution);
      }
    }
  }
}

// Hair that reaches the ring is tied at every resolution; no hair mesh is too fine.
TEST(Ties, HairThatReachesTheRingIsTiedAtEveryResolution) {
  app::AssetCache cache;  // one figure for all
  for (const app::Resolution resolution :
       {app::Resolution::kLow, app::Resolution::kMedium, app::Resolution::kHigh, app::Resolution::kUltra}) {
    for (const app::Style style : {app::Style::kShort, app::Style::kShoulder, app::Style::kBob, app::Style::kPixie}) {
      const app::Scene scene = tiedScene("low", "idle_turns.bvh", resolution, style);
      EXPECT_NO_THROW(app::makeActor(scene.characters[0], {}, cache))
          << app::styleName(style) << " " << app::resolutionName(resolution);
    }
  }
  // Columns that two ties divide where bundles of different lengths meet.
  const app::Scene two = tiedScene("two", "idle_turns.bvh", app::Resolution::kUltra, app::Style::kShoulder);
  EXPECT_NO_THROW(app::makeActor(two.characters[0], {}, cache));
}

// m over the scalp.
double heightAt(const app::Demo& demo, std::span<const float> positions, int vertex) {
  const app::Actor& actor = demo.actors[0];
  const app::Scalp& scalp = actor.body->character.scalp;
  const Eigen::Map<const Eigen::Vector3f> p(&positions[3 * static_cast<std::size_t>(vertex)]);
  const sim::Vec3 at = app::scalpToWorld(actor.body->character, actor.pose).inverse() * p.cast<double>() - scalp.center;
  return at.norm() - scalp.radiusAt(at.normalized());
}

// Prisms cannot be as thin as a coat of combed hair, and the coarser the hair mesh the higher it stands.
TEST(Ties, StrandsLieOnTheHeadOverTheFirstHalfOfTheWayToTheRing) {
  for (const char* place : {"back", "high", "low", "buns"}) {
    for (const app::Resolution resolution : {app::Resolution::kLow, app::Resolution::kMedium}) {
      app::Demo demo = app::openScene(tiedScene(place, "head_shake.bvh", resolution), 1.5);
      double highest = 0, lowest = 1, simulated = 0;
      for (int frame = 0; frame < 30; ++frame) {
        app::advanceFrame(demo, 1.0 / 60, {});
        const app::Actor& actor = demo.actors[0];
        const sim::HairMeshShape& shape = actor.haircut->mesh.shape;
        std::vector<float> drawn;
        actor.haircut->offsets.add(actor.shown_positions, drawn);
        for (const int ring : actor.haircut->tied) {
          const int first = *std::prev(std::ranges::upper_bound(shape.column_first, ring));
          for (int v = first + 1; 2 * (v - first) <= ring - first; ++v) {
            highest = std::max(highest, heightAt(demo, drawn, v));
            lowest = std::min(lowest, heightAt(demo, drawn, v));
            simulated = std::max(simulated, heightAt(demo, actor.shown_positions, v));
          }
        }
        for (std::size_t v = 0; v < shape.positions.size(); ++v) {
          if (!shape.groom_offsets[v].isZero(0)) continue;
          EXPECT_EQ(drawn[3 * v], actor.shown_positions[3 * v]) << v;
        }
      }
      std::printf("%s %s: strands %.1f to %.1f mm over the scalp, simulated up to %.1f mm\n", place,
                  app::resolutionName(resolution).data(), 1e3 * lowest, 1e3 * highest, 1e3 * simulated);
      EXPECT_LT(highest, 0.018) << place;
      EXPECT_GT(lowest, -0.007) << place;  // strands are lifted out of the skin
      EXPECT_GT(simulated, highest) << place;
    }
  }
}

// A band is seen around what each tie holds, also while the head is shaken; none where no hair is drawn.
TEST(Ties, ABandIsSeenAroundEachTail) {
  for (const char* place : {"back", "two"}) {
    app::Demo demo = app::openScene(tiedScene(place, "head_shake.bvh", app::Resolution::kLow), 1.5);
    for (int frame = 0; frame < 40; ++frame) app::advanceFrame(demo, 1.0 / 60, {});
    const app::Actor& actor = demo.actors[0];
    const render::FrameInput input = app::frameInput(demo, 64, 64);
    ASSERT_EQ(input.bodies.size(), 1 + actor.haircut->ties.size()) << place;
    std::vector<Eigen::Vector3f> middles(input.bodies.size(), Eigen::Vector3f::Zero());
    std::vector<float> counts(input.bodies.size(), 0);
    const auto bandAt = [&](std::size_t k) {
      return Eigen::Map<const Eigen::Matrix4f>(input.bodies[k].joint_matrices[0].data());
    };
    for (const int v : actor.haircut->tied) {
      const Eigen::Map<const Eigen::Vector3f> p(&actor.shown_positions[3 * static_cast<std::size_t>(v)]);
      std::size_t nearest = 1;
      for (std::size_t k = 1; k < input.bodies.size(); ++k)
        if ((bandAt(k).topRightCorner<3, 1>() - p).norm() < (bandAt(nearest).topRightCorner<3, 1>() - p).norm())
          nearest = k;
      middles[nearest] += p, counts[nearest] += 1;
    }
    for (std::size_t k = 1; k < input.bodies.size(); ++k) {
      EXPECT_LT((middles[k] / counts[k] - bandAt(k).topRightCorner<3, 1>()).norm(), 0.003f) << place << " " << k;
      const float radius = bandAt(k).col(0).norm();
      EXPECT_GT(radius, 0.004f) << place;
      EXPECT_LE(radius, 0.02f) << place;
    }
    demo.actors[0].spec.look.strands = 0;
    EXPECT_EQ(app::frameInput(demo, 64, 64).bodies.size(), 1u);
  }
}

TEST(Ties, TheRingHoldsWithinAMillimetreInAHeadShakeAtFourTimesItsSpeed) {
  app::Scene scene = tiedScene("back", "head_shake.bvh", app::Resolution::kLow);
  scene.playback.speed = 4;
  app::Demo demo = app::openScene(std::move(scene), 1.5);
  int recoveries = 0;
  for (int frame = 0; frame < 180; ++frame) {
    app::advanceFrame(demo, 1.0 / 60, {});
    recoveries += demo.stats.recoveries;
    ASSERT_LT(overOf(demo), 0.001) << "frame " << frame;
  }
  EXPECT_EQ(recoveries, 0);
}

// m/s.
double fastestOf(const app::Actor& actor) {
  double fastest = 0;
  for (const sim::Vec3& velocity : actor.hair.velocities) fastest = std::max(fastest, velocity.norm());
  return fastest;
}

// Hair hangs still without contacts: what it does to the scalp, at its roots and through the ring, is its weight.
TEST(Ties, TheScalpBearsTheWeightOfTiedHairAtRootsAndRing) {
  app::Scene scene = tiedScene("back", "idle_turns.bvh", app::Resolution::kLow);
  scene.sim.collide = scene.sim.self_collide = scene.sim.sag_free = false;
  scene.sim.damping = 0.2;
  scene.sim.air_drag = 10;
  app::Demo demo = app::openScene(std::move(scene), 1.5);
  app::Actor& actor = demo.actors[0];
  actor.playback.paused = true;
  int still = 0;  // frames in a row: limp hair that rests squeezed is guided off its rest for a while
  for (int frame = 0; frame < 1800 && still < 120; ++frame) {
    app::advanceFrame(demo, 1.0 / 60, {});
    still = demo.stats.guided == 0 && fastestOf(actor) < 1e-3 ? still + 1 : 0;
  }
  ASSERT_EQ(still, 120) << "it does not come to rest";
  const sim::HairMesh& mesh = actor.haircut->mesh;
  const sim::BlockPattern pattern = sim::systemPattern(mesh);
  const sim::ForceModel<double> model = test::makeForceModel(mesh, pattern, demo.scene.sim);
  std::vector<sim::V3<double>> points, sums(actor.hair.positions.size(), {0, 0, 0});
  for (const sim::Vec3& p : actor.hair.positions) points.push_back({p.x(), p.y(), p.z()});
  sim::Evaluation<double> out;
  out.force = sums;
  sim::evaluate<double>(model, points, out);
  std::vector<sim::Vec3> force;
  for (const sim::V3<double>& one : sums) force.emplace_back(one.x, one.y, one.z);
  std::vector<unsigned char> held(force.size(), 0);
  for (const int v : actor.haircut->tied) held[static_cast<std::size_t>(v)] = 1;
  double weight = 0, largest = 0;
  sim::Vec3 all = sim::Vec3::Zero(), roots = all, ring = all;
  for (int v = 0; v < mesh.vertexCount(); ++v) {
    const auto i = static_cast<std::size_t>(v);
    all += force[i];
    largest = std::max(largest, force[i].norm());
    if (mesh.isRoot(v))
      roots += force[i];
    else if (held[i])
      ring += force[i];
    else
      weight += demo.scene.sim.density * mesh.vertex_volume[i] * demo.scene.sim.gravity;
  }
  std::printf("weight %.3f N; on the roots %.3f N, on the ring %.3f N downwards\n", weight, -roots.y(), -ring.y());
  EXPECT_LT(all.norm(), 1e-9 * largest) << "action is reaction";
  EXPECT_GT(ring.norm(), 0.2 * weight) << "the ring bears its share";
  EXPECT_LT((roots + ring + sim::Vec3(0, weight, 0)).norm(), 0.02 * weight);
}

// Nothing but forces moves tied hair while its figure stands: what a ring squeezes is how it hangs.
TEST(Ties, NoColumnOfTiedHairIsGuidedWhileTheFigureStands) {
  for (const char* scene : {"assets/scenes/pony_tail.json", "assets/scenes/plaits.json"}) {
    app::Demo demo = app::openScene(app::loadScene(app::dataPath(scene)), 1.5);
    demo.actors[0].playback.paused = true;
    for (int frame = 0; frame < 120; ++frame) {
      app::advanceFrame(demo, 1.0 / 60, {});
      ASSERT_EQ(demo.stats.guided, 0) << scene << ", frame " << frame;
    }
  }
}

// m, how far from the scalp hair is combed at most on its way to the ring.
double highestCombed(const app::Actor& actor) {
  const app::Scalp& scalp = actor.body->character.scalp;
  const sim::HairMeshShape& shape = actor.haircut->mesh.shape;
  double highest = 0;
  for (const int ring : actor.haircut->tied) {
    const int first = *std::prev(std::ranges::upper_bound(shape.column_first, ring));
    for (int v = first; v < ring; ++v) {
      const auto i = static_cast<std::size_t>(v);
      const sim::Vec3 off = shape.positions[i] + shape.groom_offsets[i] - scalp.center;
      highest = std::max(highest, off.norm() - scalp.radiusAt(off));
    }
  }
  return highest;
}

// A ring takes all hair from wherever it lies: over the crown, or round the back, not across the face.
TEST(Ties, ARingAnywhereTakesAllHairAndLeavesTheFaceFree) {
  for (const char* ring : {R"({"at": [0.095, 0.054, 0.003]})", R"({"at": [0.085, 0.03, -0.06]})",
                           R"({"at": [0, -0.013, -0.073]})", R"({"at": [-0.011, -0.013, -0.073]})"}) {
    for (const app::Style style : {app::Style::kShoulder, app::Style::kLong, app::Style::kBob}) {
      const app::Demo demo = app::openScene(tiedScene(ring, "idle_turns.bvh", app::Resolution::kLow, style), 1.5);
      const app::Actor& actor = demo.actors[0];
      const app::Scalp& scalp = actor.body->character.scalp;
      EXPECT_EQ(actor.haircut->note.find("hangs loose"), std::string::npos) << ring << actor.haircut->note;
      EXPECT_EQ(std::ssize(actor.haircut->tied), actor.haircut->mesh.columnCount()) << ring;
      const double highest = highestCombed(actor);
      std::printf("%s %s: combed to %.1f mm over the scalp\n", ring, std::string(app::styleName(style)).c_str(),
                  1e3 * highest);
      EXPECT_LT(highest, 0.03) << ring << " " << app::styleName(style);
      if (app::hasFringe(style)) continue;  // which hangs over the forehead by itself
      for (const sim::Vec3& p : actor.haircut->mesh.shape.positions) {
        const sim::Vec3 way = (p - scalp.center).normalized();
        const bool before_face = std::abs(std::atan2(way.x(), way.z())) < 0.5 && std::abs(way.y()) < 0.3;
        EXPECT_FALSE(before_face) << ring << " " << app::styleName(style) << " " << p.transpose();
      }
    }
  }
}

TEST(Ties, AreTiedAndTakenOffAndTiedAgain) {
  app::Demo demo = app::openScene(tiedScene("none", "idle_turns.bvh", app::Resolution::kLow), 1.5);
  const std::string loose = app::stateHash(demo);
  demo.requests = {{Ask::kTie, "", "back"}};
  app::advanceFrame(demo, 0, {});
  ASSERT_FALSE(demo.message_is_fault) << demo.message;
  EXPECT_FALSE(demo.actors[0].haircut->tied.empty());
  demo.requests = {{Ask::kUndo, "", "", 1}};
  app::advanceFrame(demo, 0, {});
  EXPECT_EQ(app::stateHash(demo), loose);
  demo.requests = {{Ask::kTie, "", "sideways"}};
  app::advanceFrame(demo, 0, {});
  EXPECT_TRUE(demo.message_is_fault);
  EXPECT_EQ(app::stateHash(demo), loose) << "what was there stays";
  demo.requests = {{Ask::kTie, "", R"({"at": "back", "above": 0.5})"}};
  app::advanceFrame(demo, 0, {});
  EXPECT_NE(demo.message.find("takes no hair"), std::string::npos) << demo.message;
}

TEST(PaintedLength, EveryResolutionTakesShortHairAndHardEdges) {
  const std::string folder = test::freshFolder("painted_length");
  const auto map = [&](const char* name, std::vector<unsigned char> greys) {
    std::vector<unsigned char> rgba;
    for (const unsigned char grey : greys) rgba.insert(rgba.end(), {grey, grey, grey, 255});
    const std::string file = folder + "/" + name + ".png";
    app::writePng(file, static_cast<int>(greys.size()), 1, rgba);
    return file;
  };
  app::AssetCache cache;  // one figure for all
  const std::string half = map("half", {128}), black = map("black", {0}), edge = map("edge", {255, 255, 0, 0});
  for (const app::Style style :
       {app::Style::kShort, app::Style::kShoulder, app::Style::kLong, app::Style::kBob, app::Style::kPixie}) {
    for (const app::Resolution resolution : {app::Resolution::kLow, app::Resolution::kMedium, app::Resolution::kHigh}) {
      for (const std::string& file : {half, black, edge}) {
        app::Scene scene = tiedScene("none", "idle_turns.bvh", resolution, style);
        scene.characters[0].maps.length = file;
        EXPECT_NO_THROW(app::makeActor(scene.characters[0], {}, cache)) << app::styleName(style) << " " << file;
      }
    }
  }
}

// Bundles that share columns, followed from one to the next: how many tails there are, of hair that would divide over
// the shoulders.
TEST(Ties, WhatATieTakesIsOneTail) {
  app::AssetCache cache;  // one figure for all
  const auto tails = [&](const char* ties, app::Resolution resolution) {
    const app::Scene scene = tiedScene(ties, "idle_turns.bvh", resolution);
    const app::Actor actor = app::makeActor(scene.characters[0], {}, cache);
    const sim::HairMeshShape& shape = actor.haircut->mesh.shape;
    std::vector<int> of(static_cast<std::size_t>(shape.columnCount()));
    std::iota(of.begin(), of.end(), 0);
    for (bool changed = true; changed;) {
      changed = false;
      for (const sim::RootFace& face : shape.root_faces) {
        int least = of[static_cast<std::size_t>(face.columns[0])];
        for (int k = 0; k < face.corner_count; ++k)
          least = std::min(least, of[static_cast<std::size_t>(face.columns[k])]);
        for (int k = 0; k < face.corner_count; ++k) {
          int& here = of[static_cast<std::size_t>(face.columns[k])];
          changed = changed || here != least;
          here = least;
        }
      }
    }
    return std::set<int>(of.begin(), of.end()).size();
  };
  for (const app::Resolution resolution : {app::Resolution::kLow, app::Resolution::kMedium, app::Resolution::kHigh}) {
    EXPECT_EQ(tails("none", resolution), 3u) << "before the left and the right shoulder, and behind";
    EXPECT_EQ(tails("high", resolution), 1u);
    // The parting lies beside the middle: what grows between them may come over it to the other tie.
    EXPECT_LE(tails("two", resolution), 3u);
  }
}

std::string refusalOf(const std::string& ties, app::Resolution resolution, app::Style style) {
  try {
    app::openScene(tiedScene(ties, "idle_turns.bvh", resolution, style), 1.5);
    return "accepted";
  } catch (const app::InputError& error) {
    return error.what();
  }
}

// The tie by its name, why, and what to do instead; nothing of the file that asked for it.
TEST(Ties, ATieThatHoldsNothingIsToldInWords) {
  struct Case {
    const char *ties, *title;
    std::vector<const char*> parts;
    app::Resolution resolution = app::Resolution::kLow;
    app::Style style = app::Style::kLong;
  };
  const Case cases[] = {{R"([{"at": [0, 0, 0]}])", "tie at 0, 0, 0 cm: lies ", {" cm inside the body", "move it off"}},
                        {"high",
                         "tie high: the hair is too short: it ends up to 1",
                         {" cm before", "(back or low)", "longer hair"},
                         app::Resolution::kMedium,
                         app::Style::kPixie},
                        {R"([{"at": "left"}, {"at": "back", "above": 0.5}])", "tie back: takes no hair", {"above"}}};
  for (const Case& c : cases) {
    const std::string refusal = refusalOf(c.ties, c.resolution, c.style);
    EXPECT_TRUE(refusal.starts_with(c.title)) << refusal;
    for (const char* part : c.parts) EXPECT_NE(refusal.find(part), std::string::npos) << refusal;
    EXPECT_EQ(refusal.find('{'), std::string::npos) << refusal;
  }
}

TEST(Ties, ASceneKeepsThem) {
  app::Scene scene =
      tiedScene(R"([{"at": [0.01, 0.2, -0.1], "radius": 0.03}, {"at": "left"}])", "walk.bvh", app::Resolution::kLow);
  const app::Scene back = app::readScene(app::writeScene(scene), "scene.json");
  EXPECT_EQ(app::writeTies(back.characters[0].ties), app::writeTies(scene.characters[0].ties));
  EXPECT_THROW(app::tiesFromText("{\"radius\": 9}"), app::InputError);
  EXPECT_THROW(app::tiesFromText(R"([["left"]])"), app::InputError);
  const auto mixed = app::tiesFromText(R"(["two", {"at": "high"}])");
  ASSERT_EQ(mixed.size(), 3u);
  EXPECT_EQ(mixed[0].place + mixed[1].place + mixed[2].place, "leftrighthigh");
}

// A ring put beside another shares the hair with it, and each of them has some to hold.
TEST(Ties, ARingMoreSharesTheHairWithTheNearest) {
  const app::Scene scene = tiedScene("low", "idle_turns.bvh", app::Resolution::kLow);
  app::Demo demo = app::openScene(scene, 1.5);
  const app::Scalp& scalp = demo.actors[0].body->character.scalp;
  const std::vector<app::TieSpec> low = demo.actors[0].spec.ties;
  app::TieSpec high;
  high.place = "high";
  const std::vector<app::TieSpec> two = app::withRings(low, {high}, scalp);
  ASSERT_EQ(two.size(), 2u);
  EXPECT_EQ(two[0].place, "high") << "a bundle goes to the first tie that takes it";
  EXPECT_GT(two[0].above, 0);
  EXPECT_EQ(two[1].above, low[0].above);
  demo.requests = {{Ask::kTie, "", app::writeTies(two).dump()}};
  app::advanceFrame(demo, 1.0 / 60, {});
  ASSERT_FALSE(demo.message_is_fault) << demo.message;
  ASSERT_EQ(demo.actors[0].haircut->bands.size(), 2u);
  for (const app::HairTie& band : demo.actors[0].haircut->bands) EXPECT_GT(band.radius, 0.002);
  // Below it the same hair is shared the other way about; beside it by sides.
  const std::vector<app::TieSpec> below = app::withRings({high}, low, scalp);
  ASSERT_EQ(below.size(), 2u);
  EXPECT_EQ(below[0].above, two[0].above);
  EXPECT_EQ(below[1].place, "low");
  app::TieSpec left;
  left.at = app::placeTies(low, scalp)[0].at + sim::Vec3(0.06, 0.01, 0);
  const std::vector<app::TieSpec> beside = app::withRings(low, {left}, scalp);
  ASSERT_EQ(beside.size(), 2u);
  EXPECT_EQ(beside[0].side, "right");
  EXPECT_EQ(beside[1].side, "left");
  EXPECT_EQ(app::withRings({}, low, scalp).size(), 1u);
  demo.requests = {{Ask::kUndo, "", "", 1}};
  app::advanceFrame(demo, 1.0 / 60, {});
  EXPECT_EQ(app::writeTies(demo.actors[0].spec.ties), app::writeTies(low));
}

}  // namespace ties_test
