#include "app/files/tie_spec.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "app/files/errors.h"
#include "sim/field_text.h"

namespace app {

namespace {

using nlohmann::json;

constexpr double kFarthestTie = 0.5, kStandOff = 0.014;  // m
constexpr double kBunStandOff = 0.010;                   // m, and two fifths of the radius: it lies on the head

struct TiePlace {
  std::string_view name;
  double x, y, z;  // direction from the head's middle
  int side;
};
constexpr std::array kPlaces{TiePlace{"back", 0, 0.28, -0.96, 0}, TiePlace{"high", 0, 0.78, -0.62, 0},
                             TiePlace{"low", 0, -0.12, -0.99, 0}, TiePlace{"left", 0.80, -0.12, -0.58, 1},
                             TiePlace{"right", -0.80, -0.12, -0.58, -1}};

const TiePlace* placeOf(std::string_view name) {
  const auto at = std::ranges::find(kPlaces, name, &TiePlace::name);
  return at == kPlaces.end() ? nullptr : &*at;
}

sim::Vec3 lowered(const sim::Vec3& way, double angle) {
  const double level = std::hypot(way.x(), way.z()), height = std::atan2(way.y(), level) - angle;
  return {std::cos(height) * way.x() / level, std::sin(height), std::cos(height) * way.z() / level};
}

void readPlace(const JsonPlace& place, TieSpec& tie) {
  if (place.value().is_string()) {
    tie.place = place.choice({"back", "high", "low", "left", "right"});
  } else if (place.value().is_array()) {
    const auto at = place.vector(-kFarthestTie, kFarthestTie);
    tie.at = sim::Vec3(at[0], at[1], at[2]);
  } else {
    place.refuse("is neither a name nor a point",
                 "write back, high, low, left or right in quotes, or [x, y, z] in metres");
  }
}

// Nothing where the text is no name.
std::optional<std::vector<TieSpec>> namedTies(std::string_view text) {
  if (text == "none" || text.empty()) return std::vector<TieSpec>{};
  TieSpec tie;
  tie.braided = text == "plait" || text == "plaits";
  tie.bun = text == "bun" || text == "buns";
  if (text == "plait" || text == "bun") return std::vector{tie};
  if (text == "two" || text == "plaits" || text == "buns") {
    std::vector<TieSpec> both(2, tie);
    both[0].place = "left", both[1].place = "right";
    return both;
  }
  if (!placeOf(text)) return std::nullopt;
  tie.place = text;
  return std::vector{tie};
}

constexpr std::array<std::string_view, 11> kTieNames{"back",  "high",   "low", "left", "right", "two",
                                                     "plait", "plaits", "bun", "buns", "none"};

TieSpec readTie(const JsonPlace& place) {
  place.expectObject({"at", "radius", "side", "above", "braided", "bun"});
  TieSpec tie;
  if (place.has("at")) readPlace(place.at("at"), tie);
  if (place.has("radius")) tie.radius = place.at("radius").number(kThinnestTie, kWidestTie);
  if (place.has("side")) tie.side = place.at("side").choice({"all", "left", "right"});
  if (place.has("above")) tie.above = place.at("above").number(-1, 1);
  if (place.has("braided")) tie.braided = place.at("braided").flag();
  if (place.has("bun")) tie.bun = place.at("bun").flag();
  return tie;
}

}  // namespace

std::vector<TieSpec> readTies(const JsonPlace& place) {
  if (place.value().is_string()) {
    const std::string name = place.text();
    const auto named = namedTies(name);
    if (!named) place.refuse("is '" + name.substr(0, 40) + "'", sim::nameHint(name, kTieNames));
    return *named;
  }
  if (place.value().is_object()) return {readTie(place)};
  if (!place.value().is_array())
    place.refuse("is neither a name nor a list", "write a name in quotes, or [{ \"at\": ... }]");
  std::vector<TieSpec> ties;
  const std::size_t count = place.arraySize(kMaxTies);
  for (std::size_t i = 0; i < count; ++i) {
    const JsonPlace one = place.at(i);
    const std::vector<TieSpec> more = one.value().is_string() ? readTies(one) : std::vector{readTie(one)};
    ties.insert(ties.end(), more.begin(), more.end());
  }
  if (ties.size() > kMaxTies)
    place.refuse("has " + std::to_string(ties.size()) + " ties", "give at most " + std::to_string(kMaxTies));
  return ties;
}

json writeTies(const std::vector<TieSpec>& ties) {
  json all = json::array();
  for (const TieSpec& tie : ties) {
    json one = {{"radius", tie.radius}, {"above", tie.above}};
    one["at"] = tie.at ? json{tie.at->x(), tie.at->y(), tie.at->z()} : json(tie.place);
    if (!tie.side.empty()) one["side"] = tie.side;
    if (tie.braided) one["braided"] = true;
    if (tie.bun) one["bun"] = true;
    all.push_back(std::move(one));
  }
  return all;
}

std::vector<TieSpec> tiesFromText(std::string_view text) {
  if (const auto named = namedTies(text)) return *named;
  if (!text.starts_with("[") && !text.starts_with("{"))
    throw InputError("", "tie '" + std::string(text.substr(0, 40)) + "'", "is unknown",
                     sim::nameHint(text, kTieNames) +
                         (sim::nearestName(text, kTieNames).empty() ? "; or write JSON as in a scene's \"ties\"" : ""));
  const json parsed = parseJson(text, "");
  const JsonPlace place(parsed, "");
  return readTies(place);
}

std::string tieTitle(const std::vector<TieSpec>& ties) {
  std::string title = ties.size() == 1 ? "tie" : "ties";
  for (std::size_t k = 0; k < ties.size(); ++k) {
    title += k == 0 ? " " : k + 1 < ties.size() ? ", " : " and ";
    const std::optional<sim::Vec3>& at = ties[k].at;
    const auto tenths = [&](int axis) {  // of a centimetre, no minus before zero
      return sim::numberText(std::round(1000 * (*at)[axis]) / 10 + 0.0);
    };
    title += at ? "at " + tenths(0) + ", " + tenths(1) + ", " + tenths(2) + " cm" : ties[k].place;
  }
  return title;
}

std::vector<HairTie> placeTies(const std::vector<TieSpec>& ties, const Scalp& scalp, double lower) {
  std::vector<HairTie> placed;
  for (const TieSpec& spec : ties) {
    HairTie tie;
    const TiePlace& named = *placeOf(spec.place);
    const sim::Vec3 way = lowered(sim::Vec3(named.x, named.y, named.z).normalized(), lower);
    const double off = spec.bun ? 0.4 * spec.radius + kBunStandOff : spec.radius + kStandOff;
    tie.at = spec.at.value_or(scalp.center + (scalp.radiusAt(way) + off) * way);
    tie.radius = spec.radius;
    tie.side = spec.side == "left" ? 1 : spec.side == "right" ? -1 : spec.side == "all" ? 0 : spec.at ? 0 : named.side;
    tie.above = spec.above;
    tie.bun = spec.bun;
    placed.push_back(tie);
  }
  return placed;
}

}  // namespace app
