// The inspector: strands that lie apart from all others, or of which a point does, are named and left out.
#include <gtest/gtest.h>

#include "app/groom/inspect/groom_inspect.h"
#include "app/groom/inspect/groom_shape.h"
#include "tests/app/groom/combed_groom.h"
#include "tests/run_program.h"

namespace groom_astray_test {

using namespace combed;

TEST(GroomAstray, NamesStrandsThatLieApartAndJudgesByTheOthers) {
  const app::HeadModel model = head();
  for (const float away : {0.7f, 1.0f, 5.0f, 1000.0f}) {
    const app::Groom whole = combedGroom(300, 12);
    app::Groom groom = whole;
    for (Vector3f& point : std::span(groom.points).subspan(groom.strand_first[10], 8)) point.x() += away;
    const app::GroomInspection inspection = app::inspectGroom(groom, {}, &model);
    ASSERT_TRUE(inspection.find("astray")) << away;
    EXPECT_EQ(test::lacking(inspection.find("astray")->text,
                            "1 of 300 strands lie apart, or have a point that does: number 10"),
              "");
    EXPECT_EQ(inspection.findings.size(), 1u) << inspection.findings.front().what;
    app::mendGroom(inspection.mends, &model, groom);
    ASSERT_EQ(groom.strandCount(), 299u);
    EXPECT_EQ(groom.points.back(), whole.points.back());
  }
}

TEST(GroomAstray, NamesAStrandOfWhichOnePointLeapsOutOfTheGroom) {
  const app::HeadModel model = head();
  for (const float away : {1.0f, 50.0f}) {
    app::Groom groom = combedGroom(300, 12);
    groom.points[groom.strand_first[10] + 4] += Vector3f::Constant(away);
    const app::GroomInspection inspection = app::inspectGroom(groom, {}, &model);
    ASSERT_TRUE(inspection.find("astray")) << away;
    EXPECT_EQ(inspection.findings.size(), 1u) << inspection.findings.front().what;
    app::mendGroom(inspection.mends, &model, groom);
    EXPECT_EQ(groom.strandCount(), 299u);
    EXPECT_LT(app::groomSize(groom), 1.0f);
  }
}

}  // namespace groom_astray_test
