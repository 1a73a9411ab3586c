// Scene and preset files: what round-trips, and what each fault is answered with.
#include "app/files/scene_file.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <span>
#include <string>

#include "app/files/data_path.h"
#include "app/files/errors.h"
#include "app/files/json_kind.h"
#include "app/files/presets.h"
#include "app/files/text_file.h"

namespace scene_file_test {

using app::CharacterLook;
using app::InputError;
using app::Scene;

std::string faultOf(const std::string& text) {
  try {
    app::readScene(text, "scene.json");
  } catch (const InputError& fault) {
    return fault.what();
  }
  return "";
}

TEST(SceneFile, EverySceneAndPresetThatShipsIsRead) {
  const auto scenes = app::listAssets("scenes", {".json"});
  EXPECT_GE(scenes.size(), 5u);
  for (const std::string& file : scenes) EXPECT_NO_THROW(app::loadScene(file)) << file;
  const auto presets = app::listAssets("presets", {".json"});
  EXPECT_GE(presets.size(), 3u);
  for (const std::string& file : presets) {
    sim::SimParams params;
    app::SceneLook look;
    EXPECT_NO_THROW(app::loadPreset(file, {&params, &look, {}})) << file;
  }
}

TEST(SceneFile, WritingAndReadingKeepsEveryRow) {
  Scene scene = app::loadScene(app::dataPath("assets/scenes/default.json"));
  for (const sim::ParamField& field : sim::paramFields()) {
    field.set(scene.sim,
              field.kind == sim::FieldKind::kReal ? 0.3 * field.minimum + 0.7 * field.maximum : field.minimum);
  }
  for (const app::HairField& field : app::hairFields()) {
    const double value =
        field.kind == sim::FieldKind::kReal ? 0.4 * field.minimum + 0.6 * field.maximum : field.maximum;
    field.set(scene.characters[0].look, {value, value, value});
  }
  scene.characters[0].position = {1.25, 0, -3};
  scene.characters[0].heading = 0.5;
  scene.characters[0].loop = app::LoopKind::kInPlace;
  scene.playback.draw_budget_ms = 12.5;
  scene.camera.eye = app::Vec3(0.1, 0.2, 0.3);
  scene.camera.target = app::Vec3(1, 2, 3);
  const Scene copy = app::readScene(app::writeScene(scene), scene.file);
  for (const sim::ParamField& field : sim::paramFields())
    EXPECT_EQ(field.get(copy.sim), field.get(scene.sim)) << field.name;
  for (const app::HairField& field : app::hairFields()) {
    EXPECT_EQ(field.get(copy.characters[0].look), field.get(scene.characters[0].look)) << field.name;
  }
  EXPECT_EQ(copy.characters[0].position, scene.characters[0].position);
  EXPECT_EQ(copy.characters[0].loop, scene.characters[0].loop);
  EXPECT_EQ(copy.playback.draw_budget_ms, 12.5);
  EXPECT_EQ(*copy.camera.eye, *scene.camera.eye);
  EXPECT_EQ(app::writeScene(copy), app::writeScene(scene));
}

TEST(SceneFile, TiesMayBeANameAsOnTheCommandLine) {
  const Scene scene = app::readScene(R"({"characters": [{"style": "long", "ties": "buns"}]})", "scene.json");
  const std::vector<app::TieSpec>& ties = scene.characters[0].ties;
  ASSERT_EQ(ties.size(), 2u);
  EXPECT_TRUE(ties[0].bun && ties[1].bun);
  EXPECT_EQ(ties[0].place, "left");
}

struct FaultCase {
  const char *text, *place, *mend;
};

void expectFaults(std::span<const FaultCase> cases) {
  for (const FaultCase& c : cases) {
    const std::string fault = faultOf(c.text);
    ASSERT_FALSE(fault.empty()) << "accepted: " << c.text;
    EXPECT_NE(fault.find(c.place), std::string::npos) << c.text << "\n  -> " << fault;
    EXPECT_NE(fault.find(c.mend), std::string::npos) << c.text << "\n  -> " << fault;
    EXPECT_LT(fault.size(), 1200u) << c.text;
  }
}

TEST(SceneFile, FaultsNameFilePlaceAndMend) {
  const FaultCase cases[] = {
      {"", "line 1", ""},
      {"[", "line 1", ""},
      {"{}", "scene.json", "characters"},
      {"[]", "scene.json", "{ ... }"},
      {R"({"characters": []})", "/characters", "add a character"},
      {R"({"characters": 3})", "/characters", "[ ... ]"},
      {R"({"charcters": []})", "charcters", "'characters'"},
      {R"({"characters": [{"motion": 5}]})", "/characters/0/motion", "quotes"},
      {R"({"characters": [{"motion": ""}]})", "/characters/0", "motion"},
      {R"({"characters": [{}, {"motion": "nope.bvh"}]})", "/characters/1/motion", "beside the scene"},
      {R"({"characters": [{"hair": "nope.obj"}]})", "/characters/0/hair", "names 'nope.obj', which is not there"},
      {R"({"characters": [{"style": "mohawk"}]})", "/characters/0/style", "short"},
      {R"({"characters": [{"style": "curly"}]})", "/characters/0/style", "open assets/scenes/curly.json"},
      {R"({"characters": [{"position": [1, 2]}]})", "/characters/0/position", "three"},
      {R"({"characters": [{"position": [1, 2, 1e30]}]})", "/characters/0/position/2", "1000"},
      {R"({"characters": [{"position": [1, "x", 0]}]})", "/characters/0/position/1", "number"},
      {R"({"characters": [{"look": {"tapr": 1}}]})", "/characters/0/look", "'taper'"},
      {R"({"characters": [{"look": {"taper": 7}}]})", "/characters/0/look/taper", "range"},
      {R"({"characters": [{}], "sim": {"friction": "wet"}})", "/sim/friction", "number"},
      {R"({"characters": [{}], "sim": {"collide": 7}})", "/sim/collide", "true or false"},
      {R"({"characters": [{}], "sim": {"collide": "on"}})", "/sim/collide", "true or false"},
      {R"({"characters": [{}], "sim": {"friction": "0.5"}})", "/sim/friction: is \"0.5\", not a number", "from 0"},
      {R"({"characters": [{}], "sim": {"solver": 1}})", "/sim/solver", "quotes"},
      {R"({"characters": [{"look": {"taper": "0.5"}}]})", "/characters/0/look/taper", "number"},
      {R"({"characters": [{"look": {"color": "1,0,0"}}]})", "/characters/0/look/color", "three numbers"},
      {R"({"characters": [{"look": {"color": [1, "0", 0]}}]})", "/characters/0/look/color/1", "number"},
      {R"({"characters": [{}], "light": {"shadows": "off"}})", "/light/shadows", "true or false"},
      {R"({"characters": [{}], "view": {"exposure": "2"}})", "/view/exposure", "number"},
      {R"({"characters": [{}], "sim": {"max_iterations": 2.5}})", "/sim/max_iterations", "whole"},
      {R"({"characters": [{}], "light": {"to_light": [0, 0, 0]}})", "/light/to_light", "length"},
      {R"({"characters": [{}], "camera": {"eye": [0, 0, 1]}})", "/camera", "both"},
      {R"({"characters": [{}], "camera": {"eye": [0, 0, 1], "target": [0, 0, 1]}})", "/camera", "apart"},
      {R"({"characters": [{}], "playback": {"fps": 0}})", "/playback/fps", "from 1"},
      {R"({"characters": [{}], "playback": {"draw_budget_ms": -1}})", "/playback/draw_budget_ms", "from 0"},
      {R"({"characters": [{}], "playback": {"draw_budget_ms": "5"}})", "/playback/draw_budget_ms", "number"},
      {R"({"characters": [{}], "preset": "no such preset"})", "no such preset", ""},
      {R"({"characters": [{}], "name": "a", "name": "b"})", "name", "one of the two"},
      {"{\"characters\": [{}],\n\"sim\": {\"friction\": 1e999}}", "'1e999'", "below 1e308"},
      {R"({"characters": [{"ties": "bunn"}]})", "/characters/0/ties: is 'bunn'", "did you mean 'bun'?"},
      {R"({"characters": [{"ties": [{"at": null}]}]})", "/characters/0/ties/0/at", "left or right"},
      {"{\"characters\": [{}],\n \"sim\": {friction: 1}}", "line 2", ""},
      {"{\"characters\": [{}], \"name\": \"\xff\xfe\"}", "line 1", ""},
  };
  expectFaults(cases);
}

TEST(SceneFile, SyntaxIsMendedAndAKeyToldWhereItBelongs) {
  const FaultCase cases[] = {
      {R"({"characters": [{"camera": {"view": "back"}}]})", "/characters/0", "the top of a scene"},
      {R"({"characters": [{"friction": 0.5}]})", "/characters/0", R"("sim": { "friction": ... })"},
      {R"({"characters": [{"taper": 0.5}]})", "/characters/0", R"(a character's "look")"},
      {R"({"characters": [{}], "sim": {"strands": 100}})", "/sim: unknown key 'strands'", R"(a character's "look")"},
      {R"({"characters": [{}], "camera": {"speed": 2}})", "/camera", R"(the scene's "playback")"},
      {R"({"characters": [{}],})", "line 1, column 21", "take the comma before it away"},
      {R"({"characters": [{"position": [1, 2, 3,]}]})", "line 1", "take the comma before it away"},
      {R"({"characters": [{}] "name": "a"})", "line 1", "put a comma before it"},
      {R"({"characters": [{"position": [1 2, 3]}]})", "line 1", "put a comma before it"},
      {R"({"characters": [{} {}]})", "line 1", "put a comma before it"},
      {R"({"characters": [{'motion': ""}]})", "line 1", "double quotes"},
      {"{\"characters\": [{}] // one\n}", "line 1", "no comments"},
      {R"({"characters": [{})", "line 1", "close what is open"},
      {R"({"characters": [{"motion": "wlk.bvh"}]})", "/characters/0/motion", "did you mean 'walk.bvh'?"},
  };
  expectFaults(cases);
}

// By its content, whatever it is called; and a key in a wrong place is told where it belongs.
TEST(SceneFile, AJsonFileIsToldByItsKeys) {
  struct Case {
    const char* text;
    app::JsonKind kind;
    const char *fault, *mend;
  };
  using enum app::JsonKind;
  const Case cases[] = {
      {R"({"style": "bob"})", kScene, "key \"style\": belongs to a character", "\"characters\": [{ \"style\": ... }]"},
      {R"({"ties": [], "motion": "walk.bvh"})", kScene, "key \"motion\"", "\"characters\""},
      {R"({"styel": "bob"})", kScene, "unknown in a scene", ""},
      {R"({"characters": [{}], "camra": {}})", kScene, "key \"camra\": is unknown in a scene", "'camera'"},
      {R"({"characters": [{}], "bend": 1})", kScene, "section \"sim\"", "\"sim\": { \"bend\": ... }"},
      {R"({"characters": [{}], "curl_radius": 1})", kScene, "a character's look", "\"look\": { \"curl_radius\""},
      {R"({"bend": 1})", kPreset, "section \"sim\"", "\"sim\": { \"bend\": ... }"},
      {R"({"sim": {}, "lihgt": {}})", kPreset, "key \"lihgt\": is unknown in a preset", "'light'"},
      {R"({"name": "plain"})", kPreset, "", ""},
      {R"({})", kPreset, "", ""},
      {R"({"hairmesh_project": 1, "scene": {}})", kProject, "unknown in a project", "'hairmesh-project'"},
  };
  for (const Case& c : cases) {
    const nlohmann::json text = app::parseJson(c.text, "file.json");
    const app::JsonPlace top(text, "file.json");
    EXPECT_EQ(app::jsonKind(top), c.kind) << c.text;
    std::string fault;
    try {
      app::expectTopKeys(top, c.kind);
    } catch (const app::InputError& error) {
      fault = error.what();
    }
    EXPECT_NE(fault.find(c.fault), std::string::npos) << c.text << "\n  -> " << fault;
    EXPECT_NE(fault.find(c.mend), std::string::npos) << c.text << "\n  -> " << fault;
    EXPECT_EQ(fault.empty(), !*c.fault) << c.text << "\n  -> " << fault;
  }
  for (const char* text : {"[]", "3", R"({"settings": {}})"}) {
    const nlohmann::json value = app::parseJson(text, "file.json");
    EXPECT_THROW(app::jsonKind(app::JsonPlace(value, "file.json")), app::InputError) << text;
  }
}

TEST(SceneFile, DepthAndSizeAreBounded) {
  EXPECT_NE(faultOf(std::string(1000000, '[')).find("deep"), std::string::npos);
  std::string crowd = "{\"characters\": [{}";
  for (int i = 0; i < 1000; ++i) crowd += ",{}";
  EXPECT_NE(faultOf(crowd + "]}").find("at most"), std::string::npos);
}

TEST(Presets, AFaultChangesNothing) {
  sim::SimParams params;
  app::SceneLook scene;
  CharacterLook look;
  std::array<CharacterLook*, 1> looks{&look};
  EXPECT_THROW(app::applyPreset(R"({"sim": {"friction": 0.9}, "hair": {"taper": 0.1, "clump": 9}})", "p.json",
                                {&params, &scene, looks}),
               InputError);
  EXPECT_EQ(params.friction, sim::SimParams{}.friction);
  EXPECT_EQ(look.hair.taper, CharacterLook{}.hair.taper);
}

TEST(Presets, ANumberInQuotesIsRefusedAsInAScene) {
  sim::SimParams params;
  app::SceneLook scene;
  CharacterLook look;
  std::array<CharacterLook*, 1> looks{&look};
  for (const char* text : {R"({"sim": {"bend": "0.5"}})", R"({"hair": {"taper": "0.5"}})",
                           R"({"light": {"to_light": ["0", 1, 0]}})", R"({"view": {"show_body": "on"}})"})
    EXPECT_THROW(app::applyPreset(text, "p.json", {&params, &scene, looks}), InputError) << text;
}

TEST(Presets, WritingAndReadingKeepsEveryRow) {
  sim::SimParams params, params_read;
  app::SceneLook scene, scene_read;
  CharacterLook look, look_read;
  params.friction = 0.123456789012345678;
  params.solver = sim::Solver::kPaper;
  look.hair.color = {0.1f, 0.7f, 0.3f};
  scene.light.shadows = false;
  scene.view.exposure = 1.7f;
  std::array<CharacterLook*, 1> looks{&look_read};
  app::applyPreset(app::writePreset("mine", params, look, scene), "mine.json", {&params_read, &scene_read, looks});
  for (const sim::ParamField& field : sim::paramFields())
    EXPECT_EQ(field.get(params_read), field.get(params)) << field.name;
  for (const app::HairField& field : app::hairFields()) EXPECT_EQ(field.get(look_read), field.get(look)) << field.name;
  for (const app::SceneField& field : app::sceneFields())
    EXPECT_EQ(field.get(scene_read), field.get(scene)) << field.name;
}

// Everything that a preset may set.
struct Tables {
  sim::SimParams params;
  app::SceneLook scene;
  CharacterLook look;

  void load(const std::string& text, const std::string& file) {
    std::array<CharacterLook*, 1> looks{&look};
    app::applyPreset(text, file, {&params, &scene, looks});
  }
  void choose(const std::string& name) {
    const std::string file = app::presetFile(name, "");
    load(app::readText(file), file);
  }
  std::string text() const { return app::writePreset("", params, look, scene); }
};

TEST(Presets, WhichOneWasChosenBeforeDoesNotMatter) {
  const std::vector<std::vector<std::string>> families{
      {"natural", "soft", "stiff", "bouncy", "fine", "thick", "sprayed", "wet", "windy"}, {"auburn", "black", "blond"}};
  for (const auto& family : families) {
    for (const std::string& before : family) {
      for (const std::string& after : family) {
        Tables alone, both;
        alone.choose(after);
        both.choose(before);
        both.choose(after);
        EXPECT_EQ(both.text(), alone.text()) << before << ", then " << after;
      }
    }
  }
}

TEST(Presets, GroupsThatAreNotNamedStay) {
  Tables tables;
  tables.params.gravity = 3;
  tables.params.bend = 3;
  tables.params.shear = 77;
  tables.look.hair.eumelanin = 4;
  tables.load(R"({"sim": {"bend": 2}})", "p.json");
  EXPECT_EQ(tables.params.bend, 2);
  EXPECT_EQ(tables.params.shear, sim::SimParams{}.shear);
  EXPECT_EQ(tables.params.gravity, 3);
  EXPECT_EQ(tables.look.hair.eumelanin, 4);
}

TEST(Presets, TheOneThatASceneOpensWithIsTold) {
  EXPECT_EQ(app::stem(app::loadScene(app::findFile("default.json", "", "scenes")).preset), "natural");
  EXPECT_EQ(app::loadScene(app::findFile("crowd.json", "", "scenes")).preset, "");
}

void expectSameRows(const app::Scene& a, const app::Scene& b) {
  for (const sim::ParamField& field : sim::paramFields()) EXPECT_EQ(field.get(a.sim), field.get(b.sim)) << field.name;
  for (const app::HairField& field : app::hairFields())
    EXPECT_EQ(field.get(a.characters[0].look), field.get(b.characters[0].look)) << field.name;
  for (const app::SceneField& field : app::sceneFields()) EXPECT_EQ(field.get(a.look), field.get(b.look)) << field.name;
}

// Rows that were put back to their defaults after the preset was chosen are written too.
TEST(Presets, AWrittenSceneKeepsTheNameAndWhatWasChangedSince) {
  app::Scene scene = app::loadScene(app::findFile("default.json", "", "scenes"));
  std::array<CharacterLook*, 1> looks{&scene.characters[0].look};
  scene.preset = app::presetFile("wet", "");
  app::loadPreset(scene.preset, {&scene.sim, &scene.look, looks});
  const double of_wet = scene.sim.bend;
  scene.sim.bend = sim::SimParams{}.bend;
  ASSERT_NE(of_wet, scene.sim.bend);
  scene.characters[0].look.hair = CharacterLook{}.hair;
  const app::Scene read = app::readScene(app::writeScene(scene), "written.json");
  EXPECT_EQ(app::stem(read.preset), "wet");
  expectSameRows(scene, read);
  scene.preset = "of_my_own.json";
  const app::Scene other = app::readScene(app::writeScene(scene), "written.json");
  EXPECT_EQ(other.preset, "") << "its file may be gone";
  expectSameRows(scene, other);
}

TEST(Presets, ASceneOfThatNameIsToldAsWhatItIs) {
  for (const char* name : {"long_wavy", "long_wavy.json"}) {
    try {
      app::presetFile(name, "");
      ADD_FAILURE() << name << " is no preset";
    } catch (const InputError& fault) {
      const std::string words = fault.what();
      EXPECT_NE(words.find("that name is a scene's; name it long_wavy.json, without --preset"), std::string::npos)
          << words;
    }
  }
}

TEST(Presets, WhatWasSavedComesBackOverAnything) {
  const std::string defaults = Tables{}.text();
  Tables tables;
  for (const sim::ParamField& field : sim::paramFields()) field.set(tables.params, field.maximum);
  for (const app::HairField& field : app::hairFields())
    field.set(tables.look, {field.maximum, field.maximum, field.maximum});
  EXPECT_NE(tables.text(), defaults);
  tables.load(defaults, "saved.json");
  EXPECT_EQ(tables.text(), defaults);
}

}  // namespace scene_file_test
