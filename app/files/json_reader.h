// Reading JSON that a person wrote: every fault becomes one InputError that names the file and the place in it.
#pragma once

#include <array>
#include <initializer_list>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <string_view>

#include "app/files/errors.h"
#include "sim/sim_params.h"

namespace app {

// Parses text; faults name line and column. Depth and size are bounded.
nlohmann::json parseJson(std::string_view text, const std::string& file);

// A value of a parsed file together with where it stands, as a JSON pointer.
class JsonPlace {
 public:
  JsonPlace(const nlohmann::json& value, std::string file, std::string pointer = "")
      : value_(&value), file_(std::move(file)), pointer_(std::move(pointer)) {}

  const nlohmann::json& value() const { return *value_; }
  const std::string& file() const { return file_; }
  const std::string& pointer() const { return pointer_; }

  // Refuses anything but an object whose keys are all known.
  void expectObject(std::span<const std::string_view> known) const;
  void expectObject(std::initializer_list<std::string_view> known) const {
    expectObject({known.begin(), known.size()});
  }
  bool has(const std::string& key) const;
  JsonPlace at(const std::string& key) const;

  // Elements of an array of at most `limit` entries.
  std::size_t arraySize(std::size_t limit) const;
  JsonPlace at(std::size_t index) const;

  // Read the value itself, checked. unit: told after the range (" rad").
  double number(double minimum, double maximum, std::string_view unit = "") const;
  bool flag() const;
  std::string text() const;
  std::array<double, 3> vector(double minimum, double maximum) const;
  std::string choice(std::span<const std::string_view> choices) const;
  std::string choice(std::initializer_list<std::string_view> choices) const {
    return choice(std::span(choices.begin(), choices.size()));
  }

  // The value of a parameter table's row as the text that the table reads ("0.3", "on", "paper", "1,2,3"). It is
  // written as JSON has it: a number, true or false, a name in quotes, three numbers. The table checks its range.
  struct RowForm {
    sim::FieldKind kind;
    int components;  // 1 or 3
    double minimum, maximum;
    std::string_view unit;
  };
  std::string fieldText(const RowForm& row) const;

  [[noreturn]] void refuse(const std::string& fault, const std::string& mend) const;

 private:
  const nlohmann::json* value_;
  std::string file_, pointer_;
};

}  // namespace app
