// Braided ties: what is drawn is a plait of three strands over the simulated tail, and nothing else changes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>

#include "app/files/data_path.h"
#include "app/files/errors.h"
#include "app/files/recording.h"
#include "app/scene/braid/braid_draw.h"
#include "app/scene/braid/braid_steps.h"
#include "app/scene/demo.h"
#include "app/scene/edit/groom_brush.h"
#include "app/scene/record/hair_export.h"
#include "app/scene/view/figure_input.h"
#include "tests/app/scene/small_scene.h"

namespace braid_test {

using app::Ask;
using app::Braid;
using app::BraidPlan;
using app::DrawnColumn;
using Eigen::Vector3f;

app::Demo tied(const std::string& ties, app::Resolution resolution, const char* clip = "idle_turns.bvh",
               app::Style style = app::Style::kLong) {
  return app::openScene(test::tiedScene(ties, clip, resolution, style), 1.5);
}

const BraidPlan& planOf(const app::Demo& demo) {
  return demo.actors[0].haircut->braids;
}

Vector3f at(std::span<const float> positions, int vertex) {
  return Eigen::Map<const Vector3f>(&positions[3 * static_cast<std::size_t>(vertex)]);
}

std::vector<float> drawnOf(const app::Demo& demo) {
  std::vector<float> drawn;
  app::drawBraids(planOf(demo), demo.actors[0].shown_positions, drawn);
  return drawn;
}

// The drawn layer of a column that lies in the ring.
int ringOf(const BraidPlan& plan, const DrawnColumn& column) {
  return plan.braids[static_cast<std::size_t>(column.braid)].ring_layer * plan.finer;
}

// m from one drawn layer to another.
double drawnLength(std::span<const float> drawn, int first, int from, int to) {
  double length = 0;
  for (int l = from; l < to; ++l)
    length += static_cast<double>((at(drawn, first + l + 1) - at(drawn, first + l)).norm());
  return length;
}

TEST(Braid, StrandsHoldNearlyEqualHairAtEveryResolution) {
  for (const auto& [resolution, most] :
       {std::pair{app::Resolution::kLow, 0.12}, {app::Resolution::kMedium, 0.04}, {app::Resolution::kHigh, 0.02}}) {
    const app::Demo demo = tied("plaits", resolution);
    ASSERT_EQ(planOf(demo).braids.size(), 2u) << app::resolutionName(resolution);
    for (const Braid& braid : planOf(demo).braids) {
      EXPECT_NEAR(braid.hair[0] + braid.hair[1] + braid.hair[2], 1, 1e-6);
      for (const double share : braid.hair) EXPECT_NEAR(share, 1.0 / 3, most) << app::resolutionName(resolution);
    }
  }
}

TEST(Braid, WithoutABraidedTieNoVertexIsAdded) {
  app::Demo demo = tied("two", app::Resolution::kLow);
  app::advanceFrame(demo, 1.0 / 60, {});
  const app::Actor& actor = demo.actors[0];
  EXPECT_TRUE(planOf(demo).empty());
  const render::FrameInput input = app::frameInput(demo, 64, 64);
  EXPECT_EQ(input.hairs[0].positions.size(), actor.shown_positions.size());
  EXPECT_EQ(input.hairs[0].faces.data(), actor.haircut->faces.data());
  EXPECT_EQ(input.hairs[0].rest.data(), actor.haircut->rest_drawn.data());
  EXPECT_EQ(input.hairs[0].segments_per_layer, actor.spec.look.segments_per_layer);
  EXPECT_EQ(input.bodies.size(), 3u);  // the figure and two bands
}

TEST(Braid, TheSimulationOfABraidedTailIsThatOfATail) {
  app::Demo plain = tied("two", app::Resolution::kLow, "head_shake.bvh"),
            braided = tied("plaits", app::Resolution::kLow, "head_shake.bvh");
  for (int frame = 0; frame < 20; ++frame) {
    app::advanceFrame(plain, 1.0 / 60, {});
    app::advanceFrame(braided, 1.0 / 60, {});
  }
  EXPECT_EQ(plain.actors[0].hair.positions, braided.actors[0].hair.positions);
}

// Vertices at the very bits; what is drawn between them, on the same curve.
TEST(Braid, AboveTheRingHairIsDrawnWhereItIs) {
  app::Demo demo = tied("plaits", app::Resolution::kMedium, "head_shake.bvh");
  for (int frame = 0; frame < 10; ++frame) app::advanceFrame(demo, 1.0 / 60, {});
  const BraidPlan& plan = planOf(demo);
  const std::vector<float>& simulated = demo.actors[0].shown_positions;
  const std::vector<float> drawn = drawnOf(demo);
  ASSERT_GT(plan.finer, 1);
  int compared = 0;
  for (const DrawnColumn& column : plan.columns) {
    const int layers =
        column.braid < 0 ? column.layers : plan.braids[static_cast<std::size_t>(column.braid)].ring_layer + 1;
    for (int l = 0; l < layers; ++l, ++compared)
      ASSERT_EQ(at(drawn, column.first_drawn + l * plan.finer), at(simulated, column.first_vertex + l));
    for (int l = 0; l + 1 < layers; ++l) {
      const Vector3f a = at(simulated, column.first_vertex + l), b = at(simulated, column.first_vertex + l + 1);
      for (int k = 1; k < plan.finer; ++k) {
        const Vector3f p = at(drawn, column.first_drawn + l * plan.finer + k);
        ASSERT_LT((p - a).norm() + (p - b).norm(), 1.25f * (b - a).norm() + 0.002f);
      }
    }
  }
  EXPECT_GT(compared, 500);
}

// The strand that lies outermost, of the two that cross, is another one at each sixth of a turn.
TEST(Braid, StrandsCrossInTheOrderOfAPlait) {
  Braid braid;
  braid.length = 0.45;
  ASSERT_TRUE(app::layBraid(0.018, braid));
  const auto front = [](const app::BraidStep& step) {
    int foremost = 0;
    for (int j = 1; j < app::kBraidStrands; ++j)
      if (step.middle[static_cast<std::size_t>(j)].y() > step.middle[static_cast<std::size_t>(foremost)].y())
        foremost = j;
    return foremost;
  };
  std::vector<int> order;
  std::vector<float> side;  // of where it crosses the others
  for (const app::BraidStep& step : braid.steps) {
    if (&step - braid.steps.data() > braid.band_step) break;
    const int j = front(step);
    if (!order.empty() && order.back() == j) continue;
    order.push_back(j);
    side.push_back(step.middle[static_cast<std::size_t>(j)].x());
  }
  ASSERT_GE(order.size(), 9u);
  for (std::size_t k = 3; k < order.size(); ++k) {
    EXPECT_EQ(order[k], order[k - 3]) << "each comes to the front in turn, crossing " << k;
    EXPECT_NE(order[k], order[k - 1]);
    EXPECT_NE(order[k - 1], order[k - 2]);
  }
  for (std::size_t k = 2; k + 1 < side.size(); ++k)
    EXPECT_LT(side[k] * side[k - 1], 0) << "from the left and from the right by turns, crossing " << k;
}

// Strands that cross are drawn beside each other, not through each other: the middle of each lies outside of the half
// axes of the others.
TEST(Braid, StrandsDoNotLieInEachOther) {
  Braid braid;
  braid.length = 0.45;
  ASSERT_TRUE(app::layBraid(0.018, braid));
  for (int k = 0; k < braid.band_step; ++k) {
    const app::BraidStep& step = braid.steps[static_cast<std::size_t>(k)];
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < i; ++j)
        EXPECT_GT((step.middle[i] - step.middle[j]).cwiseQuotient(step.half).norm(), 1.35f) << "step " << k;
  }
}

TEST(Braid, AMillimetreOfTheHairIsAFewOfThePlait) {
  app::Demo demo = tied("plaits", app::Resolution::kLow, "head_shake.bvh");
  for (int frame = 0; frame < 15; ++frame) app::advanceFrame(demo, 1.0 / 60, {});
  const std::vector<float> before = drawnOf(demo);
  std::uint32_t seed = 1;
  std::vector<float>& positions = demo.actors[0].shown_positions;
  for (float& value : positions) {
    seed = 1664525 * seed + 1013904223;
    value += 0.00057f * (static_cast<float>(seed >> 8) / (1 << 23) - 1);  // 1 mm at most
  }
  const std::vector<float> after = drawnOf(demo);
  ASSERT_EQ(before.size(), after.size());
  float most = 0;
  for (int v = 0; v < static_cast<int>(before.size() / 3); ++v)
    most = std::max(most, (at(after, v) - at(before, v)).norm());
  EXPECT_GT(most, 0.0003f);
  EXPECT_LT(most, 0.003f);
}

// From picture to picture a plait moves as far as its tail does, also where the head is thrown to and fro.
TEST(Braid, NothingPopsInAHeadShake) {
  app::Demo demo = tied("plaits", app::Resolution::kLow, "head_shake.bvh");
  std::vector<float> before;
  std::vector<float> tail_before;
  for (int frame = 0; frame < 90; ++frame) {
    app::advanceFrame(demo, 1.0 / 60, {});
    const std::vector<float> now = drawnOf(demo);
    const std::vector<float>& tail = demo.actors[0].shown_positions;
    float most = 0, tail_most = 0;
    for (int v = 0; v < static_cast<int>(before.size() / 3); ++v)
      most = std::max(most, (at(now, v) - at(before, v)).norm());
    for (int v = 0; v < static_cast<int>(tail_before.size() / 3); ++v)
      tail_most = std::max(tail_most, (at(tail, v) - at(tail_before, v)).norm());
    EXPECT_LE(most, 1.5f * tail_most + 0.002f) << "frame " << frame;
    before = now;
    tail_before = tail;
  }
}

// Hair that goes to and fro is longer than the plait, by no more than half.
TEST(Braid, HairAlongAPlaitIsLittleLongerThanTheTail) {
  for (const app::Resolution resolution : {app::Resolution::kLow, app::Resolution::kMedium}) {
    const app::Demo demo = tied("plaits", resolution);
    const BraidPlan& plan = planOf(demo);
    double mean = 0;
    int columns = 0;
    for (const DrawnColumn& column : plan.columns) {
      if (column.braid < 0) continue;
      const Braid& braid = plan.braids[static_cast<std::size_t>(column.braid)];
      const int ring = ringOf(plan, column), end = ring + static_cast<int>(braid.steps.size()) - 1;
      const double length = drawnLength(plan.rest, column.first_drawn, ring, end);
      EXPECT_GT(length, 0.95 * braid.length);
      EXPECT_LT(length, 1.6 * braid.length);
      mean += length / braid.length;
      ++columns;
    }
    ASSERT_GT(columns, 20);
    EXPECT_GT(mean / columns, 1.1);
    EXPECT_LT(mean / columns, 1.45);
  }
}

TEST(Braid, APlaitIsAsWideAsPlannedAndEndsThinner) {
  const app::Demo demo = tied("plaits", app::Resolution::kMedium);
  const BraidPlan& plan = planOf(demo);
  for (int b = 0; b < 2; ++b) {
    const Braid& braid = plan.braids[static_cast<std::size_t>(b)];
    const auto widthAt = [&](int step) {
      std::vector<Vector3f> section;
      for (const DrawnColumn& column : plan.columns)
        if (column.braid == b) section.push_back(at(plan.rest, column.first_drawn + ringOf(plan, column) + step));
      double width = 0;
      for (const Vector3f& p : section)
        for (const Vector3f& q : section) width = std::max(width, static_cast<double>((p - q).norm()));
      return width;
    };
    double widest = 0;
    for (int k = braid.band_step / 4; k < braid.band_step / 2; ++k) widest = std::max(widest, widthAt(k));
    EXPECT_GT(widest, 0.75 * braid.width);
    EXPECT_LT(widest, 1.05 * braid.width);
    EXPECT_NEAR(widthAt(braid.band_step), 2 * braid.band_radius, 0.3 * braid.band_radius);
    EXPECT_LT(2 * braid.band_radius, 0.5 * braid.width);
  }
}

TEST(Braid, TooShortATailHangsAsATailAndSaysSo) {
  const app::Demo demo = tied(R"([{"at": "low", "radius": 0.06, "braided": true}])", app::Resolution::kLow,
                              "idle_turns.bvh", app::Style::kShoulder);
  EXPECT_TRUE(planOf(demo).empty());
  EXPECT_NE(demo.message.find("too short for a plait"), std::string::npos) << demo.message;
}

TEST(Braid, ATailOfNoLengthGivesNoNan) {
  app::Demo demo = tied("plait", app::Resolution::kLow);
  app::advanceFrame(demo, 0, {});
  std::vector<float>& positions = demo.actors[0].shown_positions;
  std::ranges::fill(positions, 0.25f);
  for (const float value : drawnOf(demo)) ASSERT_TRUE(std::isfinite(value));
  Braid none;
  none.length = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(app::layBraid(0.02, none));
}

TEST(Braid, IsAskedForUndoneAndSaved) {
  app::Demo demo = tied("two", app::Resolution::kLow);
  const std::string before = app::stateHash(demo);
  demo.requests = {{Ask::kTie, "", "plaits"}};
  app::advanceFrame(demo, 0, {});
  ASSERT_FALSE(demo.message_is_fault) << demo.message;
  EXPECT_EQ(planOf(demo).braids.size(), 2u);
  demo.requests = {{Ask::kUndo, "", "", 1}};
  app::advanceFrame(demo, 0, {});
  EXPECT_TRUE(planOf(demo).empty());
  EXPECT_EQ(app::stateHash(demo), before);
  for (const char* text : {"plait", "plaits", "two", R"([{"at": "left", "braided": true}, {"at": "right"}])"}) {
    const std::vector<app::TieSpec> ties = app::tiesFromText(text);
    const std::vector<app::TieSpec> again = app::tiesFromText(app::writeTies(ties).dump());
    ASSERT_EQ(ties.size(), again.size());
    for (std::size_t k = 0; k < ties.size(); ++k) {
      EXPECT_EQ(ties[k].braided, again[k].braided) << text;
      EXPECT_EQ(ties[k].place, again[k].place) << text;
    }
  }
  EXPECT_EQ(app::writeTies(app::tiesFromText("two")).dump().find("braided"), std::string::npos);
  EXPECT_THROW(app::tiesFromText(R"({"at": "back", "braided": 1})"), app::InputError);
}

// Exported strands turn to both sides of the plait's middle, as strands of a tail do not.
TEST(Braid, StrandsAreExportedBraided) {
  const auto turnsOf = [](const char* ties) {
    app::Demo demo = tied(ties, app::Resolution::kLow);
    demo.actors[0].spec.look.strands = 400;
    demo.actors[0].spec.look.hair.wave_height = demo.actors[0].spec.look.hair.curl_radius = 0;
    demo.actors[0].spec.look.hair.frizz = demo.actors[0].spec.look.hair.flyaways = 0;
    app::advanceFrame(demo, 0, {});
    app::StrandExport exported(demo, app::ExportWhat::kStrands, 160);
    const app::Groom& groom = exported.groom(demo, 1);
    double bent = 0;  // rad, of a strand in the mean
    for (std::size_t s = 0; s < groom.strandCount(); ++s) {
      const std::size_t first = groom.strand_first[s];
      for (std::size_t p = 10; p + 2 < groom.pointCount(s); ++p) {
        const Vector3f a = groom.points[first + p + 1] - groom.points[first + p],
                       b = groom.points[first + p + 2] - groom.points[first + p + 1];
        bent += std::atan2(static_cast<double>(a.cross(b).norm()), static_cast<double>(a.dot(b)));
      }
    }
    return bent / static_cast<double>(groom.strandCount());
  };
  const double tail = turnsOf("two"), plait = turnsOf("plaits");
  EXPECT_GT(plait, tail + 2 * std::numbers::pi);
}

TEST(Braid, EveryPlaceAndResolutionIsDrawnFinite) {
  for (const char* ties :
       {"plait", "plaits", R"({"at": "high", "braided": true})", R"({"at": "low", "braided": true})"}) {
    for (const app::Resolution resolution : {app::Resolution::kLow, app::Resolution::kMedium}) {
      app::Demo demo = tied(ties, resolution);
      ASSERT_FALSE(planOf(demo).empty()) << ties << demo.message;
      app::advanceFrame(demo, 0, {});
      const std::vector<float> drawn = drawnOf(demo);
      ASSERT_EQ(drawn.size(), planOf(demo).rest.size());
      for (const float value : drawn) ASSERT_TRUE(std::isfinite(value));
      for (const render::HairFace& face : planOf(demo).faces)
        for (const int first : face.first_vertex)
          ASSERT_LE(3 * static_cast<std::size_t>(std::max(first, 0) + face.layers), drawn.size());
    }
  }
}

}  // namespace braid_test
