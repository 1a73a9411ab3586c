// Small pictures of the presets: the head of the selected character with the look that each gives. Hair that a preset
// makes move otherwise is shown as it is when the head has just turned (preset_swing.h), other hair at rest.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/scene/demo.h"
#include "app/scene/view/preset_swing.h"

namespace app {

// What the pictures of all presets depend on beside their files. They do not depend on the moment.
struct PictureSubject {
  std::uint64_t haircut = 0, body = 0;
  std::size_t shape = 0;         // hash of the rest shape
  std::vector<double> settings;  // of all three tables
  bool operator==(const PictureSubject&) const = default;
};
PictureSubject pictureSubject(const Demo& demo);

// The subject with a preset's settings, and what the spans of its picture point to.
struct PresetScene {
  sim::SimParams sim;
  CharacterLook look;
  SceneLook scene;
  bool moves = false;  // the preset has settings of the simulation
  Pose pose;           // at rest, facing +z
  std::vector<float> positions, drawn;
  std::vector<render::Mat4> bands;
  std::vector<render::Mat4> joints, worn;
  ShownSkin skin;
  std::vector<render::HairInput> hairs;
  std::vector<render::BodyInput> bodies;
};

// Reads a preset for the selected character. Throws InputError.
PresetScene presetScene(const std::string& file, const Demo& demo);

// What has to be simulated for the picture. Nothing where the hair is shown at rest: the preset leaves the simulation
// as it is, or the hair is tied, pinned or under an attachment.
std::optional<Swing> swingOf(const PresetScene& preset, const Demo& demo);

// The picture, so many pixels wide and high, of the hair at `positions` (m, world; empty: at rest). `revision`: other
// than that of any picture before.
render::FrameInput presetFrame(const Demo& demo, const std::vector<Vec3>& positions, int width, int height,
                               std::uint64_t revision, PresetScene& preset);

}  // namespace app
