#include "app/files/pin_spec.h"

#include <cmath>
#include <nlohmann/json.hpp>

namespace app {

namespace {

using nlohmann::json;

constexpr double kLargestNumber = 1e6;  // of vertices, columns and layers
constexpr double kFarthestPin = 1000;   // m
constexpr double kLatest = 1e6;         // s

int readInteger(const JsonPlace& place, int minimum) {
  const double number = place.number(minimum, kLargestNumber);
  if (number != std::floor(number)) place.refuse("is not a whole number", "write one");
  return static_cast<int>(number);
}

sim::Vec3 readPlace(const JsonPlace& place) {
  const auto at = place.vector(-kFarthestPin, kFarthestPin);
  return {at[0], at[1], at[2]};
}

PinSpec readPin(const JsonPlace& place) {
  place.expectObject({"vertex", "column", "layer", "near", "to", "at", "stiffness", "from", "until"});
  PinSpec pin;
  pin.file = place.file();
  pin.place = place.pointer();
  if (int(place.has("vertex")) + int(place.has("column")) + int(place.has("near")) != 1) {
    place.refuse("names no vertex, or two", "give \"vertex\", or \"column\" and \"layer\", or \"near\"");
  }
  if (place.has("layer") && !place.has("column")) place.refuse("has a layer of no column", "give \"column\" as well");
  if (place.has("vertex")) pin.vertex = readInteger(place.at("vertex"), 0);
  if (place.has("column")) pin.column = readInteger(place.at("column"), 0);
  if (place.has("layer")) pin.layer = readInteger(place.at("layer"), -1);
  if (place.has("near")) pin.near = readPlace(place.at("near"));
  if (place.has("to")) pin.to = place.at("to").text();
  if (place.has("at")) pin.at = readPlace(place.at("at"));
  if (place.has("stiffness")) {
    const JsonPlace stiffness = place.at("stiffness");
    pin.stiffness = stiffness.value().is_string() ? (stiffness.choice({"infinite"}), PinSpec::kForever)
                                                  : stiffness.number(0, kStiffestPin);
  }
  if (place.has("from")) pin.from = place.at("from").number(0, kLatest);
  if (place.has("until")) pin.until = place.at("until").number(0, kLatest);
  if (pin.until <= pin.from) place.refuse("ends before it begins", "make \"until\" later than \"from\"");
  return pin;
}

}  // namespace

std::vector<PinSpec> readPins(const JsonPlace& place) {
  std::vector<PinSpec> pins;
  const std::size_t count = place.arraySize(kMaxPins);
  for (std::size_t i = 0; i < count; ++i) pins.push_back(readPin(place.at(i)));
  return pins;
}

json writePins(const std::vector<PinSpec>& pins) {
  json all = json::array();
  for (const PinSpec& pin : pins) {
    json one = {{"to", pin.to}, {"from", pin.from}};
    if (pin.vertex >= 0) one["vertex"] = pin.vertex;
    if (pin.column >= 0) one["column"] = pin.column, one["layer"] = pin.layer;
    if (pin.near) one["near"] = json{pin.near->x(), pin.near->y(), pin.near->z()};
    if (pin.at) one["at"] = json{pin.at->x(), pin.at->y(), pin.at->z()};
    one["stiffness"] = std::isfinite(pin.stiffness) ? json(pin.stiffness) : json("infinite");
    if (std::isfinite(pin.until)) one["until"] = pin.until;
    all.push_back(std::move(one));
  }
  return all;
}

PinSpec pinFromText(std::string_view text) {
  const json parsed = parseJson(text, "");
  return readPin(JsonPlace(parsed, ""));
}

std::vector<PinSpec> pinsFromText(std::string_view text) {
  const json parsed = parseJson(text, "");
  return readPins(JsonPlace(parsed, ""));
}

}  // namespace app
