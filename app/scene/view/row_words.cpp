#include "app/scene/view/row_words.h"

#include <algorithm>
#include <cctype>
#include <cstdio>

#include "app/scene/view/look_params.h"
#include "sim/field_text.h"
#include "sim/sim_params.h"

namespace app {

ShownUnit shownUnit(std::string_view unit, double maximum) {
  if (unit == "m" && maximum < 1) return {"mm", 1e3};
  if (unit == "Pa") return {"kPa", 1e-3};
  return {unit, 1};
}

std::string shownText(const std::string& text, std::string_view unit, double maximum) {
  double value = 0;
  if (!sim::parseNumber(text, value)) return text;
  const ShownUnit shown = shownUnit(unit, maximum);
  char number[32];
  std::snprintf(number, sizeof number, "%.6g", shown.times * value);
  return shown.times == 1 && unit.empty() ? text
                                          : std::string(number).append(unit.empty() ? "" : " ").append(shown.unit);
}

namespace {

struct Label {
  std::string_view name, label;
};
// Rows whose name in files says too little in a panel.
constexpr Label kLabels[] = {{"beta_m", "Roughness along"},
                             {"beta_n", "Roughness around"},
                             {"eta", "Refractive index"},
                             {"key", "Key light"},
                             {"to_light", "Key direction"},
                             {"fill", "Fill light"},
                             {"to_fill", "Fill direction"},
                             {"rim", "Rim light"},
                             {"to_rim", "Rim direction"},
                             {"clump", "Clumping"},
                             {"offset", "Wander"},
                             {"color", "Picked color"},
                             {"use_color", "Use picked color"}};

}  // namespace

std::string rowTitle(std::string_view name) {
  for (const Label& row : kLabels) {
    if (row.name == name) return std::string(row.label);
  }
  return readable(name);
}

std::string rowValue(std::string_view name, const std::string& text) {
  if (const sim::ParamField* row = sim::findParam(name)) return shownText(text, row->unit, row->maximum);
  if (const HairField* row = findHairField(name)) return shownText(text, row->unit, row->maximum);
  if (const SceneField* row = findSceneField(name)) return shownText(text, row->unit, row->maximum);
  return text;
}

std::string readable(std::string_view name) {
  std::string text(name);
  std::replace(text.begin(), text.end(), '_', ' ');
  if (!text.empty()) text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  return text;
}

}  // namespace app
