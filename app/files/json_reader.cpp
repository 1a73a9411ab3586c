#include "app/files/json_reader.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "app/files/text_scanner.h"
#include "sim/field_text.h"

namespace app {

namespace {

using nlohmann::json;

constexpr int kDeepest = 32;
constexpr std::size_t kLongestQuote = 40;

std::string lineAndColumn(std::string_view text, std::size_t byte) {
  const std::string_view before = text.substr(0, std::min(byte ? byte - 1 : 0, text.size()));
  const auto line = 1 + std::count(before.begin(), before.end(), '\n');
  const std::size_t line_start = before.rfind('\n') == std::string_view::npos ? 0 : before.rfind('\n') + 1;
  return "line " + std::to_string(line) + ", column " + std::to_string(before.size() - line_start + 1);
}

// The library's own words end with the reason after the last of its prefixes.
std::string reason(const std::string& words) {
  const std::size_t dash = words.find("- ");
  return dash == std::string::npos ? words : words.substr(dash + 2);
}

// What to do about a fault of syntax; `byte`, from 1, is the last that was read.
std::string syntaxMend(std::string_view text, std::size_t byte, const std::string& fault) {
  const bool ends = fault.ends_with("expected '}'") || fault.ends_with("expected ']'");
  if (fault.find("end of input") != std::string::npos) return "close what is open there by \" ] or }";
  const char read = byte > 0 && byte <= text.size() ? text[byte - 1] : ' ';
  if (read == '}' || read == ']') {
    const std::size_t before = text.find_last_not_of(" \t\r\n", byte > 1 ? byte - 2 : 0);
    if (byte > 1 && before != std::string_view::npos && text[before] == ',') return "take the comma before it away";
  }
  if (ends && fault.find("literal") != std::string::npos && fault.find("invalid") == std::string::npos)
    return "put a comma before it";
  if (ends && (read == '{' || read == '[')) return "put a comma before it";
  if (read == '\'') return "write texts in double quotes";
  if (read == '/') return "JSON has no comments: take it away";
  return "mend the syntax there";
}

std::string quote(const json& value) {
  const std::string text = value.dump(-1, ' ', true, json::error_handler_t::replace);
  return text.size() <= kLongestQuote ? text : text.substr(0, kLongestQuote) + "...";
}

}  // namespace

json parseJson(std::string_view text, const std::string& file) {
  refuseUtf16(text, file);
  std::vector<std::vector<std::string>> open_keys;
  const auto watch = [&](int depth, json::parse_event_t event, json& parsed) {
    if (depth > kDeepest) {
      throw InputError(file, "", "values are nested more than " + std::to_string(kDeepest) + " deep",
                       "no scene or preset needs that; flatten it");
    }
    if (event == json::parse_event_t::object_start) open_keys.emplace_back();
    if (event == json::parse_event_t::object_end && !open_keys.empty()) open_keys.pop_back();
    if (event == json::parse_event_t::key) {
      const std::string key = parsed.get<std::string>();
      auto& keys = open_keys.back();
      if (std::find(keys.begin(), keys.end(), key) != keys.end()) {
        throw InputError(file, "key '" + key.substr(0, kLongestQuote) + "'", "is written twice in one object",
                         "keep one of the two");
      }
      keys.push_back(key);
    }
    return true;
  };
  try {
    return json::parse(text, watch);
  } catch (const json::parse_error& error) {
    const std::string fault = reason(error.what());
    throw InputError(file, lineAndColumn(text, error.byte), "not valid JSON: " + fault,
                     syntaxMend(text, error.byte, fault));
  } catch (const json::exception& error) {
    const std::string words = error.what();
    const std::size_t number = words.find("parsing ");  // a number that overflows follows, in quotes
    const std::string what = number == std::string::npos ? "a number" : words.substr(number + 8, kLongestQuote);
    throw InputError(file, "", what + " is no number that a computer holds", "write one below 1e308");
  }
}

void JsonPlace::refuse(const std::string& fault, const std::string& mend) const {
  throw InputError(file_, pointer_, fault, mend);
}

bool JsonPlace::has(const std::string& key) const {
  return value_->contains(key);
}

JsonPlace JsonPlace::at(const std::string& key) const {
  return {value_->at(key), file_, pointer_ + "/" + key};
}

JsonPlace JsonPlace::at(std::size_t index) const {
  return {value_->at(index), file_, pointer_ + "/" + std::to_string(index)};
}

void JsonPlace::expectObject(std::span<const std::string_view> known) const {
  if (!value_->is_object()) refuse("is " + quote(*value_) + ", not an object", "write { ... } here");
  for (const auto& item : value_->items()) {
    if (std::find(known.begin(), known.end(), item.key()) == known.end()) {
      refuse("unknown key '" + item.key().substr(0, kLongestQuote) + "'", sim::nameHint(item.key(), known));
    }
  }
}

std::size_t JsonPlace::arraySize(std::size_t limit) const {
  if (!value_->is_array()) refuse("is " + quote(*value_) + ", not an array", "write [ ... ] here");
  if (value_->size() > limit)
    refuse("has " + std::to_string(value_->size()) + " entries", "at most " + std::to_string(limit) + " are allowed");
  return value_->size();
}

double JsonPlace::number(double minimum, double maximum, std::string_view unit) const {
  const std::string range =
      "write a number from " + sim::numberText(minimum) + " to " + sim::numberText(maximum) + std::string(unit);
  if (!value_->is_number()) refuse("is " + quote(*value_) + ", not a number", range);
  const double number = value_->get<double>();
  if (!std::isfinite(number) || number < minimum || number > maximum) refuse("is " + quote(*value_), range);
  return number;
}

bool JsonPlace::flag() const {
  if (!value_->is_boolean()) refuse("is " + quote(*value_), "write true or false");
  return value_->get<bool>();
}

std::string JsonPlace::text() const {
  if (!value_->is_string()) refuse("is " + quote(*value_) + ", not a text", "write it in double quotes");
  const std::string& text = value_->get_ref<const std::string&>();
  if (text.find('\0') != std::string::npos) refuse("holds a zero byte", "remove it");
  return text;
}

std::array<double, 3> JsonPlace::vector(double minimum, double maximum) const {
  if (!value_->is_array() || value_->size() != 3) refuse("is " + quote(*value_), "write three numbers [x, y, z]");
  return {at(0).number(minimum, maximum), at(1).number(minimum, maximum), at(2).number(minimum, maximum)};
}

std::string JsonPlace::choice(std::span<const std::string_view> choices) const {
  const std::string chosen = text();
  if (std::find(choices.begin(), choices.end(), chosen) == choices.end()) {
    refuse("is " + quote(*value_), sim::nameHint(chosen, choices));
  }
  return chosen;
}

std::string JsonPlace::fieldText(const RowForm& row) const {
  if (row.kind == sim::FieldKind::kSwitch) return flag() ? "on" : "off";
  if (row.kind == sim::FieldKind::kChoice) return text();
  if (row.components == 1) {
    const std::string unit = row.unit.empty() ? "" : " " + std::string(row.unit);
    return sim::numberText(value_->is_number() ? value_->get<double>() : number(row.minimum, row.maximum, unit));
  }
  const auto three = vector(-1e9, 1e9);
  return sim::numberText(three[0]) + "," + sim::numberText(three[1]) + "," + sim::numberText(three[2]);
}

}  // namespace app
