// The parameters of a hair: the simulation's table, then the rows of the hairs' table that change how strands grow.
#pragma once

#include <span>
#include <string_view>
#include <variant>

#include "app/library/objects.h"

namespace app::library {

using ParameterRow = std::variant<const sim::ParamField*, const HairField*>;

std::span<const ParameterRow> parameterRows();

// Throws Fault with the nearest names.
const ParameterRow& rowOf(std::string_view name);

hm_parameter describe(const ParameterRow& row);
double valueOf(const ParameterRow& row, const Hair& hair);

// Throws Fault where the value is out of range; then nothing changed.
void setValue(const ParameterRow& row, double value, Hair& hair);
void setText(const ParameterRow& row, std::string_view text, Hair& hair);

}  // namespace app::library
