// How hair is turned is told by where it grows and where it lies in the world, not by how it is combed.
#include <gtest/gtest.h>

#include "app/groom/inspect/groom_inspect.h"
#include "tests/app/groom/combed_groom.h"

namespace groom_turns_test {

using namespace combed;

// Straight strands from the roots of combed hair.
app::Groom straight(const Vector3f& way) {
  app::Groom groom = combedGroom(400, 7);
  for (std::size_t s = 0; s < groom.strandCount(); ++s) {
    const Vector3f root = groom.points[groom.strand_first[s]];
    for (std::uint32_t p = groom.strand_first[s]; p < groom.strand_first[s + 1]; ++p)
      groom.points[p] = root + static_cast<float>(p - groom.strand_first[s]) / 7 * way;
  }
  return groom;
}

app::HeadModel standing() {
  app::HeadModel model = head();
  model.standing = model.center + Vector3f(0, 1.45f, 0);
  return model;
}

TEST(GroomTurns, HairCombedStraightBackStays) {
  const app::HeadModel model = standing();
  for (const float up : {0.0f, 1.45f}) {
    for (const bool tells : {false, true}) {
      app::Groom groom = straight({0, 0, -0.2f});
      moveAll(groom, Eigen::Matrix3f::Identity(), 1, Vector3f(0, up, 0));
      app::GroomHints hints;
      if (tells) hints.up = 'Y', hints.meters_per_unit = 1;
      const app::GroomInspection inspection = app::inspectGroom(groom, hints, &model);
      EXPECT_TRUE(inspection.mends.axes.isIdentity()) << namesOf(inspection);
      EXPECT_FALSE(inspection.find("up")) << namesOf(inspection);
      EXPECT_TRUE(inspection.on_head) << namesOf(inspection);
      EXPECT_LT((inspection.mends.move + Vector3f(0, up, 0)).norm(), 0.01f) << namesOf(inspection);
    }
  }
}

// In files with z up, whatever they tell, and however short and straight the hair.
TEST(GroomTurns, HairAsHighAsAStandingFiguresIsReadWithThatAxisUp) {
  const app::HeadModel model = standing();
  for (const Vector3f& way : {Vector3f(0, 0, -0.2f), Vector3f(0, 0.03f, 0.01f), Vector3f(0, -0.2f, -0.05f)}) {
    for (const bool tells : {false, true}) {
      app::Groom groom = straight(way);
      moveAll(groom, turnOf("z"), 1, Vector3f(0, 0, 1.45f));
      app::GroomHints hints;
      if (tells) hints.up = 'Y', hints.meters_per_unit = 1;
      const app::GroomInspection inspection = app::inspectGroom(groom, hints, &model);
      ASSERT_TRUE(inspection.find("up")) << way.transpose() << ": " << namesOf(inspection);
      EXPECT_TRUE(inspection.find("up")->certain && inspection.on_head) << namesOf(inspection);
      EXPECT_TRUE(inspection.mends.axes.isApprox(*app::axesOfUp("z"))) << namesOf(inspection);
    }
  }
}

TEST(GroomTurns, StrandsThroughASkullInTheWorldAreNamed) {
  const app::HeadModel model = standing();
  app::Groom groom = combedGroom(400, 7);
  for (std::size_t s = 0; s < 60; ++s) {
    const std::span<Vector3f> points = std::span(groom.points).subspan(groom.strand_first[s], groom.pointCount(s));
    for (Vector3f& point : points.subspan(3)) point += 0.7f * (model.center - point);
  }
  moveAll(groom, Eigen::Matrix3f::Identity(), 1, Vector3f(0, 1.45f, 0));
  const app::GroomInspection inspection = app::inspectGroom(groom, {}, &model);
  ASSERT_TRUE(inspection.find("body")) << namesOf(inspection);
  EXPECT_NE(inspection.find("body")->text.find("60 of 400 strands"), std::string::npos) << namesOf(inspection);
}

TEST(GroomTurns, WidthsOfFewStrandsThatAPowerOfTenMakesUsualAreThat) {
  const app::HeadModel model = head();
  for (const auto& [factor, scale] : {std::pair(1e6f, 1e-6f), std::pair(1e3f, 1e-3f)}) {
    app::Groom groom = combedGroom(400, 7);
    for (float& width : groom.widths) width = 7e-5f * factor;
    const app::GroomInspection inspection = app::inspectGroom(groom, {}, &model);
    EXPECT_NEAR(inspection.mends.width_scale / scale, 1, 1e-3) << namesOf(inspection);
  }
}

// Of many noisy strands a single one may begin off the skull and end on it: that is chance, and turns none.
TEST(GroomTurns, AStrandOfThousandsThatEndsOnTheSkullTurnsNone) {
  const app::HeadModel model = head();
  app::Groom groom = combedGroom(3000, 11);
  const std::size_t last = groom.strand_first[1] - 1;
  const Vector3f root = groom.points[0];
  for (std::size_t p = 0; p <= last; ++p)
    groom.points[p] = root + static_cast<float>(last - p) / static_cast<float>(last) * Vector3f(0, 0.03f, -0.03f);
  const app::GroomInspection inspection = app::inspectGroom(groom, {}, &model);
  EXPECT_FALSE(inspection.find("reversed")) << namesOf(inspection);
  EXPECT_EQ(inspection.mends.reverse, app::Reverse::kNone);
}

}  // namespace groom_turns_test
