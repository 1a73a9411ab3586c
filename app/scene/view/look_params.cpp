#include "app/scene/view/look_params.h"

#include <charconv>
#include <cmath>
#include <type_traits>
#include <vector>

#include "sim/field_text.h"

namespace app {

namespace {

using render::Float3;

struct Range {
  double minimum, maximum;
  bool logarithmic = false;
};

constexpr bool kLog = true;
constexpr std::array<const char*, 4> kStrandPaths{"geometry", "compute", "software", "auto"};

// 0.35f as a double is 0.3499999940395355; a person and a preset want to read 0.35, which gives the same float back.
double plain(float value) {
  char buffer[32];
  const auto written = std::to_chars(buffer, buffer + sizeof buffer, value);
  double shortest = value;
  std::from_chars(buffer, written.ptr, shortest);
  return shortest;
}

// Builds a row from an accessor of the member; the default is read from Owner{} and written nowhere twice.
template <class Owner, auto Access>
LookField<Owner> field(const char* name, const char* group, const char* unit, Range range, const char* help) {
  using Value = std::remove_reference_t<decltype(Access(std::declval<Owner&>()))>;
  LookField<Owner> row{};
  row.name = name;
  row.group = group;
  row.unit = unit;
  row.kind = std::is_same_v<Value, bool> ? sim::FieldKind::kSwitch
             : std::is_enum_v<Value>     ? sim::FieldKind::kChoice
             : std::is_integral_v<Value> ? sim::FieldKind::kInteger
                                         : sim::FieldKind::kReal;
  row.shape = LookShape::kScalar;
  row.minimum = range.minimum;
  row.maximum = range.maximum;
  row.logarithmic = range.logarithmic;
  row.help = help;
  row.get = [](const Owner& owner) -> LookValue {
    const Value& value = Access(owner);
    if constexpr (std::is_same_v<Value, Float3>) {
      return {plain(value[0]), plain(value[1]), plain(value[2])};
    } else if constexpr (std::is_same_v<Value, float>) {
      return {plain(value), 0, 0};
    } else {
      return {static_cast<double>(value), 0, 0};
    }
  };
  row.set = [](Owner& owner, const LookValue& value) {
    Value& target = Access(owner);
    if constexpr (std::is_same_v<Value, Float3>) {
      for (int i = 0; i < 3; ++i) target[i] = static_cast<float>(value[i]);
    } else if constexpr (std::is_same_v<Value, bool>) {
      target = value[0] != 0;
    } else if constexpr (std::is_floating_point_v<Value>) {
      target = static_cast<Value>(value[0]);
    } else {
      target = static_cast<Value>(std::llround(value[0]));
    }
  };
  row.default_value = row.get(Owner{});
  return row;
}

template <auto Access>
HairField hair(const char* name, const char* group, const char* unit, Range range, const char* help) {
  return field<CharacterLook, Access>(name, group, unit, range, help);
}

template <auto Access>
SceneField scene(const char* name, const char* group, const char* unit, Range range, const char* help) {
  return field<SceneLook, Access>(name, group, unit, range, help);
}

template <class Owner>
LookField<Owner> shaped(LookShape shape, LookField<Owner> row) {
  row.shape = shape;
  return row;
}

#define BODY(member)        \
  [](auto& look) -> auto& { \
    return look.member;     \
  }
#define HAIR(member)         \
  [](auto& look) -> auto& {  \
    return look.hair.member; \
  }
#define LIGHT(member)         \
  [](auto& look) -> auto& {   \
    return look.light.member; \
  }
#define VIEW(member)         \
  [](auto& look) -> auto& {  \
    return look.view.member; \
  }

std::vector<HairField> makeHairTable() {
  const auto color = [](HairField row) { return shaped(LookShape::kColor, row); };
  return {hair < [](auto& look) -> auto& {return look.strands;
}
> ("strands", "Strands", "", {0, 300000, kLog}, "Strands grown over the whole head."), hair < [](auto& look) -> auto& {
  return look.segments_per_layer;
}
> ("segments_per_layer", "Strands", "", {1, 8}, "Straight pieces drawn between two layers of the hair mesh."), hair < [
](auto& look) -> auto& {
  return look.lift_strands;
}
> ("lift_strands", "Strands", "", {0, 1}, "Drawn strands leave the skin where a bundle between vertices would cut it."),
    hair<HAIR(strand_radius)>("strand_radius", "Styling", "m", {5e-6, 1e-3, kLog}, "Radius of a strand at its root."),
    hair<HAIR(taper)>("taper", "Styling", "", {0, 1}, "Radius at the tip over radius at the root."),
    hair<HAIR(length_variation)>("length_variation", "Styling", "", {0, 0.9},
                                 "Strands end up to this share of their length early: 0 is a blunt cut."),
    hair<HAIR(offset)>("offset", "Styling", "m", {0, 0.02}, "Sideways wander of each strand, growing towards the tip."),
    hair<HAIR(clump)>("clump", "Styling", "", {0, 1}, "Pull of strands towards the middle of their clump."),
    hair<HAIR(clump_size)>("clump_size", "Styling", "m", {0.001, 0.06, kLog}, "Spacing of clumps on the scalp."),
    hair<HAIR(lock)>("lock", "Styling", "", {0, 1}, "Pull of clumps into locks, 3.2 clumps wide, towards the ends."),
    hair<HAIR(wisp)>("wisp", "Styling", "", {0, 1}, "Pull of strands into wisps of a few hairs, 0.3 clumps wide."),
    hair<HAIR(drift)>("drift", "Styling", "m", {0, 0.01}, "How far locks and clumps stray from side to side."),
    hair<HAIR(root_spread)>("root_spread", "Styling", "m", {0, 0.01},
                            "How far hairs fan out beside each other on their first centimetres."),
    hair<HAIR(curl_radius)>("curl_radius", "Styling", "m", {0, 0.03}, "Radius of curls; 0 is straight hair."),
    hair<HAIR(curl_pitch)>("curl_pitch", "Styling", "m", {0.005, 0.3, kLog}, "Length of hair in a turn of a curl."),
    hair<HAIR(wave_height)>("wave_height", "Styling", "m", {0, 0.04},
                            "Height of waves from crest to trough; 0 is straight hair."),
    hair<HAIR(wave_length)>("wave_length", "Styling", "m", {0.01, 0.5, kLog}, "Length of waves from crest to crest."),
    hair<HAIR(frizz)>("frizz", "Styling", "m", {0, 0.01},
                      "Noise along every strand, of its own, that takes strands out of their clumps."),
    hair<HAIR(flyaways)>("flyaways", "Styling", "", {0, 1}, "Share of stray hairs, that leave their clump."),
    hair<HAIR(flyaway_lift)>("flyaway_lift", "Styling", "m", {0, 0.03}, "How far stray hairs stand off the hair."),
    hair<HAIR(hairline)>("hairline", "Styling", "m", {0, 0.03},
                         "Distance from the hairline over which hair becomes sparse; 0 is a hard edge."),
    hair<HAIR(baby_hairs)>("baby_hairs", "Styling", "", {0, 1}, "Share of short fine hairs at the hairline."),
    hair<HAIR(seed)>("seed", "Styling", "", {0, 4294967295.0}, "Another seed deals the variation out anew."),
    hair<HAIR(eumelanin)>("eumelanin", "Color", "", {0, 8}, "Brown-black pigment: 0.3 blond, 1.3 brown, 4 black."),
    hair<HAIR(pheomelanin)>("pheomelanin", "Color", "", {0, 8}, "Red-yellow pigment."),
    hair<HAIR(use_color)>("use_color", "Color", "", {0, 1}, "Use the picked color in place of the pigments."),
    color(hair<HAIR(color)>("color", "Color", "", {0, 1}, "Picked hair color, linear RGB.")),
    hair<HAIR(root_darkening)>("root_darkening", "Color", "", {0, 1}, "How much darker the roots are."),
    hair<HAIR(tint_variation)>("tint_variation", "Color", "", {0, 1}, "Difference of tint from strand to strand."),
    hair<HAIR(beta_m)>("beta_m", "Shine", "", {0.05, 1}, "Roughness along the strand: low is glossy."),
    hair<HAIR(beta_n)>("beta_n", "Shine", "", {0.05, 1},
                       "Roughness around the strand: low is translucent and glinting."),
    hair<HAIR(eta)>("eta", "Shine", "", {1.05, 2.5}, "Index of refraction."),
    hair<HAIR(cuticle_angle)>("cuticle_angle", "Shine", "rad", {-0.2, 0.2},
                              "Tilt of the cuticle's scales; moves the two highlights apart."),
    hair<HAIR(shine_variation)>("shine_variation", "Shine", "rad", {0, 0.8},
                                "Tilt of the highlights from strand to strand: a smooth band falls apart into glints."),
    hair<HAIR(specular)>("specular", "Shine", "", {0, 4},
                         "Strength of the highlights; what they gain, light that passes through strands loses."),
    hair<HAIR(diffuse)>("diffuse", "Shine", "", {0, 1}, "Share that is kept of light scattered from strand to strand."),
    color(hair<BODY(body_color)>("body_color", "Body", "", {0, 1}, "Color of the mannequin, linear RGB.")),
    hair<BODY(own_materials)>("own_materials", "Body", "", {0, 1},
                              "Whether a figure shows the colors and pictures of its file in place of body_color."),
    hair<BODY(body_roughness)>("body_roughness", "Body", "", {0.05, 1}, "Roughness of the mannequin's surface."),
    hair<BODY(scalp_tint)>("scalp_tint", "Body", "", {0, 1},
                           "How much the roots shade and color the skin between them, as at the parting."),
    color(hair<BODY(cloth_color)>("cloth_color", "Body", "", {0, 1}, "Color of the mannequin's garment, linear RGB.")),
    hair<BODY(dressed)>("dressed", "Body", "", {0, 1}, "Whether the mannequin wears its garment."),
    hair<BODY(face_paint)>("face_paint", "Body", "", {0, 1},
                           "Strength of the mannequin's skin tone and painted brows, lashes and lips; 0: one colour."),
};  // namespace
}  // namespace app

std::vector<SceneField> makeSceneTable() {
  const auto color = [](SceneField row) { return shaped(LookShape::kColor, row); };
  const auto direction = [](SceneField row) { return shaped(LookShape::kDirection, row); };
  SceneField strand_path = scene<VIEW(strand_path)>(
      "strand_path", "Picture", "", {0, kStrandPaths.size() - 1.0},
      "What draws the strands: a shader stage, or shaders and the CPU where the driver has no GPU; auto "
      "is what suits the driver. The pictures agree.");
  strand_path.choices = kStrandPaths;
  return {
      color(scene<LIGHT(key)>("key", "Light", "", {0, 50}, "Color and strength of the key light.")),
      direction(scene<LIGHT(to_light)>("to_light", "Light", "", {-1, 1}, "Direction towards the key light.")),
      color(scene<LIGHT(fill)>("fill", "Light", "", {0, 50}, "Color and strength of the soft fill light.")),
      direction(scene<LIGHT(to_fill)>("to_fill", "Light", "", {-1, 1}, "Direction towards the fill light.")),
      color(scene<LIGHT(rim)>("rim", "Light", "", {0, 50}, "Color and strength of the rim light from behind.")),
      direction(scene<LIGHT(to_rim)>("to_rim", "Light", "", {-1, 1}, "Direction towards the rim light.")),
      color(scene<LIGHT(ambient_sky)>("ambient_sky", "Light", "", {0, 10}, "Light from all around, from above.")),
      color(scene<LIGHT(ambient_ground)>("ambient_ground", "Light", "", {0, 10}, "Light from all around, from below.")),
      scene<LIGHT(shadows)>("shadows", "Shadows", "", {0, 1}, "Shadows of hair and body."),
      scene<LIGHT(shadow_strength)>("shadow_strength", "Shadows", "", {0, 4}, "Opacity of the hair in its shadows."),
      scene<LIGHT(shadow_size)>("shadow_size", "Shadows", "pixels", {128, 4096},
                                "Most texels a side of a hair's shadow map: it has 1.5 for each pixel of the hair."),
      scene<LIGHT(opacity_layers)>("opacity_layers", "Shadows", "", {1, 7}, "Layers of the deep opacity map."),
      scene<LIGHT(layer_thickness)>("layer_thickness", "Shadows", "m", {0, 0.2},
                                    "Thickness of the first opacity layer; 0 derives it from the hair's extent."),
      scene<VIEW(exposure)>("exposure", "Picture", "", {0.05, 20, kLog}, "Brightness before tone mapping."),
      scene<VIEW(samples)>("samples", "Picture", "", {1, 16}, "Samples a pixel, as far as the context has them."),
      strand_path,
      scene<VIEW(show_strands)>("show_strands", "Picture", "", {0, 1}, "Draw the strands."),
      scene<VIEW(show_body)>("show_body", "Picture", "", {0, 1}, "Draw the body."),
      scene<VIEW(ground)>("ground", "Picture", "", {0, 1}, "Draw the ground."),
      color(scene<VIEW(backdrop_top)>("backdrop_top", "Picture", "", {0, 1}, "Backdrop at the top, linear RGB.")),
      color(scene<VIEW(backdrop_bottom)>("backdrop_bottom", "Picture", "", {0, 1}, "Backdrop at the bottom.")),
      color(scene<VIEW(ground_color)>("ground_color", "Picture", "", {0, 1}, "Color of the ground.")),
  };
}

#undef HAIR
#undef LIGHT
#undef VIEW

template <class Owner>
const LookField<Owner>* findIn(std::span<const LookField<Owner>> table, std::string_view name) {
  for (const LookField<Owner>& row : table) {
    if (name == row.name) return &row;
  }
  return nullptr;
}

template <class Owner>
std::string refuse(const LookField<Owner>& row, std::string_view text, const std::string& mend) {
  return std::string(row.name) + " cannot be '" + std::string(text.substr(0, 40)) + "'; " + mend;
}

template <class Owner>
std::string rangeText(const LookField<Owner>& row) {
  return sim::numberText(row.minimum) + " to " + sim::numberText(row.maximum) + (*row.unit ? " " : "") + row.unit;
}

// Splits "a,b,c" into `count` numbers.
bool parseNumbers(std::string_view text, int count, LookValue& value) {
  for (int i = 0; i < count; ++i) {
    const std::size_t comma = i + 1 < count ? text.find(',') : text.size();
    if (comma == std::string_view::npos || !sim::parseNumber(text.substr(0, comma), value[i])) return false;
    text.remove_prefix(std::min(text.size(), comma + 1));
  }
  return true;
}

}  // namespace

std::span<const HairField> hairFields() {
  static const std::vector<HairField> table = makeHairTable();
  return table;
}

std::span<const SceneField> sceneFields() {
  static const std::vector<SceneField> table = makeSceneTable();
  return table;
}

const HairField* findHairField(std::string_view name) {
  return findIn(hairFields(), name);
}
const SceneField* findSceneField(std::string_view name) {
  return findIn(sceneFields(), name);
}

template <class Owner>
std::string setLook(Owner& owner, const LookField<Owner>& row, std::string_view text) {
  LookValue value{};
  if (row.kind == sim::FieldKind::kSwitch) {
    bool on = false;
    if (!sim::parseSwitch(text, on)) return refuse(row, text, "write on or off");
    value[0] = on;
  } else if (row.kind == sim::FieldKind::kChoice) {
    std::string all;
    std::size_t index = row.choices.size();
    for (std::size_t i = 0; i < row.choices.size(); ++i) {
      if (text == row.choices[i]) index = i;
      all += (i ? ", " : "") + std::string(row.choices[i]);
    }
    if (index == row.choices.size()) return refuse(row, text, "choose one of " + all);
    value[0] = static_cast<double>(index);
  } else {
    const bool whole = row.kind == sim::FieldKind::kInteger;
    if (!parseNumbers(text, row.components(), value)) {
      return refuse(row, text,
                    (row.components() == 3 ? "write three numbers a,b,c, each " : "write a number, ") + rangeText(row));
    }
    for (int i = 0; i < row.components(); ++i) {
      if (whole && value[i] != std::floor(value[i])) return refuse(row, text, "write a whole number");
      if (value[i] < row.minimum || value[i] > row.maximum) return refuse(row, text, "the range is " + rangeText(row));
    }
    if (row.shape == LookShape::kDirection && value == LookValue{0, 0, 0}) {
      return refuse(row, text, "a direction needs a length above zero");
    }
  }
  row.set(owner, value);
  return {};
}

template <class Owner>
std::string lookText(const Owner& owner, const LookField<Owner>& row) {
  const LookValue value = row.get(owner);
  if (row.kind == sim::FieldKind::kSwitch) return value[0] != 0 ? "on" : "off";
  if (row.kind == sim::FieldKind::kChoice) return row.choices[static_cast<std::size_t>(value[0])];
  std::string text = sim::numberText(value[0]);
  for (int i = 1; i < row.components(); ++i) text.append(",").append(sim::numberText(value[i]));
  return text;
}

template std::string setLook(CharacterLook&, const HairField&, std::string_view);
template std::string setLook(SceneLook&, const SceneField&, std::string_view);
template std::string lookText(const CharacterLook&, const HairField&);
template std::string lookText(const SceneLook&, const SceneField&);

std::string setAnywhere(std::string_view name, std::string_view text, sim::SimParams& params,
                        std::span<CharacterLook*> hairs, SceneLook& scene_look) {
  if (sim::findParam(name)) return sim::setParam(params, name, text).fault;
  if (const HairField* row = findHairField(name)) {
    for (CharacterLook* look : hairs) {
      if (std::string fault = setLook(*look, *row, text); !fault.empty()) return fault;
    }
    return {};
  }
  if (const SceneField* row = findSceneField(name)) return setLook(scene_look, *row, text);
  std::vector<std::string_view> names;
  for (const sim::ParamField& row : sim::paramFields()) names.emplace_back(row.name);
  for (const HairField& row : hairFields()) names.emplace_back(row.name);
  for (const SceneField& row : sceneFields()) names.emplace_back(row.name);
  return "no parameter is called '" + std::string(name.substr(0, 40)) + "'; " + sim::nameHint(name, names);
}

}  // namespace app
