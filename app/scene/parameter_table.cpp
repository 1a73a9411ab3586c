#include "app/scene/parameter_table.h"

#include <string_view>

#include "app/scene/view/look_params.h"
#include "sim/field_text.h"

namespace app {

namespace {

struct Row {
  std::string name, value, range, unit, help;
};

void addGroupHeading(const std::string& title, std::string& text) {
  text += "\n### " + title + "\n\n| name | default | range | unit | what it does |\n|---|---|---|---|---|\n";
}

void addRow(const Row& row, std::string& text) {
  text += "| `" + row.name + "` | " + row.value + " | " + row.range + " | " + row.unit + " | " + row.help + " |\n";
}

std::string choiceList(std::span<const char* const> choices) {
  std::string text;
  for (const char* name : choices) text += (text.empty() ? "" : ", ") + std::string(name);
  return text;
}

std::string rangeText(sim::FieldKind kind, double minimum, double maximum, std::span<const char* const> choices) {
  if (kind == sim::FieldKind::kSwitch) return "on, off";
  if (kind == sim::FieldKind::kChoice) return choiceList(choices);
  return sim::numberText(minimum) + " to " + sim::numberText(maximum);
}

template <class Owner>
void addLookTable(std::span<const LookField<Owner>> table, std::string& text) {
  std::string_view group;
  for (const LookField<Owner>& row : table) {
    if (group != row.group) addGroupHeading(row.group, text);
    group = row.group;
    addRow({row.name, lookText(Owner{}, row), rangeText(row.kind, row.minimum, row.maximum, row.choices), row.unit,
            row.help},
           text);
  }
}

}  // namespace

std::string parameterTable() {
  std::string text;
  std::string_view group;
  for (const sim::ParamField& row : sim::paramFields()) {
    if (group != row.group) addGroupHeading(row.group, text);
    group = row.group;
    addRow({row.name, sim::paramText(row, {}), rangeText(row.kind, row.minimum, row.maximum, row.choices), row.unit,
            row.help},
           text);
  }
  addLookTable(hairFields(), text);
  addLookTable(sceneFields(), text);
  return text;
}

}  // namespace app
