// A scene that is quick to open, for tests of what surrounds the hair.
#pragma once

#include <string>
#include <utility>

#include "app/files/data_path.h"
#include "app/files/tie_spec.h"
#include "app/scene/demo.h"

namespace test {

// One figure with short hair of low resolution on one of the program's clips; `settle` in s.
inline app::Scene smallScene(const std::string& clip, double settle = 0) {
  app::Scene scene;
  app::CharacterSpec spec;
  spec.motion = app::dataPath("assets/clips/" + clip);
  spec.style = app::Style::kShort;
  spec.resolution = app::Resolution::kLow;
  scene.characters = {spec};
  scene.playback.settle = settle;
  return scene;
}

// One with hair tied as `--tie` takes it, long enough to settle in the ring.
inline app::Scene tiedScene(const std::string& ties, const std::string& clip, app::Resolution resolution,
                            app::Style style = app::Style::kLong) {
  app::Scene scene = smallScene(clip, 0.3);
  app::CharacterSpec& spec = scene.characters.front();
  spec.style = style;
  spec.resolution = resolution;
  spec.ties = app::tiesFromText(ties);
  return scene;
}

}  // namespace test
