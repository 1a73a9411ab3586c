#include "app/scene/hairdo.h"

#include <algorithm>

#include "app/files/data_path.h"
#include "app/files/errors.h"
#include "app/scene/hair_from_file.h"
#include "app/styles/hair_styles.h"
#include "sim/field_text.h"

namespace app {

std::vector<std::string> styleChoices() {
  std::vector<std::string> names(kStyleNames.begin(), kStyleNames.end());
  names.insert(names.end(), kHairdoNames.begin(), kHairdoNames.end());
  return names;
}

void chooseStyle(const std::string& name, CharacterSpec& spec) {
  const std::optional<Style> style = parseStyle(name);
  if (!style && std::ranges::find(kHairdoNames, name) == kHairdoNames.end()) {
    const std::vector<std::string> choices = styleChoices();
    const std::vector<std::string_view> names(choices.begin(), choices.end());
    throw InputError("", "style '" + name + "'", "is unknown", sim::nameHint(name, names));
  }
  chooseHair("", spec);
  if (style) {
    spec.style = *style;
    return;
  }
  const Scene scene = loadScene(dataPath("assets/scenes/" + name + ".json"));
  const CharacterSpec& worn = scene.characters.front();
  spec.style = worn.style;
  spec.look = worn.look;
  spec.ties = worn.ties;
  spec.maps = worn.maps;
  spec.curves = worn.curves;
}

}  // namespace app
