#include "sim/field_text.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

namespace sim {

bool parseNumber(std::string_view text, double& value) {
  if (!text.empty() && text.front() == '+') text.remove_prefix(1);
  double read = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), read);
  if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(read)) return false;
  value = read;
  return true;
}

bool parseSwitch(std::string_view text, bool& value) {
  for (const std::string_view yes : {"on", "true", "yes", "1"}) {
    if (text == yes) return value = true;
  }
  for (const std::string_view no : {"off", "false", "no", "0"}) {
    if (text == no) return !(value = false);
  }
  return false;
}

std::string numberText(double value) {
  char buffer[32];
  const auto [end, error] = std::to_chars(buffer, buffer + sizeof buffer, value);
  return error == std::errc{} ? std::string(buffer, end) : std::string("0");
}

namespace {

// Edit distance of Damerau and Levenshtein, one row at a time: two neighbours that change places are one edit.
int editDistance(std::string_view a, std::string_view b) {
  std::vector<int> row(b.size() + 1), above(b.size() + 1), two_above;
  std::iota(row.begin(), row.end(), 0);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    two_above = std::exchange(above, row);
    row[0] = static_cast<int>(i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      row[j] = std::min({above[j] + 1, row[j - 1] + 1, above[j - 1] + (a[i - 1] != b[j - 1])});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        row[j] = std::min(row[j], two_above[j - 2] + 1);
    }
  }
  return row.back();
}

// Long names would make the distance quadratic in what a hostile file holds; no field's name is longer than this.
constexpr std::size_t kLongestName = 64;
constexpr std::size_t kLongestList = 24;
constexpr std::size_t kSureBeginning = 4;

}  // namespace

std::string_view nearestName(std::string_view name, std::span<const std::string_view> candidates) {
  if (name.empty() || name.size() > kLongestName) return {};
  // The beginning of a name is what a person is sure of: 'frict' for 'friction' rather than 'frizz'.
  if (name.size() >= kSureBeginning) {
    for (const std::string_view candidate : candidates) {
      if (candidate.starts_with(name)) return candidate;
    }
  }
  std::string_view best;
  int best_distance = 0;
  for (const std::string_view candidate : candidates) {
    const int distance = editDistance(name, candidate);
    const bool near = distance <= static_cast<int>(std::max(name.size(), candidate.size()) / 3);
    if (!near || (!best.empty() && distance >= best_distance)) continue;
    best = candidate;
    best_distance = distance;
  }
  // A part of a name is often what a person remembers: 'iterations' for 'max_iterations'.
  if (best.empty() && name.size() >= 3) {
    for (const std::string_view candidate : candidates) {
      if (candidate.find(name) != std::string_view::npos) return candidate;
    }
  }
  return best;
}

std::string nameHint(std::string_view name, std::span<const std::string_view> candidates) {
  const std::string_view near = nearestName(name, candidates);
  if (!near.empty()) return "did you mean '" + std::string(near) + "'?";
  if (candidates.size() > kLongestList) return "hairmesh --parameters lists them all";
  std::string list = "known are";
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    list += (i ? ", " : " ") + std::string(candidates[i]);
  }
  return list;
}

}  // namespace sim
