#include "app/library/parameter_rows.h"

#include <cmath>
#include <string>
#include <vector>

#include "sim/field_text.h"

namespace app::library {
namespace {

std::vector<ParameterRow> makeRows() {
  std::vector<ParameterRow> rows;
  for (const sim::ParamField& row : sim::paramFields()) rows.emplace_back(&row);
  for (const HairField& row : hairFields()) {
    const std::string_view group = row.group;
    if (group == "Strands" || group == "Styling") rows.emplace_back(&row);
  }
  return rows;
}

template <class Row>
hm_parameter describeRow(const Row& row, double default_value, bool of_strands) {
  return {row.name,
          row.group,
          row.unit,
          row.help,
          static_cast<hm_kind>(row.kind),
          row.minimum,
          row.maximum,
          default_value,
          row.logarithmic,
          of_strands,
          row.choices.empty() ? nullptr : row.choices.data(),
          static_cast<std::int32_t>(row.choices.size())};
}

// A step has ellipsoids to collide with and no signed distances.
void refuseSdf(const sim::SimParams& params) {
  if (params.collider == sim::ColliderKind::kSdf)
    throw Fault{
        HM_ERROR_VALUE,
        "collider cannot be sdf: the library takes no signed distances of a body; give ellipsoids with the step"};
}

static_assert(static_cast<int>(sim::FieldKind::kReal) == HM_REAL &&
              static_cast<int>(sim::FieldKind::kInteger) == HM_INTEGER &&
              static_cast<int>(sim::FieldKind::kSwitch) == HM_SWITCH &&
              static_cast<int>(sim::FieldKind::kChoice) == HM_CHOICE);

}  // namespace

std::span<const ParameterRow> parameterRows() {
  static const std::vector<ParameterRow> rows = makeRows();
  return rows;
}

const ParameterRow& rowOf(std::string_view name) {
  std::vector<std::string_view> names;
  for (const ParameterRow& row : parameterRows()) {
    const char* known = std::visit([](const auto* field) { return field->name; }, row);
    if (name == known) return row;
  }
  for (const ParameterRow& row : parameterRows()) names.emplace_back(describe(row).name);
  throw Fault{HM_ERROR_NAME,
              "no parameter is called '" + std::string(name.substr(0, 40)) + "'; " + sim::nameHint(name, names)};
}

hm_parameter describe(const ParameterRow& row) {
  if (const auto* const* field = std::get_if<const sim::ParamField*>(&row))
    return describeRow(**field, (*field)->default_value, false);
  const HairField& field = *std::get<const HairField*>(row);
  return describeRow(field, field.default_value[0], true);
}

double valueOf(const ParameterRow& row, const Hair& hair) {
  if (const auto* const* field = std::get_if<const sim::ParamField*>(&row)) return (*field)->get(hair.params);
  return std::get<const HairField*>(row)->get(hair.look)[0];
}

void setValue(const ParameterRow& row, double value, Hair& hair) {
  const hm_parameter of = describe(row);
  const bool whole = of.kind != HM_REAL;
  if (!(value >= of.minimum && value <= of.maximum) || (whole && value != std::floor(value)))
    throw Fault{HM_ERROR_VALUE, std::string(of.name) + " cannot be " + sim::numberText(value) + "; write a " +
                                    (whole ? "whole number" : "number") + " from " + sim::numberText(of.minimum) +
                                    " to " + sim::numberText(of.maximum) + (*of.unit ? " " : "") + of.unit};
  if (const auto* const* field = std::get_if<const sim::ParamField*>(&row)) {
    sim::SimParams changed = hair.params;
    (*field)->set(changed, value);
    refuseSdf(changed);
    hair.params = changed;
  } else {
    std::get<const HairField*>(row)->set(hair.look, {value, 0, 0});
  }
}

void setText(const ParameterRow& row, std::string_view text, Hair& hair) {
  std::string fault;
  if (const auto* const* field = std::get_if<const sim::ParamField*>(&row)) {
    sim::SimParams changed = hair.params;
    fault = sim::setParam(changed, (*field)->name, text).fault;
    refuseSdf(changed);
    if (fault.empty()) hair.params = changed;
  } else {
    fault = setLook(hair.look, *std::get<const HairField*>(row), text);
  }
  if (!fault.empty()) throw Fault{HM_ERROR_VALUE, fault};
}

}  // namespace app::library
