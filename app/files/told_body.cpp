#include "app/files/told_body.h"

#include <algorithm>
#include <array>
#include <utility>

#include "app/files/length_units.h"

namespace app {

std::string readToldBody(std::string_view text, ToldBody& told) {
  constexpr std::array<std::pair<std::string_view, int>, 6> kFaces{
      {{"x", 0}, {"+x", 0}, {"-x", 0}, {"z", 2}, {"+z", 2}, {"-z", 2}}};
  told = {};
  while (!text.empty()) {
    const std::string_view word = text.substr(0, text.find_first_of(" ,"));
    text.remove_prefix(std::min(text.size(), word.size() + 1));
    if (word.empty()) continue;
    const std::size_t equals = std::min(word.find('='), word.size());
    const std::string_view name = word.substr(0, equals), value = word.substr(std::min(word.size(), equals + 1));
    const auto* const unit = std::ranges::find(kLengthUnits, value, &LengthUnit::name);
    const auto* const face = std::ranges::find(kFaces, value, &std::pair<std::string_view, int>::first);
    if (name == "unit" && unit != kLengthUnits.end()) {
      told.unit = unit->metres;
    } else if (name == "up" && (value == "y" || value == "z")) {
      told.up = value[0];
    } else if (name == "face" && face != kFaces.end()) {
      told.face = (value[0] == '-' ? -1 : 1) * Eigen::Vector3d::Unit(face->second);
    } else {
      return "'" + std::string(word.substr(0, 40)) +
             "' tells nothing of a body; write unit=m, cm, mm, in or ft, up=y or z, face=x, -x, z or -z (once y is up)";
    }
  }
  return "";
}

std::string writeToldBody(const ToldBody& told) {
  std::string text;
  const auto add = [&](const std::string& word) { text += (text.empty() ? "" : " ") + word; };
  const auto* const unit = std::ranges::find(kLengthUnits, told.unit, &LengthUnit::metres);
  if (unit != kLengthUnits.end()) add(std::string("unit=") + unit->name);
  if (told.up) add(std::string("up=") + told.up);
  if (told.face.x() != 0) add(told.face.x() < 0 ? "face=-x" : "face=x");
  if (told.face.z() != 0) add(told.face.z() < 0 ? "face=-z" : "face=z");
  return text;
}

}  // namespace app
