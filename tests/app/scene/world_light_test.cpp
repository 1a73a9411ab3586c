// Lights stand about the figure: one that faces another way than +z is lit from its own front.
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "app/files/data_path.h"
#include "app/scene/demo.h"
#include "tests/run_program.h"

namespace world_light_test {

// idle_turns.bvh for two frames, its figure facing -z: turned by 180 degrees about y, in rest pose and motion.
std::string turnedClip() {
  std::istringstream lines(test::readAll(app::dataPath("assets/clips/idle_turns.bvh")));
  const std::string file = test::freshFolder("turned_clip") + "/turned.bvh";
  std::ofstream out(file);
  int frames = -1;
  for (std::string line; frames < 2 && std::getline(lines, line);) {
    std::istringstream words(line);
    std::string word;
    double x = 0, y = 0, z = 0;
    if (frames >= 0) {
      // Places and angles about y, x, z by turns.
      words >> x >> y >> z;
      out << -x << " " << y << " " << -z;
      while (words >> y >> x >> z) out << " " << y << " " << -x << " " << -z;
      out << "\n";
      ++frames;
      continue;
    }
    words >> word;
    if (word == "OFFSET" && words >> x >> y >> z) {
      out << "OFFSET " << -x << " " << y << " " << -z << "\n";
    } else {
      out << (word == "Frames:" ? "Frames: 2" : line) << "\n";
    }
    if (line.starts_with("Frame Time")) frames = 0;
  }
  return file;
}

render::LightInput lightOf(const std::string& motion) {
  app::Scene scene;
  app::CharacterSpec spec;
  spec.motion = motion;
  spec.style = app::Style::kShort;
  spec.resolution = app::Resolution::kLow;
  scene.characters = {spec};
  scene.playback.settle = 0;
  app::Demo demo = app::openScene(std::move(scene), 1.5);
  return app::frameInput(demo, 64, 64).light;
}

// None of what the program comes with faces elsewhere.
TEST(WorldLight, OwnScenesAreLitAsTheyAreWritten) {
  app::AssetCache cache;
  for (const std::string& file : app::listAssets("scenes", {".json"})) {
    app::CharacterSpec spec = app::loadScene(file).characters.front();
    spec.style = app::Style::kShort;
    spec.resolution = app::Resolution::kLow;
    spec.hair.clear(), spec.attachments.clear(), spec.ties.clear(), spec.pins.clear();
    EXPECT_EQ(app::makeActor(spec, {}, cache).front, 0) << file;
  }
}

TEST(WorldLight, LightsStandAboutTheFigure) {
  const render::LightInput given, ahead = lightOf(app::dataPath("assets/clips/idle_turns.bvh"));
  const render::LightInput behind = lightOf(turnedClip());
  for (const auto towards :
       {&render::LightInput::to_light, &render::LightInput::to_fill, &render::LightInput::to_rim}) {
    EXPECT_EQ(ahead.*towards, given.*towards) << "to the bit";
    EXPECT_NEAR((behind.*towards)[0], -(given.*towards)[0], 1e-6);
    EXPECT_EQ((behind.*towards)[1], (given.*towards)[1]);
    EXPECT_NEAR((behind.*towards)[2], -(given.*towards)[2], 1e-6);
  }
}

}  // namespace world_light_test
