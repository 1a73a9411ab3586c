// Parameters that no hair could bear do not tear it, and the list of those limited says what is used and why.
#include "sim/stabilization/parameter_limits.h"

#include <gtest/gtest.h>

#include <string_view>

#include "tests/test_meshes.h"

namespace parameter_limits_test {

using sim::Vec3;
using test::Hair;

constexpr double kFrame = 1.0 / 60;

double longest(const Hair& hair) {
  double most = 0;
  for (int i = 0; i < hair.mesh.vertexCount(); ++i) {
    const Vec3& root = hair.state.positions[hair.mesh.shape.column_first[hair.mesh.column_of[i]]];
    most = std::max(most, (hair.state.positions[i] - root).norm() / hair.mesh.hair_length);
  }
  return most;
}

TEST(ParameterLimits, HairAsSoftAsFoamIsNotStretchedByItsWeightNorByAStorm) {
  for (const double wind : {0.0, 40.0}) {
    sim::SimParams params;
    params.collide = false;
    params.density = 2000, params.gravity = 100, params.stretch_along = 100;
    params.wind_x = wind, params.air_drag = 50;
    params.sag_free = false;
    Hair hair(test::combedShape(test::mixedPatch(5, 0.25)), params);
    double most = 0;
    for (double t = 0; t < 3; t += kFrame) {
      EXPECT_EQ(hair.step(kFrame).recoveries, 0);
      most = std::max(most, longest(hair));
    }
    EXPECT_LT(most, 1.3) << "wind " << wind;
  }
}

TEST(ParameterLimits, OrdinaryHairKeepsItsParameters) {
  const sim::HairMesh mesh = sim::buildHairMesh(test::combedShape(test::mixedPatch(5, 0.25)));
  sim::SimParams params;
  params.wind_x = 10;
  const sim::SimParams borne = sim::limitedParameters(mesh, params);
  for (const sim::ParamField& field : sim::paramFields()) EXPECT_EQ(field.get(borne), field.get(params)) << field.name;
  EXPECT_TRUE(sim::limitedValues(mesh, params).empty());
}

// What the list says is what a step takes, in the parameter table's order, and nothing else differs.
TEST(ParameterLimits, TheListSaysWhatIsUsedAndWhy) {
  const sim::HairMesh mesh = sim::buildHairMesh(test::combedShape(test::mixedPatch(5, 0.25)));
  sim::SimParams params;
  params.stretch_along = 100;
  std::vector<sim::LimitedValue> list = sim::limitedValues(mesh, params);
  ASSERT_EQ(list.size(), 1u);
  EXPECT_STREQ(list[0].field->name, "stretch_along");
  EXPECT_DOUBLE_EQ(list[0].used, params.density * params.gravity * mesh.hair_length / sim::kMaxLoadStrain);
  EXPECT_STREQ(list[0].reason, "to bear the hair's weight");

  params.wind_x = 30, params.wind_z = -40, params.gust = 1, params.air_drag = 2;  // twice the wind load that is used
  list = sim::limitedValues(mesh, params);
  ASSERT_EQ(list.size(), 3u);
  EXPECT_STREQ(list[0].reason, "to bear the hair's weight and the wind");
  EXPECT_STREQ(list[1].field->name, "wind_x");
  EXPECT_DOUBLE_EQ(list[1].used, 15);
  EXPECT_STREQ(list[2].field->name, "wind_z");
  EXPECT_DOUBLE_EQ(list[2].used, -20);
  EXPECT_NE(std::string_view(list[2].reason).find("crush"), std::string_view::npos);
  for (const sim::LimitedValue& limited : list) limited.field->set(params, limited.used);
  EXPECT_TRUE(sim::limitedValues(mesh, params).empty());
}

TEST(ParameterLimits, ThePublishedStepAndLooseParticlesHaveNone) {
  const sim::HairMesh mesh = sim::buildHairMesh(test::combedShape(test::mixedPatch(5, 0.25)));
  sim::SimParams params;
  params.stretch_along = 100, params.wind_x = 40, params.air_drag = 50;
  EXPECT_FALSE(sim::limitedValues(mesh, params).empty());
  params.solver = sim::Solver::kPaper;
  EXPECT_TRUE(sim::limitedValues(mesh, params).empty());
  params.solver = sim::Solver::kDefault;
  params.stretch_along = params.volume = 0;
  EXPECT_TRUE(sim::limitedValues(mesh, params).empty());
}

}  // namespace parameter_limits_test
