// Variations of the material, and the key light that a drag turns.
#include "app/scene/edit/vary.h"

#include <gtest/gtest.h>

#include <cmath>

#include "app/scene/demo.h"
#include "app/scene/view/light_drag.h"
#include "tests/app/scene/small_scene.h"

namespace vary_test {

TEST(Vary, MovesTheMaterialWithinItsRangesAndNothingElse) {
  const sim::SimParams standard;
  int moved = 0;
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    sim::SimParams params;
    app::varyMaterial(0.3, seed, params);
    for (const sim::ParamField& row : sim::paramFields()) {
      const double before = row.get(standard), after = row.get(params);
      if (std::string_view(row.group) != "Material") {
        EXPECT_EQ(after, before) << row.name;
      }
      EXPECT_GE(after, row.minimum) << row.name;
      EXPECT_LE(after, row.maximum) << row.name;
      if (row.logarithmic && after != before) {
        EXPECT_LE(std::abs(std::log10(after / before)), 0.3 + 1e-12) << row.name;
      }
      moved += after != before;
    }
  }
  EXPECT_GT(moved, 50 * 6);
}

TEST(Vary, TheSameSeedGivesTheSameBitsAndNoAmountNoChange) {
  sim::SimParams once, again, other, none;
  app::varyMaterial(0.5, 7, once);
  app::varyMaterial(0.5, 7, again);
  app::varyMaterial(0.5, 8, other);
  app::varyMaterial(0, 7, none);
  EXPECT_EQ(once.bend, again.bend);
  EXPECT_NE(once.bend, other.bend);
  EXPECT_EQ(none.bend, sim::SimParams().bend);
}

TEST(Vary, IsOneStepOfTheHistory) {
  app::Demo demo = app::openScene(test::smallScene("idle_turns.bvh"), 1.5);
  const std::string before = app::editHash(demo);
  demo.requests = {{app::Ask::kVary, "", "0.4", 3}};
  app::advanceFrame(demo, 0, {});
  EXPECT_NE(app::editHash(demo), before);
  ASSERT_EQ(demo.edits.done, 1u);
  EXPECT_EQ(demo.edits.steps[0].title, "Variation 3");
  demo.requests = {{app::Ask::kUndo, "", "", 1}};
  app::advanceFrame(demo, 0, {});
  EXPECT_EQ(app::editHash(demo), before);
  demo.requests = {{app::Ask::kVary, "", "much", 3}};
  app::advanceFrame(demo, 0, {});
  EXPECT_TRUE(demo.message_is_fault);
  EXPECT_EQ(app::editHash(demo), before) << "what was there stays";
}

TEST(TurnedLight, GoesWithTheMouseAndStopsShortOfTheVertical) {
  const render::Float3 from{0.45f, 0.8f, 0.6f};
  const auto rise = [](const render::Float3& way) { return way[1] / std::hypot(way[0], way[1], way[2]); };
  EXPECT_GT(rise(app::turnedLight(from, 0, -100, 700)), rise(from));
  const render::Float3 aside = app::turnedLight(from, 100, 0, 700);
  EXPECT_NEAR(rise(aside), rise(from), 1e-6);
  EXPECT_GT(std::atan2(aside[0], aside[2]), std::atan2(from[0], from[2]));
  EXPECT_LT(rise(app::turnedLight(from, 0, -5000, 700)), 0.9999);
  EXPECT_GT(rise(app::turnedLight(from, 0, 5000, 700)), -0.9999);
  EXPECT_NEAR(rise(app::turnedLight({0, 0, 0}, 0, 0, 700)), 0, 1e-6);
}

}  // namespace vary_test
