#include "tests/stress/family_text.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <vector>

#include "sim/field_text.h"
#include "tests/stress/matrix.h"
#include "tests/stress/stage.h"

namespace stress {
namespace {

using Some = std::span<const StressCase* const>;

struct FamilyTitle {
  const char* family;
  const char* title;
};
// Of families of which any part varies the same.
constexpr std::array<FamilyTitle, 12> kTitles{{
    {"pace", "steps, and frames through the clock, of 1 to 500 ms drawn anew each time"},
    {"param", "every parameter at its minimum and maximum, every choice"},
    {"preset", "the material of every preset, own clips, implicit Euler and BDF2"},
    {"random-params", "random combinations over the whole ranges of all parameters"},
    {"redrawn-params", "parameters drawn anew every step"},
    {"paper", "the paper's claims, with our settings and with its solver"},
    {"upset", "turns, teleports, spins, shakes, bodies through and within the hair"},
    {"distances", "disturbances with signed distances of the skin for colliders"},
    {"scrub", "scrubbing backwards, jumps in time with and without carrying the hair along"},
    {"fault", "values not finite or absurd written into random vertices ten times a second"},
    {"capture",
     "two rounds of each capture, in place and going on, at 1 to 20 times, seams included; a step's work bounded, "
     "strands looked at against the drawn skin"},
    {"mixed", "draws over all axes at once"},
}};

// The cases' values of something, each once, in the order of the cases.
std::vector<std::string> distinct(Some cases, auto&& of) {
  std::vector<std::string> values;
  for (const StressCase* one : cases) {
    const std::string value = of(*one);
    if (std::find(values.begin(), values.end(), value) == values.end()) values.push_back(value);
  }
  return values;
}

std::string joined(const std::vector<std::string>& parts) {
  std::string text;
  for (const std::string& part : parts) text += (text.empty() ? "" : ", ") + part;
  return text;
}

// "family/this/...".
std::string secondName(const StressCase& one) {
  const std::size_t from = one.name.find('/') + 1;
  return one.name.substr(from, one.name.find('/', from) - from);
}

std::string stepText(double step) {
  return "1/" + plain(std::round(1 / step));
}

std::string range(Some cases, double StressCase::*value, auto&& text) {
  const auto [least, most] = std::minmax_element(
      cases.begin(), cases.end(), [&](const StressCase* a, const StressCase* b) { return a->*value < b->*value; });
  if ((*least)->*value == (*most)->*value) return text((*least)->*value);
  return text((*least)->*value) + " to " + text((*most)->*value);
}

std::string speedText(Some cases) {
  const bool captured = std::any_of(cases.begin(), cases.end(), [](const StressCase* one) {
    const auto own = ownClips();
    return std::find(own.begin(), own.end(), one->clip) == own.end();
  });
  return "playback at " + range(cases, &StressCase::speed, plain) + " times, own clips" +
         (captured ? " and motion capture" : "");
}

std::string styleText(Some cases) {
  std::set<std::pair<app::Style, app::Resolution>> whole;
  std::set<Cut> cuts;
  for (const StressCase* one : cases) {
    if (one->hair.cut == Cut::kStyle)
      whole.insert({one->hair.style, one->hair.resolution});
    else
      cuts.insert(one->hair.cut);
  }
  const bool low =
      std::all_of(whole.begin(), whole.end(), [](const auto& hair) { return hair.second == app::Resolution::kLow; });
  std::vector<std::string> parts{plain(static_cast<double>(whole.size())) + " styles" +
                                 (low ? " in low resolution" : " and resolutions")};
  if (cuts.contains(Cut::kUneven)) parts.emplace_back("uneven columns");
  if (cuts.contains(Cut::kSingleBundle)) parts.emplace_back("a single bundle");
  if (cuts.contains(Cut::kTenThousand)) parts.emplace_back("10,000 vertices");
  return joined(parts);
}

std::string enduranceText(Some cases) {
  const auto played = distinct(cases, [](const StressCase& one) {
    return plain(one.seconds) + " s of " + one.clip.substr(0, one.clip.find('.'));
  });
  return joined(played) + "; memory and timing flat";
}

std::string stiffnessText(Some cases) {
  const auto decades = distinct(cases, [](const StressCase& one) {
    const std::string name = secondName(one);
    return name.substr(name.rfind("-1e") + 1);
  });
  return "stiffness and mass at " + joined(decades) + " of their defaults";
}

std::string ladderText(Some cases) {
  const auto rungs = distinct(cases, secondName);
  return plain(static_cast<double>(rungs.size())) +
         " rungs of the budget governor's ladder, dance and turns of the head";
}

}  // namespace

std::string familyText(std::span<const StressCase* const> cases) {
  const std::string family = cases.front()->family();
  if (family == "step") return "fixed time steps of " + range(cases, &StressCase::step, stepText) + " s";
  if (family == "speed") return speedText(cases);
  if (family == "style") return styleText(cases);
  if (family == "endurance") return enduranceText(cases);
  if (family == "state") return joined(distinct(cases, secondName));
  if (family == "stiffness") return stiffnessText(cases);
  if (family == "ladder") return ladderText(cases);
  for (const FamilyTitle& row : kTitles) {
    if (family == row.family) return row.title;
  }
  return family;
}

std::string hairText(std::span<const StressCase* const> cases) {
  constexpr std::size_t kNamed = 3;
  const auto hairs = distinct(cases, [](const StressCase& one) { return hairName(one.hair); });
  return hairs.size() <= kNamed ? joined(hairs) : plain(static_cast<double>(hairs.size())) + " kinds";
}

}  // namespace stress
