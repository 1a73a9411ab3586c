// The tables of what a person may turn about the picture: one for a character's hair, one for the scene's light and
// view. Like the simulation's table they serve the panels, the presets, scene files and --set; names are unique across
// all three.
#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>

#include "render/frame_input.h"
#include "sim/sim_params.h"

namespace app {

// How one character's hair is drawn.
struct CharacterLook {
  render::HairLook hair;
  int strands = 20000;
  int segments_per_layer = 3;
  render::Float3 body_color = render::BodyInput{}.color;
  bool own_materials = true;  // of a figure whose file brings some
  float body_roughness = render::BodyInput{}.roughness;
  bool lift_strands = true;  // out of the skin, see HairInput::skin
  float scalp_tint = 0.8f;   // how much the hair's roots shade and colour the skin between them, 0..1
  bool dressed = true;       // a garment on a grown mannequin
  render::Float3 cloth_color = render::BodyInput{}.cloth_color;
  float face_paint = 1;  // of brows, lashes and lips of a grown mannequin, 0..1
  bool operator==(const CharacterLook&) const = default;
};

// What all characters of a scene share.
struct SceneLook {
  render::LightInput light;
  render::ViewOptions view;
};

// A field's value: one number (the first), or three for a colour or direction.
using LookValue = std::array<double, 3>;

enum class LookShape { kScalar, kColor, kDirection };

// One row of a look table. Ranges hold for each component; light colours may exceed 1.
template <class Owner>
struct LookField {
  const char* name;
  const char* group;
  const char* unit;
  sim::FieldKind kind;
  LookShape shape;
  double minimum, maximum;
  bool logarithmic;
  LookValue default_value;
  const char* help;
  LookValue (*get)(const Owner&);
  void (*set)(Owner&, const LookValue&);
  std::span<const char* const> choices;
  int components() const { return shape == LookShape::kScalar ? 1 : 3; }
};

using HairField = LookField<CharacterLook>;
using SceneField = LookField<SceneLook>;

std::span<const HairField> hairFields();
std::span<const SceneField> sceneFields();

const HairField* findHairField(std::string_view name);
const SceneField* findSceneField(std::string_view name);

// Reads a field from text: a number, on/off, a choice's name, or three numbers separated by commas. Returns an empty
// string, or what is wrong and what would mend it; then nothing changed.
template <class Owner>
std::string setLook(Owner& owner, const LookField<Owner>& field, std::string_view text);

// What setLook reads back as the same value.
template <class Owner>
std::string lookText(const Owner& owner, const LookField<Owner>& field);

// Sets name=value in whichever of the three tables knows the name. Returns an empty string or what is wrong.
std::string setAnywhere(std::string_view name, std::string_view text, sim::SimParams& params,
                        std::span<CharacterLook*> hairs, SceneLook& scene);

}  // namespace app
