// docs/scenes.md names every key of a scene file, and none that there is not.
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <string>

#include "app/files/field_map.h"
#include "app/files/json_kind.h"
#include "app/files/scene_file.h"
#include "app/files/text_file.h"

namespace scene_page_test {

using nlohmann::json;
using Keys = std::set<std::string>;

std::string page() {
  return app::readText(std::string(HAIRMESH_SOURCE_DIR) + "/docs/scenes.md", std::size_t{1} << 20);
}

// What stands in backticks in the first column of the page's tables.
Keys keysOfPage() {
  Keys keys;
  std::istringstream lines(page());
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with("| ")) continue;
    const std::string cell = line.substr(2, line.find(" |", 2) - 2);
    for (std::size_t open = cell.find('`'); open != std::string::npos;) {
      const std::size_t close = cell.find('`', open + 1);
      keys.insert(cell.substr(open + 1, close - open - 1));
      open = cell.find('`', close + 1);
    }
  }
  return keys;
}

void addKeys(const json& object, Keys& keys) {
  for (const auto& [key, value] : object.items()) keys.insert(key);
}

// Those that a scene with all of them is written with.
Keys keysOfScenes() {
  const app::Scene scene = app::readScene(R"({"characters": [{
      "pins": [{"vertex": 1, "at": [0, 0, 0], "until": 2}, {"column": 1, "layer": 1}, {"near": [0, 0, 0]}],
      "ties": [{"side": "left", "braided": true, "bun": true}],
      "attachments": [{"file": "beanie.obj", "at": [0, 0.1, 0], "turn": [0, 9, 0], "scale": 1, "size": 2,
                       "color": [1, 1, 1]}]}],
      "camera": {"eye": [0, 1, 1], "target": [0, 1, 0]}, "preset": "soft"})",
                                          "scene.json");
  const json written = json::parse(app::writeScene(scene));
  Keys keys(app::kSceneKeys.begin(), app::kSceneKeys.end());
  keys.insert(app::kCharacterKeys.begin(), app::kCharacterKeys.end());
  addKeys(written, keys);
  addKeys(written.at("camera"), keys);
  addKeys(written.at("playback"), keys);
  const json& character = written.at("characters").at(0);
  addKeys(character, keys);
  for (const char* list : {"pins", "ties", "attachments"})
    for (const json& one : character.at(list)) addKeys(one, keys);
  keys.insert({"view", "framing"});  // not written beside an eye and a target
  return keys;
}

TEST(ScenePage, NamesEveryKeyAndNoOther) {
  const Keys there = keysOfPage(), are = keysOfScenes();
  EXPECT_GT(are.size(), 50u);
  EXPECT_EQ(there, are);
}

TEST(ScenePage, NamesEveryField) {
  const std::string text = page();
  const std::string fields = text.substr(text.find("\nFields: "), 400);
  for (const std::string_view name : app::kFieldNames)
    EXPECT_NE(fields.find("`" + std::string(name) + "`"), std::string::npos) << name;
}

TEST(ScenePage, ItsExampleIsRead) {
  const std::string text = page(), opening = "```json\n";
  const std::size_t start = text.find(opening) + opening.size();
  const app::Scene scene = app::readScene(text.substr(start, text.find("```", start) - start), "scene.json");
  ASSERT_EQ(scene.characters.size(), 2u);
  EXPECT_EQ(scene.characters[1].ties.size(), 2u);
  EXPECT_EQ(scene.sim.friction, 0.6);
}

}  // namespace scene_page_test
