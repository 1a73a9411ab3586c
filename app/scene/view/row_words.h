// How rows of the parameter tables are called and shown to a person, in panels and messages.
#pragma once

#include <string>
#include <string_view>

namespace app {

// How panels show a unit of the tables; files keep the table's. `times`: what is shown over what the table has.
struct ShownUnit {
  std::string_view unit;
  double times;
};
// Of a row whose values go up to `maximum`.
ShownUnit shownUnit(std::string_view unit, double maximum);

// A row's value as the table writes it, as panels show it: with its unit there.
std::string shownText(const std::string& text, std::string_view unit, double maximum);

// What a parameter row is called in the panels.
std::string rowTitle(std::string_view name);

// A row's value, as files have it, with the number and unit that panels show: "4e-05" -> "0.04 mm".
std::string rowValue(std::string_view name, const std::string& text);

// "stretch_along" -> "Stretch along".
std::string readable(std::string_view name);

}  // namespace app
