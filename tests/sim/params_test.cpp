// Laws of the parameter tables.
#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string>

#include "app/scene/parameter_table.h"
#include "app/scene/view/look_params.h"
#include "sim/field_text.h"
#include "sim/sim_params.h"

namespace params_test {

using app::CharacterLook;
using app::SceneLook;
using sim::FieldKind;
using sim::ParamField;
using sim::SimParams;

// Two values of a field that differ from one another.
std::pair<std::string, std::string> twoValues(const ParamField& field) {
  switch (field.kind) {
    case FieldKind::kSwitch:
      return {"on", "off"};
    case FieldKind::kChoice:
      return {field.choices.front(), field.choices.back()};
    default:
      return {sim::numberText(field.minimum), sim::numberText(field.maximum)};
  }
}

TEST(SimTable, NamesAreUniqueAcrossAllTables) {
  std::set<std::string> names;
  for (const ParamField& field : sim::paramFields()) EXPECT_TRUE(names.insert(field.name).second) << field.name;
  for (const app::HairField& field : app::hairFields()) EXPECT_TRUE(names.insert(field.name).second) << field.name;
  for (const app::SceneField& field : app::sceneFields()) EXPECT_TRUE(names.insert(field.name).second) << field.name;
}

TEST(SimTable, DefaultsAreThoseOfTheStructAndInRange) {
  const SimParams params;
  for (const ParamField& field : sim::paramFields()) {
    EXPECT_EQ(field.default_value, field.get(params)) << field.name;
    EXPECT_GE(field.default_value, field.minimum) << field.name;
    EXPECT_LE(field.default_value, field.maximum) << field.name;
    EXPECT_LT(field.minimum, field.maximum) << field.name;
    if (field.logarithmic) {
      EXPECT_GE(field.minimum, 0) << field.name;
    }
    EXPECT_NE(*field.help, 0) << field.name;
    EXPECT_NE(*field.group, 0) << field.name;
  }
}

// The rows' members fill the struct but for padding, so a new member without a row shows.
TEST(SimTable, CoversEveryMember) {
  std::size_t covered = 0;
  for (const ParamField& field : sim::paramFields()) {
    covered += field.kind == FieldKind::kReal     ? sizeof(double)
               : field.kind == FieldKind::kSwitch ? sizeof(bool)
                                                  : sizeof(int);
  }
  EXPECT_LT(sizeof(SimParams) - covered, 3 * sizeof(double)) << "a member of SimParams has no row in the table";
}

TEST(SimTable, EveryFieldIsSetAloneAndReadsBack) {
  for (const ParamField& field : sim::paramFields()) {
    const auto [first, second] = twoValues(field);
    for (const std::string& text : {first, second}) {
      SimParams params;
      const sim::ParamText answer = sim::setParam(params, field.name, text);
      ASSERT_TRUE(answer.ok) << field.name << ": " << answer.fault;
      EXPECT_EQ(sim::paramText(field, params), text) << field.name;
      for (const ParamField& other : sim::paramFields()) {
        if (other.name == field.name) continue;
        EXPECT_EQ(other.get(params), other.default_value) << field.name << " moved " << other.name;
      }
    }
  }
}

TEST(SimTable, TextRoundTripsExactly) {
  for (const ParamField& field : sim::paramFields()) {
    if (field.kind != FieldKind::kReal) continue;
    for (const double share : {0.0, 0.1, 1.0 / 3, 0.77777, 1.0}) {
      SimParams params, copy;
      field.set(params, field.minimum + share * (field.maximum - field.minimum));
      ASSERT_TRUE(sim::setParam(copy, field.name, sim::paramText(field, params)).ok) << field.name;
      EXPECT_EQ(field.get(copy), field.get(params)) << field.name;
    }
  }
}

TEST(SimTable, HostileTextIsRefusedAndChangesNothing) {
  const std::string huge(100000, '9');
  for (const ParamField& field : sim::paramFields()) {
    for (const std::string& text :
         {std::string(), std::string("nan"), std::string("inf"), std::string("-1e30"), std::string("1e999"),
          std::string("12abc"), std::string("0x10"), std::string(" "), std::string("--1"), huge}) {
      SimParams params;
      const sim::ParamText answer = sim::setParam(params, field.name, text);
      EXPECT_FALSE(answer.ok) << field.name << " took '" << text.substr(0, 20) << "'";
      EXPECT_NE(answer.fault.find(field.name), std::string::npos);
      EXPECT_LT(answer.fault.size(), 400u);
      EXPECT_EQ(field.get(params), field.default_value) << field.name;
    }
  }
}

TEST(SimTable, AMisspeltNameIsAnsweredWithTheNearest) {
  SimParams params;
  EXPECT_NE(sim::setParam(params, "fricton", "0.5").fault.find("'friction'"), std::string::npos);
  EXPECT_NE(sim::setParam(params, "iterations", "5").fault.find("iterations'"), std::string::npos);
  EXPECT_FALSE(sim::setParam(params, "", "5").ok);
  EXPECT_FALSE(sim::setParam(params, std::string(1 << 20, 'x'), "5").ok);
}

template <class Owner>
void checkLookTable(std::span<const app::LookField<Owner>> table) {
  for (const app::LookField<Owner>& field : table) {
    const Owner standard;
    EXPECT_EQ(field.get(standard), field.default_value) << field.name;
    for (int i = 0; i < field.components(); ++i) {
      EXPECT_GE(field.default_value[i], field.minimum) << field.name;
      EXPECT_LE(field.default_value[i], field.maximum) << field.name;
    }
    // Writing the default as text and reading it changes no bit of what is shown.
    Owner copy;
    EXPECT_EQ(app::setLook(copy, field, app::lookText(standard, field)), "") << field.name;
    EXPECT_EQ(field.get(copy), field.default_value) << field.name;
    for (const char* text : {"", "nan", "1e30", "-1e30", "abc", "1,2", "1,2,3,4"}) {
      EXPECT_NE(app::setLook(copy, field, text), "") << field.name << " took '" << text << "'";
      EXPECT_EQ(field.get(copy), field.default_value) << field.name;
    }
  }
}

TEST(LookTables, DefaultsRoundTripAndHostileTextIsRefused) {
  checkLookTable(app::hairFields());
  checkLookTable(app::sceneFields());
}

TEST(LookTables, ADirectionWithoutLengthIsRefused) {
  SceneLook look;
  EXPECT_NE(app::setLook(look, *app::findSceneField("to_light"), "0,0,0"), "");
}

TEST(LookTables, SetAnywhereFindsTheTableThatKnowsTheName) {
  SimParams params;
  SceneLook scene;
  CharacterLook hair;
  std::array<CharacterLook*, 1> hairs{&hair};
  EXPECT_EQ(app::setAnywhere("friction", "0.7", params, hairs, scene), "");
  EXPECT_EQ(app::setAnywhere("taper", "0.5", params, hairs, scene), "");
  EXPECT_EQ(app::setAnywhere("shadows", "off", params, hairs, scene), "");
  EXPECT_EQ(params.friction, 0.7);
  EXPECT_EQ(hair.hair.taper, 0.5f);
  EXPECT_FALSE(scene.light.shadows);
  EXPECT_NE(app::setAnywhere("tapr", "0.5", params, hairs, scene).find("'taper'"), std::string::npos);
}

TEST(ParameterTable, NamesEveryRow) {
  const std::string text = app::parameterTable();
  for (const ParamField& field : sim::paramFields()) {
    EXPECT_NE(text.find(std::string("`").append(field.name).append("`")), std::string::npos);
  }
}

}  // namespace params_test
