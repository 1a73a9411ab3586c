// Buns: hair beyond a ring is wound about it over the head, held there, and drawn as a rope or a plait.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "app/files/data_path.h"
#include "app/files/errors.h"
#include "app/files/recording.h"
#include "app/scene/braid/braid_draw.h"
#include "app/scene/demo.h"
#include "tests/app/scene/small_scene.h"

namespace bun_test {

using app::Ask;
using app::Braid;
using app::BraidPlan;
using Eigen::Vector3d;

constexpr const char* kPlaited = R"({"at": "back", "bun": true, "braided": true})";

app::Demo tied(const char* ties, app::Resolution resolution, const char* clip = "idle_turns.bvh", double speed = 1) {
  app::Scene scene = test::tiedScene(ties, clip, resolution);
  scene.playback.speed = speed;
  return app::openScene(std::move(scene), 1.5);
}

std::vector<Vector3d> drawnOf(const BraidPlan& plan, std::span<const float> positions) {
  std::vector<float> drawn;
  app::drawBraids(plan, positions, drawn);
  std::vector<Vector3d> points;
  for (std::size_t v = 0; v + 2 < drawn.size(); v += 3)
    points.push_back(Eigen::Map<const Eigen::Vector3f>(&drawn[v]).cast<double>());
  return points;
}

// Calls with the drawn points of hair in a bun, beyond where it comes in from its ring.
template <class Visit>
void forWound(const BraidPlan& plan, const Visit& visit) {
  for (const app::DrawnColumn& column : plan.columns) {
    if (column.braid < 0) continue;
    const Braid& braid = plan.braids[static_cast<std::size_t>(column.braid)];
    const int ring = braid.ring_layer * plan.finer;
    for (std::size_t k = 1; k < braid.steps.size(); ++k)
      if (braid.steps[k].hold >= 1) visit(braid, column.first_drawn + ring + static_cast<int>(k));
  }
}

TEST(Bun, IsARoundHeapOnTheHeadAtEveryResolution) {
  for (const char* ties : {"bun", "buns", kPlaited}) {
    for (const app::Resolution resolution : {app::Resolution::kLow, app::Resolution::kMedium, app::Resolution::kHigh}) {
      const app::Demo demo = tied(ties, resolution);
      const app::Haircut& haircut = *demo.actors[0].haircut;
      const app::Scalp& scalp = demo.actors[0].body->character.scalp;
      ASSERT_EQ(haircut.braids.braids.size(), haircut.ties.size()) << ties;
      const std::vector<Vector3d> drawn = drawnOf(haircut.braids, haircut.rest);
      int points = 0;
      double low = 1, high = -1, wide = 0;
      forWound(haircut.braids, [&](const Braid&, int v) {
        const Vector3d& p = drawn[static_cast<std::size_t>(v)];
        const auto off = [&](const app::HairTie& tie) { return (p - tie.at).norm(); };
        const app::HairTie& tie = *std::ranges::min_element(haircut.ties, {}, off);
        const Vector3d axis = (tie.at - scalp.center).normalized(), from = p - tie.at;
        wide = std::max(wide, (from - axis * axis.dot(from)).norm());
        const double over = (p - scalp.center).norm() - scalp.radiusAt(p - scalp.center);
        low = std::min(low, over), high = std::max(high, over);
        ++points;
      });
      EXPECT_GT(points, 1000) << ties;
      EXPECT_GT(low, -0.004) << ties << " " << app::resolutionName(resolution) << ": it lies in the head";
      EXPECT_LT(low, 0.008) << ties << " " << app::resolutionName(resolution) << ": it floats";
      EXPECT_LT(high, 0.055) << ties << " " << app::resolutionName(resolution);
      EXPECT_GT(wide, 0.025) << ties << " " << app::resolutionName(resolution);
      EXPECT_LT(wide, 0.065) << ties << " " << app::resolutionName(resolution);
    }
  }
}

TEST(Bun, TheRopeIsAsLongAsTheHairAndGoesRoundTheRing) {
  const app::Demo demo = tied("bun", app::Resolution::kMedium);
  const Braid& braid = demo.actors[0].haircut->braids.braids.at(0);
  const app::HairTie& tie = demo.actors[0].haircut->ties[0];
  const Vector3d up = braid.axis.cross(braid.across);
  ASSERT_EQ(braid.coil.size(), braid.steps.size());
  double length = 0, turned = 0;
  for (std::size_t k = 1; k < braid.coil.size(); ++k) {
    const Vector3d a = braid.coil[k - 1].at - tie.at, b = braid.coil[k].at - tie.at;
    length += (b - a).norm();
    const double from = std::atan2(a.dot(up), a.dot(braid.across)), to = std::atan2(b.dot(up), b.dot(braid.across));
    turned += std::remainder(to - from, 2 * std::numbers::pi);
  }
  EXPECT_NEAR(length, braid.length, 0.02 * braid.length);
  EXPECT_GT(braid.length, 0.25) << "long hair";
  EXPECT_GT(turned / (2 * std::numbers::pi), 2);
}

// Pins hold every simulated vertex of a bun where it rests on the head, and what is drawn goes along.
TEST(Bun, HoldsWithinAMillimetreInAHeadShakeAtFourTimesItsSpeed) {
  app::Demo demo = tied("bun", app::Resolution::kLow, "head_shake.bvh", 4);
  const app::Actor& actor = demo.actors[0];
  const app::Haircut& haircut = *actor.haircut;
  ASSERT_GT(haircut.wound.size(), 100u);
  const std::vector<Vector3d> rest = drawnOf(haircut.braids, haircut.rest);
  double turned = 0;
  int recoveries = 0;
  for (int frame = 0; frame < 120; ++frame) {
    app::advanceFrame(demo, 1.0 / 60, {});
    recoveries += demo.stats.recoveries;
    const app::Rigid to_scalp = app::scalpToWorld(actor.body->character, actor.pose).inverse();
    turned = std::max(turned, (to_scalp.linear() - Eigen::Matrix3d::Identity()).norm());
    for (const int v : haircut.wound) {
      const Vector3d now = to_scalp * actor.hair.positions[static_cast<std::size_t>(v)];
      ASSERT_LT((now - haircut.mesh.shape.positions[static_cast<std::size_t>(v)]).norm(), 0.001) << "frame " << frame;
    }
    const std::vector<Vector3d> drawn = drawnOf(haircut.braids, actor.shown_positions);
    const app::Rigid shown = app::scalpToWorld(actor.body->character, actor.shown_pose).inverse();
    const Vector3d origin = demo.origin;
    forWound(haircut.braids, [&](const Braid&, int v) {
      const Vector3d now = shown * (drawn[static_cast<std::size_t>(v)] + origin);
      ASSERT_LT((now - rest[static_cast<std::size_t>(v)]).norm(), 0.001) << "frame " << frame;
    });
  }
  EXPECT_EQ(recoveries, 0);
  EXPECT_GT(turned, 0.3) << "the head did not turn";
}

TEST(Bun, HairTooShortForOneHangsAsATailAndSaysSo) {
  app::Scene scene = test::tiedScene("bun", "idle_turns.bvh", app::Resolution::kLow, app::Style::kShoulder);
  const app::Demo demo = app::openScene(std::move(scene), 1.5);
  const app::Haircut& haircut = *demo.actors[0].haircut;
  EXPECT_TRUE(haircut.braids.empty());
  EXPECT_TRUE(haircut.wound.empty());
  EXPECT_NE(haircut.note.find("too short for a bun (15.0 cm): a tail"), std::string::npos) << haircut.note;
  // What it says makes one does.
  const std::string named = "\"radius\": ";
  const std::size_t at = haircut.note.find(named);
  ASSERT_NE(at, std::string::npos) << haircut.note;
  const double radius = std::stod(haircut.note.substr(at + named.size()));
  const std::string narrow = R"({"at": "back", "bun": true, "radius": )" + std::to_string(radius) + "}";
  const app::Demo bun =
      app::openScene(test::tiedScene(narrow, "idle_turns.bvh", app::Resolution::kLow, app::Style::kShoulder), 1.5);
  EXPECT_FALSE(bun.actors[0].haircut->wound.empty()) << radius;
}

TEST(Bun, ARingFarFromTheHeadIsRefused) {
  const std::string far = R"({"at": [0, 0.3, -0.4], "bun": true})";
  try {
    app::openScene(test::tiedScene(far, "idle_turns.bvh", app::Resolution::kLow), 1.5);
    FAIL() << "it is taken";
  } catch (const app::InputError& error) {
    EXPECT_NE(std::string(error.what()).find("cm off the body"), std::string::npos) << error.what();
  }
}

TEST(Bun, IsMadeAndUndone) {
  app::Demo demo = tied("back", app::Resolution::kLow);
  const std::string tail = app::stateHash(demo);
  demo.requests = {{Ask::kTie, "", R"([{"at": "back", "bun": true}])"}};
  app::advanceFrame(demo, 0, {});
  ASSERT_FALSE(demo.message_is_fault) << demo.message;
  EXPECT_NE(demo.message.find("hair in a bun with tie back"), std::string::npos) << demo.message;
  EXPECT_FALSE(demo.actors[0].haircut->wound.empty());
  EXPECT_NE(app::writeTies(demo.actors[0].spec.ties).dump().find("\"bun\":true"), std::string::npos);
  demo.requests = {{Ask::kUndo, "", "", 1}};
  app::advanceFrame(demo, 0, {});
  EXPECT_EQ(app::stateHash(demo), tail);
}

TEST(Bun, AndATailLieBelowTheHatThatIsWorn) {
  for (const char* ties : {"bun", "back", "plait"}) {
    app::Scene scene = test::tiedScene(ties, "idle_turns.bvh", app::Resolution::kLow);
    scene.characters[0].attachments = app::attachmentsFromText(app::dataPath("assets/attachments/sun_hat.obj"));
    const app::Demo demo = app::openScene(std::move(scene), 1.5);
    const app::Haircut& haircut = *demo.actors[0].haircut;
    ASSERT_FALSE(haircut.covered.empty());
    EXPECT_NE(haircut.note.find("mm lower"), std::string::npos) << haircut.note;
    for (const std::vector<int>* held : {&haircut.tied, &haircut.wound})
      for (const int v : *held) ASSERT_FALSE(std::ranges::binary_search(haircut.covered, v)) << ties;
  }
}

}  // namespace bun_test
