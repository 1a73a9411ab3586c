#include "app/parse_fault.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string_view>

#include "app/options.h"
#include "sim/field_text.h"

namespace app {

namespace {

std::string extraFault(const CLI::App& parser, const std::string& one_file, const std::string& help) {
  const std::vector<std::string> extras = parser.remaining();
  const auto option = std::ranges::find_if(extras, [](const std::string& word) { return word.starts_with("-"); });
  if (option == extras.end())
    return "'" + (extras.empty() ? "" : extras.front()) + "' is one file too many; " + one_file;
  std::vector<std::string> names;
  for (const CLI::Option* known : parser.get_options()) {
    for (const std::string& name : known->get_lnames()) names.push_back("--" + name);
  }
  const std::vector<std::string_view> candidates(names.begin(), names.end());
  const std::string_view near = sim::nearestName(option->substr(0, option->find('=')), candidates);
  return "there is no option '" + *option + "'" + (near.empty() ? help : "; did you mean '" + std::string(near) + "'?");
}

}  // namespace

void expectEnding(const std::string& option, const std::string& file, const std::vector<std::string>& endings) {
  const auto known = std::ranges::find(endings, std::filesystem::path(file).extension().string());
  if (file.empty() || known != endings.end()) return;
  std::string list = endings.front();
  for (std::size_t k = 1; k < endings.size(); ++k) list += (k + 1 < endings.size() ? ", " : " or ") + endings[k];
  throw UsageError(option + " cannot be '" + file + "'; name it " + list);
}

std::string rangeText(double low, double high) {
  const auto textOf = [](double value) {
    const bool whole = value == std::floor(value) && std::abs(value) < 1e9;
    return whole ? std::to_string(std::lround(value)) : sim::numberText(value);
  };
  return textOf(low) + " to " + textOf(high);
}

CLI::Validator within(double low, double high) {
  const std::string range = rangeText(low, high);
  return CLI::Validator(
      [=](std::string& text) {
        double value = 0;
        const bool fine = sim::parseNumber(text, value) && value >= low && value <= high;
        return fine ? std::string() : "'" + text.substr(0, 40) + "' is not a number from " + range;
      },
      "");
}

std::string parseFault(const CLI::ParseError& error, const CLI::App& parser, const std::string& one_file) {
  const std::string words = error.what(), help = "; " + parser.get_name() + " --help lists the options";
  if (dynamic_cast<const CLI::ExtrasError*>(&error)) return extraFault(parser, one_file, help);
  const std::string name = words.substr(0, words.find(':'));
  const CLI::Option* option = parser.get_option_no_throw(name);
  if (dynamic_cast<const CLI::ArgumentMismatch*>(&error) && option && name.starts_with("--"))
    return name +
           (option->get_expected_min() > 1 ? " needs " + std::to_string(option->get_expected_min()) + " values"
                                           : " needs a value") +
           "; write " + name + " " + (option->get_option_text().empty() ? "VALUE" : option->get_option_text());
  if (dynamic_cast<const CLI::ConversionError*>(&error) && words.starts_with("Could not convert: ")) {
    const std::size_t equals = words.find(" = ");
    const std::string wanted = words.substr(19, equals - 19);
    // Of an option that is given twice these are both values, and the last counts.
    std::string value = words.substr(equals + 3);
    if (const CLI::Option* given = parser.get_option_no_throw(wanted); given && !given->results().empty())
      value = given->results().back();
    return wanted + " cannot be '" + value.substr(0, 40) + "'; write a whole number";
  }
  return words + help;
}

}  // namespace app
