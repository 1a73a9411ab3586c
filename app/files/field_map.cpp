#include "app/files/field_map.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "app/files/image_io.h"
#include "sim/field_text.h"

namespace app {

namespace {

constexpr std::string_view kPictureText = "data:image/png;base64,";
constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
constexpr double kMinShare = 0.01;  // of a curve

std::string toBase64(std::string_view bytes) {
  std::string text;
  for (std::size_t at = 0; at < bytes.size(); at += 3) {
    unsigned bits = 0;
    for (std::size_t k = 0; k < 3; ++k)
      bits = bits << 8 | (at + k < bytes.size() ? static_cast<unsigned char>(bytes[at + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k) text += at + k > bytes.size() ? '=' : kDigits[bits >> (18 - 6 * k) & 63];
  }
  return text;
}

// Empty where the text is none.
std::string fromBase64(std::string_view text) {
  if (text.size() % 4 != 0) return "";
  std::string bytes;
  for (std::size_t at = 0; at < text.size(); at += 4) {
    unsigned bits = 0;
    std::size_t count = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      const bool filled = text[at + k] == '=' && at + 4 == text.size() && k > 1;
      const std::size_t digit = filled ? 0 : kDigits.find(text[at + k]);
      if (digit == std::string_view::npos) return "";
      bits = bits << 6 | static_cast<unsigned>(digit);
      count += !filled;
    }
    for (std::size_t k = 0; k + 1 < count; ++k) bytes += static_cast<char>(bits >> (16 - 8 * k) & 255);
  }
  return bytes;
}

std::string fieldHint() {
  std::string names;
  for (const std::string_view name : kFieldNames) names.append(names.empty() ? "" : ", ").append(name);
  return names;
}

std::vector<double>* findCurve(std::string_view name, FieldCurves& curves) {
  return name == "stiffness" ? &curves.stiffness : name == "mass" ? &curves.mass : nullptr;
}

// What of the picture is not as a field's picture should be.
std::string noteOf(const Image& image, const std::vector<float>& value) {
  constexpr int kTint = 12, kSolid = 250;  // of 255
  std::size_t coloured = 0, clear = 0;
  for (std::size_t i = 0; i + 3 < image.rgba.size(); i += 4) {
    const auto [low, high] = std::minmax({image.rgba[i], image.rgba[i + 1], image.rgba[i + 2]});
    coloured += high - low > kTint;
    clear += image.rgba[i + 3] < kSolid;
  }
  const bool even = std::ranges::all_of(value, [&](float one) { return one == value.front(); });
  std::string note;
  const auto add = [&](const std::string& more) { note += (note.empty() ? "" : ", and ") + more; };
  if (coloured > 0) add("is coloured: its brightness is read (grey is expected, white for the parameter's own value)");
  if (clear > 0) add("is transparent in places: the colour beneath is read (an opaque picture is expected)");
  if (!even && image.width != 2 * image.height)
    add("is " + std::to_string(image.width) + "x" + std::to_string(image.height) +
        ": it is stretched over the head (twice as wide as high is expected)");
  return note;
}

}  // namespace

double FieldMap::at(const sim::Vec3& direction) const {
  const double polar = std::acos(std::clamp(direction.y() / std::max(1e-12, direction.norm()), -1.0, 1.0));
  const double azimuth = std::atan2(direction.x(), direction.z());
  const double u = (azimuth / (2 * std::numbers::pi) + 0.5) * width - 0.5;
  const double v = std::clamp(polar / std::numbers::pi * height - 0.5, 0.0, height - 1.0);
  const int column = static_cast<int>(std::floor(u)), row = static_cast<int>(v);
  const double s = u - column, t = v - row;
  const auto texel = [&](int r, int c) {
    const int x = (c % width + width) % width, y = std::min(r, height - 1);
    return static_cast<double>(
        value[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)]);
  };
  const double upper = texel(row, column) + s * (texel(row, column + 1) - texel(row, column));
  const double lower = texel(row + 1, column) + s * (texel(row + 1, column + 1) - texel(row + 1, column));
  return upper + t * (lower - upper);
}

sim::Vec3 directionOf(const FieldMap& map, int column, int row) {
  const double azimuth = 2 * std::numbers::pi * ((column + 0.5) / map.width - 0.5);
  const double polar = std::numbers::pi * (row + 0.5) / map.height;
  return {std::sin(polar) * std::sin(azimuth), std::cos(polar), std::sin(polar) * std::cos(azimuth)};
}

FieldMap readFieldMap(const std::string& picture) {
  const Image image =
      isPictureText(picture)
          ? readPngBytes(fromBase64(std::string_view(picture).substr(kPictureText.size())), "painted field")
          : readPng(picture);
  FieldMap map{image.width, image.height, {}, {}};
  for (std::size_t i = 0; i + 3 < image.rgba.size(); i += 4) {
    const int grey = 2126 * image.rgba[i] + 7152 * image.rgba[i + 1] + 722 * image.rgba[i + 2];
    map.value.push_back(static_cast<float>(grey) / 2550000.0f);
  }
  map.note = noteOf(image, map.value);
  return map;
}

std::string mapNotes(const FieldFiles& maps) {
  std::string notes;
  for (const std::string* picture : {&maps.stiffness, &maps.length, &maps.density, &maps.mass}) {
    if (picture->empty() || isPictureText(*picture)) continue;
    const std::string note = readFieldMap(*picture).note, line = *picture + " " + note;
    if (!note.empty() && notes.find(line) == std::string::npos) notes += (notes.empty() ? "" : "\n") + line;
  }
  return notes;
}

std::string pictureText(const FieldMap& map) {
  std::vector<unsigned char> rgba;
  for (const float value : map.value) {
    const auto grey = static_cast<unsigned char>(std::lround(255 * std::clamp(value, 0.0f, 1.0f)));
    rgba.insert(rgba.end(), {grey, grey, grey, 255});
  }
  return std::string(kPictureText) + toBase64(pngBytes(map.width, map.height, rgba));
}

bool isPictureText(std::string_view picture) {
  return picture.starts_with(kPictureText);
}

std::string* findMap(std::string_view name, FieldFiles& maps) {
  const std::array<std::string*, kFieldNames.size()> pictures{&maps.stiffness, &maps.length, &maps.density, &maps.mass};
  const auto at = std::ranges::find(kFieldNames, name);
  return at == kFieldNames.end() ? nullptr : pictures[static_cast<std::size_t>(at - kFieldNames.begin())];
}

std::string setMap(std::string_view name, const std::string& picture, FieldFiles& maps) {
  if (std::string* map = findMap(name, maps)) return *map = picture, "";
  return "there is no field '" + std::string(name.substr(0, 40)) + "'; choose one of " + fieldHint();
}

double curveAt(const std::vector<double>& curve, double along) {
  if (curve.empty()) return 1;
  const double at = std::clamp(along, 0.0, 1.0) * static_cast<double>(curve.size() - 1);
  const std::size_t first = std::min(static_cast<std::size_t>(at), curve.size() - 1);
  const std::size_t second = std::min(first + 1, curve.size() - 1);
  return curve[first] + (at - static_cast<double>(first)) * (curve[second] - curve[first]);
}

FieldCurves readCurves(const JsonPlace& place) {
  place.expectObject({"stiffness", "mass"});
  FieldCurves curves;
  for (const char* name : {"stiffness", "mass"}) {
    if (!place.has(name)) continue;
    const JsonPlace points = place.at(name);
    const std::size_t count = points.arraySize(kMaxCurvePoints);
    for (std::size_t k = 0; k < count; ++k)
      findCurve(name, curves)->push_back(points.at(k).number(kMinShare, kLargestShare));
  }
  return curves;
}

nlohmann::json writeCurves(const FieldCurves& curves) {
  return {{"stiffness", curves.stiffness}, {"mass", curves.mass}};
}

void setCurve(const std::string& name, const std::string& text, FieldCurves& curves) {
  std::vector<double>* curve = findCurve(name, curves);
  if (!curve) throw InputError("", "field '" + name.substr(0, 40) + "'", "has no curve", "choose stiffness or mass");
  std::vector<double> points;
  for (std::size_t at = 0; text != "none" && at <= text.size();) {
    const std::size_t end = std::min(text.find(',', at), text.size());
    double point = 0;
    if (!sim::parseNumber(std::string_view(text).substr(at, end - at), point) || point < kMinShare ||
        point > kLargestShare || points.size() == kMaxCurvePoints)
      throw InputError("", "'" + text.substr(0, 40) + "'", "is no list of shares",
                       "write up to 32 numbers from 0.01 to 10 with commas, from root to tip, or none");
    points.push_back(point);
    at = end + 1;
  }
  *curve = std::move(points);
}

}  // namespace app
